// The page of all maneuvers: files are looked at, corrected, and sent.
import { columnTable } from './columns.js';
import { lookAt } from './recording.js';
import { ask, element, localTimes, post } from './service.js';
import { upload } from './upload.js';

const byId = id => document.getElementById(id);
const waiting = new Set();

/** What does not fit into an address. */
const LONGEST_MAPPING = 60000;

/** A chosen file: its form, and what became of it. */
class Chosen {
  constructor(file) {
    this.file = file;
    const made = byId('file').content.cloneNode(true);
    this.node = made.firstElementChild;
    this.parts = Object.fromEntries([...made.querySelectorAll('[data-part]')].map(part => [part.dataset.part, part]));
    const { parts } = this;
    const stem = file.name.replace(/\.[^.]*$/, '');
    parts.title.textContent = file.name;
    this.node.setAttribute('aria-label', file.name);
    parts.name.value = stem.slice(0, 200);
    parts.kept.value = stem.replace(/[^A-Za-z0-9_.-]+/g, '-').slice(0, 64);
    parts.about.textContent = file.size < 1e6 ? `${Math.ceil(file.size / 1e3)} kB` : `${(file.size / 1e6).toFixed(1)} MB`;
    parts.send.addEventListener('click', () => this.send());
    parts.drop.addEventListener('click', () => { this.remove(); byId('choose').focus(); });
    parts.mapping.addEventListener('change', () => this.chooseMapping());
    parts.text.addEventListener('input', () => this.mappingChanged());
    byId('files').append(this.node);
    waiting.add(this);
    countWaiting();
  }

  async look() {
    const { parts } = this;
    try {
      Object.assign(this, await lookAt(this.file));
    } catch {
      this.tell('The browser cannot read this file; was it moved or deleted?');
      return;
    }
    const isCsv = this.type === 'text/csv';
    if (this.type === 'application/json') parts.mappings.hidden = true;
    else if (!isCsv) {
      parts.document.hidden = false;
      const isKnown = this.type !== 'application/octet-stream';
      parts.about.textContent += isKnown ? '; names and units come from a mapping' : '; a mapping may say other names and units than it does';
    } else if (this.head) {
      parts.mapping.options[0].textContent = 'as the file says';
      this.table = columnTable(this.head, () => this.mappingChanged());
      parts.columns.append(this.table.node);
    } else {
      parts.mappings.hidden = true;
      parts.about.textContent += '; no header was found in it';
    }
    this.mappingChanged();
  }

  mappingChanged() {
    const { parts } = this;
    this.isNamed = false;
    parts.keeping.hidden = this.table ? !this.table.isChanged() : parts.text.value.trim() === '';
  }

  async chooseMapping() {
    const { parts } = this;
    const name = parts.mapping.value;
    this.tell('');
    try {
      const document = name ? await ask(`/v1/mappings/${encodeURIComponent(name)}`) : undefined;
      if (this.table && document) {
        const missing = this.table.take(document);
        if (missing.length > 0) this.tell(`The mapping takes columns that this file does not have: ${missing.join(', ')}`);
      } else if (this.table) this.table.reset();
      else parts.text.value = document ? JSON.stringify(document, null, 2) : '';
      this.mappingChanged();
      // what is kept already need not be kept again
      this.isNamed = document !== undefined && !this.table;
      if (document) parts.keeping.hidden = true;
    } catch (error) {
      this.tell(error.message);
    }
  }

  /** The mapping to send: a name, a document, or nothing. */
  wantedMapping() {
    const { parts } = this;
    const about = `made for ${this.file.name}`;
    if (this.table) return this.table.isChanged() ? JSON.stringify(this.table.mapping(about)) : '';
    if (this.isNamed) return parts.mapping.value;
    const text = parts.text.value.trim();
    if (text === '') return '';
    try {
      return JSON.stringify(JSON.parse(text));
    } catch (error) {
      throw new Error(`The mapping is not JSON: ${error.message}`);
    }
  }

  async send() {
    const { parts } = this;
    parts.send.disabled = true;
    this.tell('');
    try {
      let mapping = this.wantedMapping();
      if (mapping.startsWith('{') && parts.keep.checked && !parts.keeping.hidden) {
        const name = parts.kept.value.trim();
        await post(`/v1/mappings?name=${encodeURIComponent(name)}`, JSON.parse(mapping));
        offerMapping(name);
        mapping = name;
      }
      const query = new URLSearchParams({ name: parts.name.value.trim() });
      if (mapping) query.set('mapping', mapping);
      if (query.toString().length > LONGEST_MAPPING) {
        throw new Error('The mapping is too long to go with the file; keep it under a name.');
      }
      parts.progress.hidden = false;
      const answer = await upload(`/v1/maneuvers?${query}`, this.type, this.file, share => this.progress(share));
      this.stored(answer);
    } catch (error) {
      this.failed(error);
    }
    parts.progress.hidden = true;
    parts.send.disabled = false;
  }

