// The head of a recorded CSV file as the browser sees it: columns, units and first values. The service reads the whole with all its
// rules (src/core/ingest/csv); what is told here is for people to look at.

/** Bytes of the head. */
const HEAD = 65536;

const ANY = 'application/octet-stream';

const TYPES = {
  csv: 'text/csv', tsv: 'text/csv', json: 'application/json', mat: 'application/x-matlab-data', asc: 'text/plain', dat: 'text/plain',
  // the service finds out what these are
  xlsx: ANY, xlsm: ANY, ulg: ANY, ulog: ANY, bin: ANY, gz: ANY, zip: ANY,
};

/** What a file is sent as, and for CSV what stands in its head. */
export async function lookAt(file) {
  const extension = file.name.split('.').pop().toLowerCase();
  const type = TYPES[extension] ?? 'text/csv';
  if (extension in TYPES && type !== 'text/csv') return { type };
  const bytes = await file.slice(0, HEAD).arrayBuffer();
  const text = new TextDecoder().decode(bytes).replace(/^\ufeff/, '');
  const head = readHead(text, file.size > HEAD);
  // a text without a header is a matrix
  if (head === undefined && !(extension in TYPES)) return { type: 'text/plain' };
  return { type, head };
}

const isComment = line => /^ *[#%]/.test(line) && !/^ *(#(n\/a|num!|value!|div\/0!|ref!|name\?|null!)|%\s*[,;\t])/i.test(line);
const unquoted = cell => cell.trim().replace(/^"(.*)"$/, '$1').trim();
const isMissing = cell => /^(|nan|na|n\/a|#n\/a|null|[+-]?inf(inity)?|-?1\.#(inf|ind|qnan))$/i.test(cell);
const isNumber = cell => /^[+-]?(\d+[.,]?\d*|[.,]\d+)(e[+-]?\d+)?$/i.test(cell);
const isStamp = cell => /\d:\d\d:\d\d/.test(cell);

/** Columns and rows of the text of a head; nothing where there is no header. */
function readHead(text, isCut) {
  let lines = text.split(/\r\n|\n|\r/);
  // the last line may be a part of one
  if (isCut) lines.pop();
  lines = lines.filter(line => line.trim() !== '' && !isComment(line));
  const declared = /^\s*"?sep=(.)/i.exec(lines[0] ?? '')?.[1];
  if (declared) lines.shift();
  const header = lines.shift();
  if (header === undefined) return undefined;
  const delimiter = declared ?? [',', ';', '\t'].find(mark => header.includes(mark)) ?? ',';
  const cells = line => line.split(delimiter).map(unquoted);
  const titles = cells(header);
  if (titles.at(-1) === '' && titles.length > 1) titles.pop();
  if (titles.every(isNumber) || (titles.length === 1 && /\s/.test(header.trim()))) return undefined;
  const rows = lines.map(line => cells(line).slice(0, titles.length));
  let units = [];
  if (rows.length > 0 && isUnitRow(titles, rows[0])) units = rows.shift().map(cell => cell.replace(/^[[(](.*)[\])]$/, '$1').trim());
  const decimalComma = delimiter !== ',' && rows.some(row => row.some(cell => isNumber(cell) && cell.includes(',')));
  const number = cell => {
    if (cell === undefined || !isNumber(cell)) return NaN;
    return Number(decimalComma ? cell.replace(',', '.') : cell);
  };
  const columns = titles.map((title, at) => {
    const split = splitTitle(title);
    const texts = rows.map(row => row[at] ?? '');
    return {
      at, title, name: split.name, unit: split.unit || units[at] || '',
      first: texts.slice(0, 3), values: texts.map(number).filter(Number.isFinite),
      hasStamps: isStamp(texts[0] ?? ''), hasWords: texts.some(cell => !isNumber(cell) && !isMissing(cell)),
    };
  });
  return { columns, rows: rows.length, isCut, time: timeColumn(columns) };
}

/** Name and unit of `alpha[deg]`, `alpha (deg)` or `mach`; `q(1)` is a name. */
function splitTitle(title) {
  const found = /^([^[]*)\[(.*)\]$/.exec(title) ?? /^([^(]*)\((.*)\)$/.exec(title);
  const isIndex = found && title.endsWith(')') && /^\s*\d*\s*$/.test(found[2]);
  return found && !isIndex ? { name: found[1].trim(), unit: found[2].trim() } : { name: title, unit: '' };
}

function isUnitRow(titles, cells) {
  const isTime = title => /^(t|time|timestamp)$/i.test(splitTitle(title).name);
  return cells.length === titles.length
    && cells.every((cell, at) => !(isNumber(cell) || isStamp(cell)) || (cell === '1' && !isTime(titles[at])))
    && cells.some(cell => !isMissing(cell) && !isNumber(cell));
}

/** Which column is time, as the service finds it; -1: none. */
function timeColumn(columns) {
  const called = columns.filter(column => /^(t|time)$/i.test(column.name));
  const found = called.find(column => /^(s|sec|ms|us|µs|min|h|hr)$/.test(column.unit))
    ?? called.find(column => column.hasStamps)
    ?? called[0]
    ?? columns.find(column => /^timestamp$/i.test(column.name));
  return found?.at ?? -1;
}
