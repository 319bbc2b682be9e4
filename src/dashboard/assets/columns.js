// The columns of a file as they were recorded, and the channels that they become: to be checked and corrected before anything is stored.
import { element } from './service.js';

/** Beyond it a value is hardly in radians: no vane and no surface gets to 69 deg, little flies that turns faster, and other angles
 * are within a turn (as the service has it of jobs, src/core/job/prepare/plausible.rs). Without a bound, undefined. */
function most(name, unit) {
  if (unit === 'rad/s') return 20;
  if (unit !== 'rad') return undefined;
  const isVane = /^(alpha|beta|alfa|aoa|aos)(?!.*dot)/.test(name);
  const isSurface = /^(delta|d(?!.*dt).)/.test(name);
  return isVane || isSurface ? 1.2 : 7;
}

const isName = text => /^[A-Za-z_][A-Za-z0-9_]*$/.test(text) && text !== 't';
const short = value => String(Number(value.toPrecision(4)));
/** A cell with no more digits than can be taken in. */
const inShort = cell => (cell.length > 8 && Number.isFinite(Number(cell)) ? short(Number(cell)) : cell);
const GREEK = { α: 'alpha', β: 'beta', γ: 'gamma', δ: 'delta', θ: 'theta', Θ: 'theta', φ: 'phi', Φ: 'phi', ψ: 'psi', ρ: 'rho' };

/** A channel's name close to what stands over the column. */
function nameLike(text) {
  if (isName(text)) return text;
  const plain = text.replace(/./gu, c => GREEK[c] ?? (/[A-Za-z0-9]/.test(c) ? c : '_')).replace(/_+/g, '_').replace(/^_|_$/g, '') || 'channel';
  if (plain === 't') return 't_2';
  return /^\d/.test(plain) ? `_${plain}` : plain;
}

/** How values in a unit are shown to people, as the page's list of units has it. */
function shownIn(unit) {
  const option = [...document.getElementById('units').options].find(known => known.value === (unit || '-'));
  return option && { scale: Number(option.dataset.scale), offset: Number(option.dataset.offset), unit: option.dataset.shown };
}

const isOfTime = unit => /^(s|sec|ms|us|µs|min|h|hr)$/.test(unit);
const isIncreasing = ({ values }) => values.every((value, k) => k === 0 || value > values[k - 1]);

/** The least and the greatest of many values. */
const rangeOf = values => values.reduce(([least, most], value) => [Math.min(least, value), Math.max(most, value)], [Infinity, -Infinity]);

