// The page of all models: a model of one's own, and what is wrong with it.
import { ask, element, localTimes } from './service.js';

const form = document.getElementById('add');
const text = document.getElementById('document');
const file = document.getElementById('file');
const drop = document.getElementById('drop');
const said = document.getElementById('said');
const faults = document.getElementById('faults');

const LARGEST = 4e6;
const LONGEST_QUOTE = 300;

const SECTIONS = {
  constants: 'constant', inputs: 'input', parameters: 'parameter', definitions: 'definition', states: 'state', outputs: 'output',
};

/** The steps of a JSON pointer (RFC 6901). */
const steps = pointer => pointer.split('/').slice(1).map(step => step.replaceAll('~1', '/').replaceAll('~0', '~'));

/** A place in a document for people: "derivative of the state q". */
function place(pointer) {
  const [section, name, ...rest] = steps(pointer);
  if (section === undefined) return 'the document';
  if (name === undefined) return section;
  const what = `${SECTIONS[section] ?? section} ${name}`;
  return rest.length === 0 ? what : `${rest.join(' ')} of the ${what}`;
}

/** Where a place begins and ends in the text, TOML or JSON; undefined where it is not found. */
function lineOf(pointer) {
  let at = 0;
  let found = false;
  for (const step of steps(pointer)) {
    const name = step.replace(/[.*+?^${}()|[\]\\]/g, '\\$&');
    // "q": of JSON, q = of TOML, and [states.q]
    const key = new RegExp(`(^|[\\s{,."[])"?${name}"?\\s*(=|:|\\]|\\.)`, 'm');
    const match = key.exec(text.value.slice(at));
    if (!match) break;
    at += match.index + match[1].length;
    found = true;
  }
  if (!found) return undefined;
  const start = text.value.lastIndexOf('\n', at - 1) + 1;
  const end = text.value.indexOf('\n', at);
  const line = { start, end: end < 0 ? text.value.length : end };
  // a document may be one long line
  return line.end - line.start > LONGEST_QUOTE ? { start: at, end: Math.min(line.end, at + LONGEST_QUOTE) } : line;
}

/** The line of the text, counted from 1. */
function rangeOf(line) {
  const lines = text.value.split('\n');
  if (!(line >= 1 && line <= lines.length)) return undefined;
  const start = lines.slice(0, line - 1).reduce((sum, one) => sum + one.length + 1, 0);
  return { start, end: start + lines[line - 1].length };
}

function show({ start, end }) {
  text.focus();
  text.setSelectionRange(start, end);
  const lines = text.value.slice(0, start).split('\n').length;
  text.scrollTop = (lines - 4) * (text.scrollHeight / text.value.split('\n').length);
}

/** What is wrong in one place: in words, the line quoted, and a way to it. */
function entry(title, message, range) {
  const item = element('li', {}, element('strong', {}, title), ` ${message}`);
  if (range) {
    const number = text.value.slice(0, range.start).split('\n').length;
    const go = element('button', { type: 'button' }, `Go to line ${number}`);
    go.addEventListener('click', () => show(range));
    item.append(element('pre', {}, text.value.slice(range.start, range.end).trim()), go);
  }
  return item;
}

function tell(error) {
  const problem = error.problem ?? {};
  const list = problem.errors ?? [];
  if (list.length === 0) {
    const line = /line (\d+)/.exec(error.message);
    const message = element('pre', {}, error.message);
    const range = line ? rangeOf(Number(line[1])) : undefined;
    faults.replaceChildren(element('p', {}, 'The document cannot be read:'), message);
    if (range) {
      const go = element('button', { type: 'button' }, `Go to line ${line[1]}`);
      go.addEventListener('click', () => show(range));
      faults.append(go);
    }
    return;
  }
  const entries = list.map(fault => entry(`${place(fault.pointer)}:`, fault.message, lineOf(fault.pointer)));
  const count = list.length === 1 ? 'One thing is' : `${list.length} things are`;
  faults.replaceChildren(element('p', {}, `${count} to be put right:`), element('ol', { class: 'faults' }, ...entries));
}

async function store(event) {
  event.preventDefault();
  const button = form.querySelector('button');
  button.disabled = true;
  faults.replaceChildren();
  said.textContent = 'Checking ...';
  const isJson = text.value.trimStart().startsWith('{');
  try {
    const stored = await ask('/v1/models', {
      method: 'POST',
      headers: { 'content-type': isJson ? 'application/json' : 'application/toml' },
      body: text.value,
    });
    location.href = `/models/${stored.id}`;
  } catch (error) {
    said.textContent = 'It was not stored.';
    tell(error);
  } finally {
    button.disabled = false;
  }
}

async function read(chosen) {
  if (!chosen) return;
  if (chosen.size > LARGEST) {
    said.textContent = `${chosen.name} is too large for a model document (${LARGEST / 1e6} MB at most).`;
    return;
  }
  try {
    text.value = await chosen.text();
    faults.replaceChildren();
    said.textContent = `Read ${chosen.name}; nothing is stored yet.`;
    text.focus();
  } catch {
    said.textContent = `${chosen.name} cannot be read; choose it again.`;
  }
}

// --- deleting ----------------------------------------------------------------------------------------------------------

for (const button of document.querySelectorAll('[data-delete]')) {
  button.addEventListener('click', async () => {
    const { delete: id, name } = button.dataset;
    const question = `Delete the stored model ${name} (${id})? Jobs that used it keep their copy.`;
    if (!confirm(question)) return;
    const live = document.getElementById('live');
    button.disabled = true;
    try {
      await ask(`/v1/models/${id}`, { method: 'DELETE' });
      button.closest('tr').remove();
      live.textContent = `${name} is deleted.`;
    } catch (error) {
      live.textContent = `${name} was not deleted: ${error.message}`;
      button.disabled = false;
    }
  });
}

form.addEventListener('submit', store);
file.addEventListener('change', () => read(file.files[0]));
drop.addEventListener('dragover', event => {
  event.preventDefault();
  drop.classList.add('over');
});
drop.addEventListener('dragleave', () => drop.classList.remove('over'));
drop.addEventListener('drop', event => {
  drop.classList.remove('over');
  if (event.dataTransfer.files.length > 0) {
    event.preventDefault();
    read(event.dataTransfer.files[0]);
  }
});
localTimes();