  progress(share) {
    // when all is sent the service reads it, and nobody knows how long
    if (share < 1) this.parts.progress.value = share;
    else this.parts.progress.removeAttribute('value');
  }

  stored({ maneuver, isNew }) {
    const { findings } = maneuver.summary;
    const link = element('a', { href: `/maneuvers/${maneuver.id}` }, maneuver.name || maneuver.id.slice(0, 12));
    const said = element('p', {}, isNew ? 'Stored as ' : 'The same recording is here already, as ', link,
      `: ${maneuver.summary.samples} samples of ${maneuver.summary.channels.length} channels. `,
      findings.length === 0 ? 'Nothing is odd about the data.' : 'What is odd about the data:');
    const list = element('ul', {}, ...findings.map(({ severity, channel, message, remedy }) => element('li', {},
      element('span', { class: `state ${severity === 'warning' ? 'failed' : 'queued'}` }, severity), ' ',
      channel ? `${channel}: ` : '', message, element('div', { class: 'soft' }, remedy))));
    this.parts.form.hidden = true;
    this.parts.told.replaceChildren(said, ...(findings.length > 0 ? [list] : []),
      element('p', {}, element('a', { class: 'button', href: `/new?estimation=${maneuver.id}` }, 'New job with it')));
    this.parts.title.focus();
    waiting.delete(this);
    countWaiting();
    refresh();
  }

  failed(error) {
    const faults = error.problem?.errors ?? [];
    this.table?.mark(faults);
    this.offerDraft(error.problem?.mapping);
    this.tell(faults.length > 0 ? 'It was not stored. Correct this, and send it again:' : error.message, faults.map(({ pointer, message }) =>
      element('li', {}, pointer ? element('code', {}, pointer) : '', ' ', message)));
  }

  /** The service's draft of a mapping for this file, where there is no table to correct it in. */
  offerDraft(draft) {
    const { parts } = this;
    if (!draft || this.table || parts.text.value.trim() !== '') return;
    parts.mappings.hidden = false;
    parts.document.hidden = false;
    parts.text.value = JSON.stringify(draft, null, 2);
    this.mappingChanged();
  }

  tell(text, items = []) {
    const said = text === '' ? [] : [element('div', { class: 'note' }, text, ...(items.length > 0 ? [element('ul', {}, ...items)] : []))];
    this.parts.told.replaceChildren(...said);
  }

  remove() {
    this.node.remove();
    waiting.delete(this);
    countWaiting();
  }
}

/** A mapping that was kept just now can be chosen for the next file. */
function offerMapping(name) {
  for (const select of [byId('file').content, ...document.querySelectorAll('section.file')].map(place => place.querySelector('[data-part=mapping]'))) {
    if (![...select.options].some(option => option.value === name)) select.append(element('option', { value: name }, name));
  }
}

function countWaiting() {
  byId('all').hidden = waiting.size < 2;
}

/** The list, as it is now; what is chosen in it stays so. */
async function refresh() {
  const list = byId('maneuvers');
  try {
    const answer = await fetch(location.href);
    const page = new DOMParser().parseFromString(await answer.text(), 'text/html');
    const fresh = page.getElementById('maneuvers');
    if (!answer.ok || !fresh) return;
    const chosen = [...list.querySelectorAll('input:checked')].map(box => box.value);
    list.replaceChildren(...fresh.childNodes);
    for (const box of list.querySelectorAll('input[type=checkbox]')) box.checked = chosen.includes(box.value);
    localTimes(list);
  } catch {
    byId('live').textContent = 'The list is not up to date: the service does not answer.';
  }
}

function choose(files) {
  for (const file of files) new Chosen(file).look();
}

const drop = byId('drop');
const hasFiles = event => event.dataTransfer?.types.includes('Files');
// a file that misses the place must not take the page away
for (const name of ['dragover', 'drop']) {
  document.addEventListener(name, event => { if (hasFiles(event)) event.preventDefault(); });
}
drop.addEventListener('dragover', () => drop.classList.add('over'));
drop.addEventListener('dragleave', () => drop.classList.remove('over'));
drop.addEventListener('drop', event => {
  drop.classList.remove('over');
  choose(event.dataTransfer.files);
});
byId('choose').addEventListener('change', event => {
  choose([...event.target.files]);
  // the same file may be chosen again
  event.target.value = '';
});
byId('all').addEventListener('click', async () => {
  byId('all').disabled = true;
  for (const chosen of [...waiting]) await chosen.send();
  byId('all').disabled = false;
});
localTimes();
