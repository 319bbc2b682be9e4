// Figures as files: for a slide, a report, a table.
import { element } from './service.js';

/** What the pages look like on paper: `make` is asked while the page counts as light. */
export function inLight(make) {
  const { style } = document.documentElement;
  const before = style.colorScheme;
  style.colorScheme = 'light';
  try {
    return make();
  } finally {
    style.colorScheme = before;
  }
}

const TYPES = { svg: 'image/svg+xml', csv: 'text/csv', png: 'image/png' };

/** Saves text, or what a data URL holds, under a name made of that of the figure. */
export function save(name, ending, content) {
  const binary = content.startsWith('data:')
    ? Uint8Array.from(atob(content.replace(/^[^,]*,/, '')), letter => letter.charCodeAt(0))
    : content;
  const address = URL.createObjectURL(new Blob([binary], { type: TYPES[ending] }));
  const file = `${name.replace(/[^\p{L}\p{N}]+/gu, '-').replace(/^-|-$/g, '').slice(0, 80) || 'figure'}.${ending}`;
  const link = element('a', { href: address, download: file });
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** Buttons that save a figure, by what they save it as. */
export function bar(name, acts) {
  const said = element('span', { role: 'status' });
  const buttons = Object.entries(acts).map(([what, act]) => {
    const button = element('button', { type: 'button', class: 'link', 'data-save': what.toLowerCase(), 'aria-label': `save ${name} as ${what}` }, what);
    button.addEventListener('click', async () => {
      said.textContent = '';
      try {
        await act();
      } catch (error) {
        said.textContent = error.message;
      }
    });
    return button;
  });
  return element('p', { class: 'save' }, 'Save as ', ...buttons, said);
}

/** A cell that no spreadsheet takes for a formula. */
const cell = text => {
  const safe = /^[=+\-@\t\r]/.test(text) ? `'${text}` : text;
  return /[",\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
};

/** What a plot shows as a table: a column for x, one for each series; series over another x have a column of their own for it. */
export function csvOf({ traces, layout }) {
  const across = layout.xaxis?.title?.text ?? 'x';
  const [from, to] = layout.xaxis?.range ?? [-Infinity, Infinity];
  const columns = [];
  let last;
  for (const trace of traces) {
    // nothing stands for a gap
    const rows = [...trace.x.keys()].filter(k => trace.x[k] !== null && !(trace.x[k] < from || trace.x[k] > to));
    const x = rows.map(k => trace.x[k]);
    if (last === undefined || x.length !== last.length || x.some((value, k) => value !== last[k])) {
      columns.push([across, x]);
      last = x;
    }
    const title = trace.title ?? layout.yaxis?.title?.text ?? '';
    columns.push([[title, trace.name].filter(Boolean).join(' - '), rows.map(k => trace.y[k])]);
  }
  const length = Math.max(...columns.map(([, values]) => values.length));
  const lines = [columns.map(([title]) => cell(title)).join(',')];
  for (let k = 0; k < length; k++) lines.push(columns.map(([, values]) => values[k] ?? '').join(','));
  return `${lines.join('\n')}\n`;
}

/** What style sheets say of a drawing, written into it. */
function resolved(svg) {
  const copy = svg.cloneNode(true);
  const [from, to] = [svg, copy].map(top => [top, ...top.querySelectorAll('*')]);
  inLight(() => {
    from.forEach((original, k) => {
      const style = getComputedStyle(original);
      for (const name of ['fill', 'stroke']) {
        if (/var\(|currentColor/.test(original.getAttribute(name) ?? '')) to[k].setAttribute(name, style[name]);
      }
    });
    copy.setAttribute('font-family', 'system-ui, sans-serif');
  });
  const { width, height } = svg.viewBox.baseVal;
  copy.setAttribute('xmlns', 'http://www.w3.org/2000/svg');
  copy.setAttribute('width', width);
  copy.setAttribute('height', height);
  copy.removeAttribute('style');
  const paper = document.createElementNS('http://www.w3.org/2000/svg', 'rect');
  for (const [name, value] of Object.entries({ width, height, fill: '#ffffff' })) paper.setAttribute(name, value);
  copy.prepend(paper);
  return { text: new XMLSerializer().serializeToString(copy), width, height };
}

/** A drawing as a data URL with PNG. */
export async function asPng({ text, width, height }) {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
  await image.decode();
  const canvas = element('canvas', { width: 2 * width, height: 2 * height });
  canvas.getContext('2d').drawImage(image, 0, 0, 2 * width, 2 * height);
  return canvas.toDataURL('image/png');
}

/** Buttons for each figure that the server has drawn; `data-values` has its numbers as CSV, or `data-csv` says where they are. */
export function drawnFigures(within = document) {
  for (const svg of within.querySelectorAll('figure svg:not(.main-svg)')) {
    const figure = svg.closest('figure');
    if (figure.querySelector('.plot, .save')) continue;
    const name = figure.dataset.name ?? figure.querySelector('figcaption')?.textContent.slice(0, 60)
      ?? svg.getAttribute('aria-label') ?? 'figure';
    const { csv, values } = figure.dataset;
    figure.append(bar(name, {
      SVG: () => save(name, 'svg', resolved(svg).text),
      PNG: async () => save(name, 'png', await asPng(resolved(svg))),
      ...(values ? { CSV: () => save(name, 'csv', values) } : {}),
      ...(csv ? { CSV: () => { location.href = csv; } } : {}),
    }));
  }
}
