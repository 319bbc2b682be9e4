// The page where a job is made. There is one job document: the form, its JSON and the curl command are views of it.
import { clearFaults, showFaults } from './faults.js';
import { ask, element, inWords, post } from './service.js';

const byId = id => document.getElementById(id);
const form = byId('form');

/** The job as it will be submitted. */
let spec = { model: '', maneuvers: [] };
/** What the service has. */
let maneuvers = [];
/** The document of the model that is chosen. */
let documentOfModel;

// --- places in the job -------------------------------------------------------------------------------------------------

const steps = pointer => pointer.split('/').slice(1);

function read(pointer) {
  return steps(pointer).reduce((at, step) => at?.[step], spec);
}

/** Writes; what is left empty goes, so that the job says only what was chosen. */
function write(pointer, value) {
  const path = steps(pointer);
  const trail = [spec];
  for (const step of path.slice(0, -1)) {
    const at = trail.at(-1);
    at[step] ??= {};
    trail.push(at[step]);
  }
  if (value === undefined) delete trail.at(-1)[path.at(-1)];
  else trail.at(-1)[path.at(-1)] = value;
  for (let depth = path.length - 1; depth > 0; depth--) {
    const at = trail[depth];
    if (Object.keys(at).length === 0) delete trail[depth - 1][path[depth - 1]];
  }
}

const number = text => (text.trim() === '' ? undefined : Number(text));
/** What is no number goes as it is: the service says so, and where. */
const asNumber = text => (Number.isNaN(number(text)) ? text : number(text));

/** A step of a JSON pointer (RFC 6901). */
const escaped = name => name.replaceAll('~', '~0').replaceAll('/', '~1');

// --- maneuvers ---------------------------------------------------------------------------------------------------------

/** Begin and end of parts as they are being written, by use. */
const ends = new WeakMap();

const ROLES = [['', 'not used'], ['estimation', 'estimation'], ['validation', 'validation'], ['final', 'final test']];

/** Where a use of a maneuver is in the job. */
const useAt = use => `/maneuvers/${spec.maneuvers.indexOf(use)}`;

