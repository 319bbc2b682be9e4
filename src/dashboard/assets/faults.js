// What is wrong with a job, told at the fields of its form.
import { element } from './service.js';

const place = () => document.getElementById('faults');

/** Takes away what was told. */
export function clearFaults() {
  place().replaceChildren();
  for (const said of document.querySelectorAll('.fault')) said.remove();
  for (const field of document.querySelectorAll('[data-faulty]')) {
    for (const name of ['data-faulty', 'aria-invalid', 'aria-describedby']) field.removeAttribute(name);
  }
}

const atOf = field => field.dataset.at ?? field.dataset.pointer;

/** The field of a place in the job: its own, the first of what is in it, or that of what it is in. */
function fieldOf(form, pointer) {
  const fields = [...form.querySelectorAll('[data-at], [data-pointer]')];
  if (pointer === '') return undefined;
  const own = fields.find(field => atOf(field) === pointer) ?? fields.find(field => atOf(field).startsWith(`${pointer}/`));
  const around = fields.filter(field => pointer.startsWith(`${atOf(field)}/`));
  return own ?? around.sort((a, b) => atOf(b).length - atOf(a).length)[0];
}

/** What a field is called on the page. */
const called = field => (field.getAttribute('aria-label') ?? field.labels?.[0]?.firstChild?.textContent ?? '').trim();

/** A place in the job in the words of the form. */
function words(pointer, field, spec) {
  const [section, name, ...rest] = pointer.split('/').slice(1).map(step => step.replaceAll('~1', '/').replaceAll('~0', '~'));
  if (field && (atOf(field) === pointer || section === 'options')) return called(field);
  if (section === 'maneuvers' && name !== undefined) return ['maneuver', spec.maneuvers[name]?.label ?? Number(name) + 1, ...rest].join(' ');
  const what = { maneuvers: 'maneuvers', parameters: 'parameter', channels: 'channel', constants: 'constant', edits: 'edit', candidates: 'candidate' };
  return [what[section] ?? section, name, ...rest].filter(part => part !== undefined).join(' ');
}

/** Marks a field, writes what is wrong beside it, and opens what hides it. */
function mark(field, message, number) {
  const said = element('span', { class: 'fault bad', id: `fault-${number}` }, message);
  field.after(said);
  const others = field.getAttribute('aria-describedby');
  field.setAttribute('aria-describedby', others ? `${others} ${said.id}` : said.id);
  field.setAttribute('aria-invalid', 'true');
  field.dataset.faulty = '';
  for (let hidden = field.closest('details'); hidden; hidden = hidden.parentElement.closest('details')) hidden.open = true;
}

/** Tells all faults (`pointer` and `message`) at their fields, and in a list that leads to them. */
export function showFaults(form, faults, spec) {
  clearFaults();
  const items = faults.map(({ pointer, message }, number) => {
    const field = fieldOf(form, pointer);
    const text = words(pointer, field, spec);
    if (!field) return element('li', {}, text ? `${text}: ${message}` : message);
    mark(field, message, number);
    const way = element('button', { type: 'button', class: 'link' }, text);
    way.addEventListener('click', () => field.focus());
    return element('li', {}, way, `: ${message}`);
  });
  place().replaceChildren(element('div', { class: 'note' }, element('ul', {}, ...items)));
  form.querySelector('[data-faulty]')?.focus();
}
