// Plots in the look of the pages: the chart library, loaded when it is first needed, and what all plots share.
import { asPng, bar, csvOf, inLight, save } from './export.js';

let library;

/** The chart library, once it is there. */
function loaded() {
  library ??= new Promise((resolve, reject) => {
    const script = document.createElement('script');
    script.src = '/assets/plotly.js';
    script.onload = () => resolve(window.Plotly);
    script.onerror = () => reject(new Error('the chart library did not load; load the page anew'));
    document.head.append(script);
  });
  return library;
}

/** A colour of the style sheet, as it is in the light or dark now. */
export function colour(name) {
  const probe = document.createElement('span');
  probe.style.color = `var(--${name})`;
  document.body.append(probe);
  const value = getComputedStyle(probe).color;
  probe.remove();
  return value;
}

/** What is told apart by colour must be so for everybody (Okabe and Ito), and by dash beyond seven. */
const PALETTE = ['#0072b2', '#e69f00', '#009e73', '#cc79a7', '#56b4e9', '#d55e00', '#8a8f94'];
const DASHES = ['solid', 'dash', 'dot', 'dashdot'];
export const line = k => ({
  color: PALETTE[k % PALETTE.length],
  dash: DASHES[Math.floor(k / PALETTE.length) % DASHES.length],
  width: 2,
});

/** How a quantity is shown: degrees for radians. */
export const shown = unit =>
  unit === 'rad' || unit.startsWith('rad/')
    ? { scale: 180 / Math.PI, unit: unit.replace('rad', 'deg') }
    : { scale: 1, unit };

export const scaled = (values, scale) => values.map(value => (value === null ? null : value * scale));

/** An axis with the title, grid and digits of all plots. */
export function axis(title, more = {}) {
  return {
    title: { text: title, standoff: 6 }, automargin: true, gridcolor: colour('line'), zeroline: false,
    linecolor: colour('soft'), exponentformat: 'power', ...more,
  };
}

/** What every plot has, in the colours of the moment. */
const look = () => ({
  paper_bgcolor: 'rgba(0,0,0,0)', plot_bgcolor: 'rgba(0,0,0,0)',
  font: { family: 'system-ui, sans-serif', size: 12, color: colour('ink') },
  margin: { l: 60, r: 15, t: 10, b: 40 }, legend: { orientation: 'h', y: 1.02, yanchor: 'bottom', traceorder: 'normal' },
  hoverlabel: { bgcolor: colour('raised'), bordercolor: colour('line'), font: { color: colour('ink') } },
  dragmode: 'zoom',
});

const drawn = new Map();

/** Width of a picture that is saved, in pixels; PNG has twice as many. */
const SAVED_WIDTH = 1000;

/**
 * The buttons below a plot: it as SVG, as PNG and as CSV. Pictures are for paper: light, with what is zoomed to. `table` gives the
 * traces of the CSV, where the plot has not all samples.
 */
function addExports(element, table) {
  if (element.parentElement.querySelector(':scope > .save')) return;
  const name = element.getAttribute('aria-label');
  const picture = async () => {
    const plotly = await loaded();
    const { traces, layout } = inLight(() => {
      const made = drawn.get(element)();
      return { ...made, layout: { ...look(), ...made.layout } };
    });
    for (const [key, axis] of Object.entries(element.layout)) {
      if (/^[xy]axis/.test(key) && axis.range) layout[key] = { ...layout[key], range: [...axis.range], autorange: false };
    }
    layout.paper_bgcolor = '#ffffff';
    const size = { width: SAVED_WIDTH, height: layout.height };
    const address = await plotly.toImage({ data: traces, layout }, { format: 'svg', ...size });
    return { text: decodeURIComponent(address.replace(/^[^,]*,/, '')), ...size };
  };
  element.after(bar(name, {
    SVG: async () => save(name, 'svg', (await picture()).text),
    PNG: async () => save(name, 'png', await asPng(await picture())),
    CSV: async () => save(name, 'csv', csvOf(await (table ? table() : drawn.get(element)()))),
  }));
}

/**
 * Draws, or draws anew what has changed. `make` gives traces and layout, in the colours of the moment: it is asked again when
 * light turns to dark. `table` is as in `addExports`.
 */
export async function plot(element, make, table) {
  const plotly = await loaded();
  drawn.set(element, make);
  const { traces, layout } = make();
  // the library fills what is there, and leaves no room of itself
  element.style.height = `${layout.height + 2}px`;
  await plotly.react(element, traces, { ...look(), ...layout }, {
    responsive: true, displayModeBar: false, doubleClick: 'reset', scrollZoom: false,
  });
  addExports(element, table);
  return plotly;
}

matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  for (const [element, make] of drawn) if (element.isConnected) plot(element, make);
});

/**
 * Rows of plots over one time, that are zoomed together; `load(from, to)` brings the rows of a stretch of time, each with
 * `title` and `series` (`name`, `values`, `style`, and `time` where it has one of its own), so that what is zoomed into has all its
 * samples.
 */
export async function timePlot(element, load) {
  let data = await load();
  const make = () => drawnOver(data);
  // a table has all samples of what is shown
  const table = async () => {
    const [from, to] = element.layout.xaxis.range;
    return drawnOver(data.isThinned ? { ...data, ...(await load(from, to, true)) } : data, [from, to]);
  };
  await plot(element, make, table);
  if (!data.isThinned) return;
  const whole = data;
  let asked = 0;
  element.on('plotly_relayout', async change => {
    const from = change['xaxis.range[0]'];
    const isWhole = change['xaxis.autorange'] || change['xaxis.range'] === undefined && from === undefined;
    if (isWhole && !change['xaxis.autorange']) return;
    const mine = ++asked;
    const part = isWhole ? whole : { ...(await load(from, change['xaxis.range[1]'])), range: [from, change['xaxis.range[1]']] };
    if (mine === asked) {
      data = part;
      plot(element, make, table);
    }
  });
}

/** Height of a row whose share is 1, in pixels. */
const ROW = 150;

/** Traces and layout of rows over one time. A row has a `share` of the height of others; measured dots lie above lines. */
function drawnOver({ time, rows, range }) {
  const traces = [];
  const shares = rows.map(row => row.share ?? 1);
  const all = shares.reduce((sum, share) => sum + share, 0);
  const whole = range ?? [time[0], time.at(-1)];
  const layout = {
    height: 60 + ROW * all, hovermode: 'x unified', hoversubplots: 'axis', showlegend: true,
    xaxis: axis('time, s', { anchor: `y${rows.length === 1 ? '' : rows.length}`, showspikes: true, spikemode: 'across', spikethickness: 1, spikedash: 'solid', spikecolor: colour('soft'), range: whole }),
    uirevision: 'kept',
  };
  let top = 1;
  rows.forEach((row, at) => {
    const number = at === 0 ? '' : at + 1;
    const part = shares[at] / all;
    layout[`yaxis${number}`] = axis(row.label ?? row.title, { domain: [Math.max(0, top - part + 0.12 / all), top], nticks: shares[at] < 1 ? 4 : undefined });
    top -= part;
    for (const series of row.series) {
      traces.push({
        x: series.time ?? time, y: series.values, name: series.name, yaxis: `y${number}`, xaxis: 'x', legendgroup: series.name,
        legendrank: series.rank ?? 1000, title: row.title, connectgaps: false,
        showlegend: !traces.some(trace => trace.legendgroup === series.name),
        hovertemplate: `${row.title}: %{y:.5g}${row.series.length > 1 ? ` (${series.name})` : ''}<extra></extra>`, ...series.style(),
      });
    }
  });
  return { traces, layout };
}