function showManeuvers() {
  const place = byId('maneuvers');
  if (maneuvers.length === 0) {
    place.replaceChildren(element('p', {}, 'There is no maneuver yet: upload one first.'));
    return;
  }
  const rows = maneuvers.flatMap(maneuver => {
    const uses = spec.maneuvers.filter(one => one.id === maneuver.id);
    return uses.length === 0 ? [maneuverRow(maneuver)] : uses.map(use => maneuverRow(maneuver, use));
  });
  const head = ['part', 'maneuver', 'from, s', 'to, s', 'duration, s', 'samples', 'channels'].map(text =>
    element('th', { scope: 'col', class: /, s|samples/.test(text) ? 'number' : undefined }, text));
  const table = element('table', {}, element('thead', {}, element('tr', {}, ...head)), element('tbody', {}, ...rows));
  const scroll = element('div', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': 'Maneuvers' }, table);
  // who is at a field by keyboard stays there
  const focused = document.activeElement?.getAttribute('aria-label');
  const stays = place.contains(document.activeElement);
  place.replaceChildren(scroll);
  if (stays) [...place.querySelectorAll('select, input')].find(field => field.getAttribute('aria-label') === focused)?.focus();
}

/** A maneuver, or a part of it that the job uses. */
function maneuverRow(maneuver, use) {
  const name = maneuver.name || maneuver.id.slice(0, 12);
  const called = use?.label ?? name;
  const role = element('select', { 'aria-label': `part of ${called}`, 'data-at': use && useAt(use) },
    ...ROLES.map(([value, text]) => element('option', { value }, text)));
  role.value = use ? use.role ?? 'estimation' : '';
  role.addEventListener('change', () => {
    if (role.value === '') spec.maneuvers = spec.maneuvers.filter(one => one !== use);
    else if (use) use.role = role.value;
    else spec.maneuvers.push({ id: maneuver.id, label: free(name), role: role.value });
    changed();
    showManeuvers();
    showChannels();
  });
  const { samples, duration, channels } = maneuver.summary;
  const another = use && element('button', { type: 'button', 'aria-label': `another part of ${called}` }, 'Another part');
  another?.addEventListener('click', () => {
    spec.maneuvers.splice(spec.maneuvers.indexOf(use) + 1, 0, { ...use, label: free(name) });
    changed();
    showManeuvers();
  });
  return element('tr', {},
    element('td', {}, role),
    element('th', { scope: 'row' }, element('a', { href: `/maneuvers/${maneuver.id}` }, called), ...(another ? [' ', another] : [])),
    ...[0, 1].map(end => element('td', { class: 'number' }, use && secondsField(use, end, called))),
    element('td', { class: 'number' }, `${Number(duration.toPrecision(4))}`),
    element('td', { class: 'number' }, `${samples}`),
    element('td', { class: 'soft' }, channels.map(channel => channel.name).join(', ')));
}

/** Where a part begins or ends, in seconds of the recording's own time. */
function secondsField(use, end, called) {
  const field = element('input', {
    'aria-label': `${['first', 'last'][end]} second of ${called}`, 'data-at': `${useAt(use)}/seconds/${end}`, inputmode: 'decimal', size: '8',
    placeholder: use.rows ? `row ${use.rows[end]}` : ['beginning', 'end'][end], value: ends.get(use)?.[end] ?? use.seconds?.[end] ?? '',
  });
  field.addEventListener('change', () => {
    const both = ends.get(use) ?? [...use.seconds ?? ['', '']].map(String);
    both[end] = field.value.trim();
    ends.set(use, both);
    delete use.seconds;
    if (both.some(text => text !== '')) delete use.rows;
    if (both.every(text => text !== '')) use.seconds = both.map(asNumber);
    changed();
  });
  return field;
}

/** A label that no other maneuver of the job has. */
function free(name) {
  const taken = new Set(spec.maneuvers.map(one => one.label));
  for (let k = 1; ; k++) {
    const label = k === 1 ? name : `${name} ${k}`;
    if (label !== '' && !taken.has(label)) return label;
  }
}

// --- model -------------------------------------------------------------------------------------------------------------

async function chooseModel() {
  const about = byId('about-model');
  if (typeof spec.model === 'object') {
    documentOfModel = spec.model;
    about.hidden = true;
  } else if (spec.model === '') {
    documentOfModel = undefined;
    about.hidden = true;
  } else {
    about.hidden = false;
    about.href = `/models/${encodeURIComponent(spec.model)}`;
    documentOfModel = await ask(`/v1/models/${encodeURIComponent(spec.model)}`);
  }
  byId('model-text').textContent = [documentOfModel?.title, documentOfModel?.description].filter(Boolean).join('. ');
  showChannels();
  showParameters();
}

/** Channels that all maneuvers of the job have. */
function recorded() {
  const used = spec.maneuvers.map(use => maneuvers.find(one => one.id === use.id)?.summary.channels.map(channel => channel.name) ?? []);
  return used.length === 0 ? [] : used[0].filter(name => used.every(names => names.includes(name)));
}

/** How the model's inputs and outputs are made from channels. */
function showChannels() {
  const place = byId('channels');
  place.replaceChildren();
  if (!documentOfModel || spec.maneuvers.length === 0) return;
  const names = recorded();
  const list = element('datalist', { id: 'recorded' }, ...names.map(name => element('option', { value: name })));
  const fields = [];
  let missing = 0;
  for (const [kind, quantities] of [['input', documentOfModel.inputs], ['output', documentOfModel.outputs]]) {
    for (const [name, quantity] of Object.entries(quantities ?? {})) {
      const isThere = names.includes(name);
      if (!isThere && !spec.channels?.[name]) missing++;
      const input = element('input', { list: 'recorded', 'data-at': `/channels/${escaped(name)}`, placeholder: isThere ? name : 'channel or formula', value: spec.channels?.[name] ?? '' });
      if (!isThere && !spec.channels?.[name]) input.setAttribute('aria-invalid', 'true');
      input.addEventListener('change', () => {
        write(`/channels/${name}`, input.value.trim() === '' ? undefined : input.value.trim());
        changed();
      });
      fields.push(element('label', {}, `${kind} ${name}, ${quantity.unit || '-'}`, input));
    }
  }
  const text = missing > 0
    ? `${missing} of the model's inputs and outputs are no channels of these maneuvers: say from which they come, as a name or a formula such as (da_right - da_left)/2.`
    : 'All inputs and outputs of the model are recorded under their own names.';
  place.replaceChildren(list, element('details', missing > 0 ? { open: '' } : {}, element('summary', {}, text), element('div', { class: 'row' }, ...fields)));
}

/** Start values, bounds and fixings other than the document's. */
function showParameters() {
  const place = byId('parameters');
  place.replaceChildren();
  if (!documentOfModel) return;
  const rows = Object.entries(documentOfModel.parameters ?? {}).map(([name, parameter]) => {
    const given = spec.parameters?.[name] ?? {};
    const field = (key, label) => {
      const input = element('input', {
        'aria-label': `${label} of ${name}`, size: '10', value: given[key] ?? '', placeholder: parameter[key] ?? '',
        inputmode: 'decimal', 'data-at': `/parameters/${escaped(name)}/${key}`,
      });
      input.addEventListener('change', () => {
        // a start value may be an expression in channels
        write(`/parameters/${name}/${key}`, asNumber(input.value.trim()));
        changed();
      });
      return element('td', {}, input);
    };
    const fixed = element('input', { type: 'checkbox', 'aria-label': `${name} is held`, 'data-at': `/parameters/${escaped(name)}/fixed` });
    fixed.checked = given.fixed ?? parameter.fixed ?? false;
    fixed.addEventListener('change', () => {
      write(`/parameters/${name}/fixed`, fixed.checked === (parameter.fixed ?? false) ? undefined : fixed.checked);
      changed();
    });
    return element('tr', {},
      element('th', { scope: 'row' }, name), element('td', { class: 'soft' }, parameter.unit),
      field('start', 'start value'), field('lower', 'lower bound'), field('upper', 'upper bound'),
      element('td', {}, fixed), element('td', { class: 'soft' }, parameter.description ?? ''));
  });
  const head = ['parameter', 'unit (SI)', 'start', 'lower bound', 'upper bound', 'held', 'what it is'].map(text => element('th', { scope: 'col' }, text));
  const table = element('table', {}, element('thead', {}, element('tr', {}, ...head)), element('tbody', {}, ...rows));
  place.replaceChildren(element('div', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': 'Parameters' }, table));
}

// --- the document and its views ----------------------------------------------------------------------------------------

/** What the form says of the document, after either changed. */
function showFields() {
  for (const field of form.querySelectorAll('[data-pointer]')) {
    const value = read(field.dataset.pointer);
    if (field.tagName === 'SELECT') field.value = value ?? field.options[0].value;
    else field.value = value ?? '';
  }
  byId('tags').value = (spec.tags ?? []).join(', ');
  for (const radio of form.querySelectorAll('[name=kind]')) radio.checked = radio.value === (spec.kind ?? 'estimate');
  const select = byId('model');
  const name = typeof spec.model === 'object' ? '' : spec.model;
  select.querySelector('option[value=""]').textContent =
    typeof spec.model === 'object' ? `${spec.model.name} (written out in the job)` : 'choose a model';
  select.value = name;
}

function changed() {
  const json = JSON.stringify(spec, null, 2);
  if (document.activeElement !== byId('json')) byId('json').value = json;
  byId('json-fault').textContent = '';
  const quoted = json.replaceAll("'", String.raw`'\''`);
  byId('curl').textContent = `curl -X POST ${location.origin}/v1/jobs \\\n  -H 'content-type: application/json' \\\n  -d '${quoted}'`;
  // faults stay until the next check: a page that moves while a button is pressed loses the click
  byId('said').textContent = '';
}

async function takeWhole(next) {
  spec = { ...next, maneuvers: next.maneuvers ?? [], model: next.model ?? '' };
  showFields();
  showManeuvers();
  await chooseModel();
}

byId('json').addEventListener('input', () => {
  try {
    JSON.parse(byId('json').value);
    byId('json-fault').textContent = '';
  } catch (error) {
    byId('json-fault').textContent = `This is not JSON: ${error.message}`;
  }
});

byId('json').addEventListener('change', async () => {
  let next;
  try {
    next = JSON.parse(byId('json').value);
  } catch (error) {
    byId('json-fault').textContent = `This is not JSON: ${error.message}`;
    return;
  }
  try {
    await takeWhole(next);
    changed();
  } catch (error) {
    byId('json-fault').textContent = error.message;
  }
});

form.addEventListener('change', event => {
  const field = event.target;
  if (field.dataset.pointer) {
    if (field.tagName === 'SELECT') {
      const isDefault = field.selectedIndex === 0;
      const [, first, second] = steps(field.dataset.pointer);
      // of what has a kind, other kinds have other fields
      if (second === 'kind' || second === 'technique') write(`/options/${first}`, undefined);
      write(field.dataset.pointer, isDefault ? undefined : field.value);
      if (second === 'structure' && !isDefault) write('/options/noise/kind', 'estimated');
      if (second === 'structure' && isDefault) write('/options/noise', undefined);
    } else if (field.type === 'number') {
      write(field.dataset.pointer, number(field.value));
    } else {
      write(field.dataset.pointer, field.value === '' ? undefined : field.value);
    }
    changed();
  } else if (field.name === 'kind') {
    write('/kind', field.value === 'estimate' ? undefined : field.value);
    changed();
  } else if (field.id === 'tags') {
    const tags = field.value.split(',').map(tag => tag.trim()).filter(Boolean);
    write('/tags', tags.length > 0 ? tags : undefined);
    changed();
  } else if (field.id === 'model') {
    if (field.value === '') return;
    spec.model = field.value;
    delete spec.parameters;
    delete spec.channels;
    showFields();
    changed();
    chooseModel().catch(error => { byId('model-text').textContent = error.message; });
  }
});

// --- submitting --------------------------------------------------------------------------------------------------------

function showProblem(error) {
  const faults = error.problem?.errors ?? [];
  byId('said').textContent = '';
  showFaults(form, faults.length > 0 ? faults : [{ pointer: '', message: error.problem ? inWords(error.problem) : error.message }], spec);
}

function sentence({ recording, channel, message, remedy }) {
  const place = [recording, channel].filter(Boolean).join(', ');
  return `${place ? `${place}: ` : ''}${message}${remedy ? `; ${remedy}` : ''}`;
}

/** The first thing that is missing, and where. */
function missing() {
  if (byId('json-fault').textContent !== '') return { pointer: '', message: `The job's JSON cannot be read, and nothing was sent. ${byId('json-fault').textContent}` };
  if (!spec.maneuvers.some(use => (use.role ?? 'estimation') === 'estimation')) return { pointer: '/maneuvers', message: 'Choose a maneuver to be fitted.' };
  const decimals = form.querySelectorAll('[inputmode=decimal]');
  // a start value may be an expression
  const wrong = [...decimals].find(field => !field.dataset.at.endsWith('/start') && Number.isNaN(number(field.value)));
  if (wrong) return { pointer: wrong.dataset.at, message: `'${wrong.value}' is not a number.` };
  for (const use of spec.maneuvers) {
    const open = (ends.get(use) ?? ['', '']).indexOf('');
    if (open >= 0 && ends.get(use)?.[1 - open]) return { pointer: `${useAt(use)}/seconds/${open}`, message: 'Write both seconds of a part, or neither.' };
  }
  if (spec.model === '') return { pointer: '/model', message: 'Choose a model.' };
  return undefined;
}

async function send(address, done) {
  clearFaults();
  const lack = missing();
  byId('said').textContent = lack ? '' : 'Asking the service ...';
  if (lack) {
    showFaults(form, [lack], spec);
    return;
  }
  const buttons = [byId('check'), form.querySelector('button.main')];
  for (const button of buttons) button.disabled = true;
  try {
    done(await post(address, spec));
  } catch (error) {
    showProblem(error);
  }
  for (const button of buttons) button.disabled = false;
}

form.addEventListener('submit', event => {
  event.preventDefault();
  send('/v1/jobs', job => { location.href = `/jobs/${job.id}`; });
});

byId('check').addEventListener('click', () => send('/v1/jobs?validate_only=true', prepared => {
  const { samples, parameters, outputs, findings } = prepared;
  byId('said').textContent = `It can run: ${samples} samples of ${outputs.length} outputs, ${parameters.length} free parameters.`;
  if (findings.length > 0) {
    byId('faults').replaceChildren(element('div', { class: 'note' }, 'But what is odd about the data:',
      element('ul', {}, ...findings.map(finding => element('li', {}, sentence(finding))))));
  }
}));

// who comes back to the page has nothing under way
addEventListener('pageshow', () => { byId('said').textContent = ''; });

// --- beginning ---------------------------------------------------------------------------------------------------------

/** All pages of a list. */
async function all(address, key) {
  const entries = [];
  let cursor = '';
  do {
    const page = await ask(`${address}?limit=200${cursor}`);
    entries.push(...page[key]);
    cursor = page.next_cursor ? `&cursor=${encodeURIComponent(page.next_cursor)}` : '';
  } while (cursor !== '' && entries.length < 2000);
  return entries;
}

/** A model in the list; of stored ones, which may have equal names, with when it was stored and the end of its id. */
function modelText({ id, name, title, created }) {
  const text = title ? `${name}: ${title}` : name;
  return created ? `${text} (stored ${new Date(created).toLocaleString()}, ${id.slice(-8)})` : text;
}

async function begin() {
  const query = new URLSearchParams(location.search);
  const [stored, models] = await Promise.all([all('/v1/maneuvers', 'maneuvers'), all('/v1/models', 'models')]);
  maneuvers = stored;
  byId('model').replaceChildren(
    element('option', { value: '' }, 'choose a model'),
    ...models.map(model => element('option', { value: model.id }, modelText(model))));
  const like = query.get('like');
  if (like) {
    await takeWhole(await ask(`/v1/jobs/${encodeURIComponent(like)}/spec`));
  } else {
    spec = { model: query.get('model') ?? '', maneuvers: [] };
    if (query.get('name')) spec.name = query.get('name');
    if (query.get('kind')) spec.kind = query.get('kind');
    for (const [role] of ROLES.slice(1)) {
      for (const id of query.getAll(role)) {
        const maneuver = maneuvers.find(one => one.id === id);
        if (maneuver) spec.maneuvers.push({ id, label: free(maneuver.name || 'maneuver'), role });
      }
    }
    await takeWhole(spec);
  }
  // those of the job on top
  const isUsed = maneuver => spec.maneuvers.some(use => use.id === maneuver.id);
  maneuvers = [...maneuvers.filter(isUsed), ...maneuvers.filter(maneuver => !isUsed(maneuver))];
  showManeuvers();
  changed();
}

begin().catch(error => { byId('maneuvers').textContent = error.message; });