/** The table of a head (see recording.js): its element, and the mapping that it amounts to. `onChange` is told of every change. */
export function columnTable(head, onChange) {
  // under another name than t or time
  const guessed = head.time >= 0 ? head.time : head.columns.findIndex(column =>
    column.hasStamps || (isOfTime(column.unit) && isIncreasing(column)));
  const taken = new Set();
  const isText = column => column.hasWords && column.values.length === 0;
  const asRead = column => (column.at === guessed ? 'time' : isText(column) ? 'out' : 'channel');
  const rows = head.columns.map(column => {
    const stem = nameLike(column.name);
    let name = stem;
    for (let number = 2; taken.has(name); number += 1) name = `${stem}_${number}`;
    if (column.at !== guessed) taken.add(name);
    return { column, name, unit: column.unit, as: asRead(column), range: rangeOf(column.values), parts: {}, fault: '' };
  });
  const isAlone = name => head.columns.filter(column => column.name === name).length === 1;
  const source = ({ name, at }) => (isName(name) || name === 't') && isAlone(name) ? name : `(:,${at + 1})`;

  function show(row) {
    const { column, as, parts } = row;
    parts.as.value = as;
    parts.name.value = as === 'time' ? 't' : row.name;
    parts.unit.value = row.unit;
    parts.name.disabled = as !== 'channel';
    parts.unit.disabled = as === 'out' || (as === 'time' && column.hasStamps);
    parts.line.classList.toggle('soft', as === 'out');
    const [least, most] = row.range;
    const shown = as === 'channel' && column.values.length > 0 ? shownIn(row.unit) : undefined;
    parts.shown.textContent = shown
      ? `${short(least * shown.scale + shown.offset)} to ${short(most * shown.scale + shown.offset)} ${shown.unit === '-' ? '' : shown.unit}`
      : '';
    const remarks = as === 'out' ? [] : remarksOn(row);
    parts.remarks.replaceChildren(...remarks.map(({ text, isBad, act }) => {
      const line = element('div', { class: isBad ? 'bad' : 'soft' }, text);
      if (act) {
        const button = element('button', { type: 'button' }, act.text);
        button.addEventListener('click', () => { act.run(); changed(row); parts.unit.focus(); });
        line.append(' ', button);
      }
      return line;
    }));
    parts.name.setAttribute('aria-invalid', String(as === 'channel' && !isName(row.name)));
  }

  function remarksOn(row) {
    const { column, as, unit, name } = row;
    const remarks = row.fault ? [{ text: row.fault, isBad: true }] : [];
    if (as === 'time') {
      if (column.at !== head.time && column.at === guessed) remarks.push({ text: 'Taken for time: it has a unit of time and increases.' });
      if (!isIncreasing(column)) remarks.push({ text: 'Time does not increase.', isBad: true });
      if (!unit && !column.hasStamps) remarks.push({ text: 'Time needs a unit: s, ms, ...', isBad: true });
      return remarks;
    }
    if (!isName(name)) remarks.push({ text: 'A name has letters, digits and _ only, no digit first, and is not t.', isBad: true });
    if (rows.some(other => other !== row && other.as === 'channel' && other.name === name)) {
      remarks.push({ text: 'Another channel has this name.', isBad: true });
    }
    if (column.hasWords) remarks.push({ text: 'Some of its cells are no numbers.', isBad: true });
    const bound = most(name, unit);
    if (bound !== undefined && Math.max(...row.range.map(Math.abs)) > bound && column.values.length > 0) {
      const degrees = unit.replace('rad', 'deg');
      remarks.push({
        text: `Beyond ${bound} ${unit}: degrees, probably.`, isBad: true,
        act: { text: `It is ${degrees}`, run: () => { row.unit = degrees; } },
      });
    }
    if (!unit) remarks.push({ text: 'No unit: taken as a pure number.' });
    else if (!shownIn(unit) && !row.fault) remarks.push({ text: 'Not in the list of units; the service will tell if it knows it.' });
    if (column.values.length > 0 && row.range[0] === row.range[1]) remarks.push({ text: 'Constant so far.' });
    return remarks;
  }

  /** Names may collide with those of other rows: all are looked at anew. */
  function changed(row) {
    row.fault = '';
    rows.forEach(show);
    onChange();
  }

  for (const row of rows) {
    const { column, parts } = row;
    const of = `of column ${column.at + 1}, ${column.title}`;
    parts.as = element('select', { 'aria-label': `use ${of}` },
      ...[['channel', 'channel'], ['time', 'time'], ['out', 'leave out']].map(([value, text]) => element('option', { value }, text)));
    parts.name = element('input', { 'aria-label': `name ${of}`, size: 12, autocomplete: 'off', spellcheck: 'false' });
    parts.unit = element('input', { 'aria-label': `unit ${of}`, size: 7, list: 'units', autocomplete: 'off', spellcheck: 'false', placeholder: '-' });
    parts.shown = element('td', { class: 'number' });
    parts.remarks = element('td', { class: 'remarks' });
    parts.as.addEventListener('change', () => {
      row.as = parts.as.value;
      // there is one time
      if (row.as === 'time') {
        for (const other of rows) if (other !== row && other.as === 'time') other.as = 'channel';
      }
      changed(row);
    });
    parts.name.addEventListener('input', () => { row.name = parts.name.value.trim(); changed(row); });
    parts.unit.addEventListener('input', () => { row.unit = parts.unit.value.trim(); changed(row); });
    const range = column.values.length > 0 ? `${short(row.range[0])} to ${short(row.range[1])}` : '';
    parts.line = element('tr', {},
      element('td', {}, parts.as),
      element('th', { scope: 'row' }, column.name || `(column ${column.at + 1})`),
      element('td', { class: 'soft' }, column.unit),
      element('td', {}, parts.name), element('td', {}, parts.unit), parts.remarks,
      element('td', { class: 'number' }, range), parts.shown,
      element('td', { class: 'soft' }, column.first.map(inShort).join('; ')));
  }
  rows.forEach(show);
  const titles = ['use as', 'column', 'unit in the file', 'channel', 'unit', 'remarks', 'range', 'range as shown', 'first values'];
  const isNumber = title => title.startsWith('range');
  const node = element('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Columns' },
    element('table', {},
      element('caption', {}, guessed < 0 ? 'No column is called t or time: say which it is. ' : '', head.isCut ? `Ranges are those of the first ${head.rows} rows.` : `${head.rows} rows.`),
      element('thead', {}, element('tr', {}, ...titles.map(title => element('th', { scope: 'col', class: isNumber(title) && 'number' }, title)))),
      element('tbody', {}, ...rows.map(row => row.parts.line))));

  const isAsRecorded = ({ column, as, name, unit }) =>
    as === (column.at === head.time ? 'time' : 'channel') && unit === column.unit && (as === 'time' || name === column.name);

  return {
    node,
    /** Whether the file says something else than what is wanted of it. */
    isChanged: () => !rows.every(isAsRecorded),
    /** The mapping document; throws what is missing for one. */
    mapping(about) {
      const time = rows.find(row => row.as === 'time');
      if (!time) throw new Error('No column is time; say which by "use as".');
      const channels = {};
      for (const row of rows.filter(row => row.as === 'channel')) {
        if (row.name in channels) throw new Error(`Two columns are to be the channel ${row.name}; rename one, or leave it out.`);
        channels[row.name] = { from: source(row.column), unit: row.unit || '-' };
      }
      return { about, time: { from: source(time.column), unit: time.column.hasStamps ? 's' : time.unit }, channels };
    },
    /** Takes over a mapping document; what of it the file does not have. */
    take({ time, channels }) {
      const find = from => rows.find(({ column }) => {
        const number = /^\(\s*:\s*,\s*(\d+)\s*\)$/.exec(from?.trim() ?? '');
        return number ? column.at + 1 === Number(number[1]) : column.name === from;
      });
      for (const row of rows) row.as = 'out';
      const missing = [];
      for (const [name, { from, unit }] of [['t', time], ...Object.entries(channels)]) {
        const row = find(from);
        if (row) Object.assign(row, { as: name === 't' ? 'time' : 'channel', unit, name: name === 't' ? row.name : name });
        else missing.push(from ?? 'time');
      }
      rows.forEach(show);
      return missing;
    },
    /** As the file was read at first. */
    reset() {
      for (const row of rows) {
        Object.assign(row, { as: asRead(row.column), unit: row.column.unit });
      }
      rows.forEach(show);
    },
    /** Shows faults of the service (RFC 9457 `errors`) at their columns. */
    mark(faults) {
      for (const { pointer, message } of faults) {
        const place = pointer.split('/').slice(1).map(part => part.replaceAll('~1', '/').replaceAll('~0', '~'));
        const name = place[0] === 'rows' ? place[2] : place[1];
        const row = rows.find(({ column, as, name: own }) =>
          (place[0] === 'time' && as === 'time') || own === name || column.name === name || (place[0] === 'columns' && String(column.at + 1) === name));
        if (row && !row.fault) row.fault = message;
      }
      rows.forEach(show);
    },
  };
}
