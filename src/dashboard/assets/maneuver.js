// The page of a maneuver: its channels over time, and its end.
import { line, scaled, shown, timePlot } from './plot.js';
import { ask, element, localTimes } from './service.js';

const POINTS = 6000;

const page = document.getElementById('maneuver');
const base = `/v1/maneuvers/${page.dataset.maneuver}`;
const samples = Number(page.dataset.samples);
const step = Number(page.dataset.step);
const byId = id => document.getElementById(id);

/** A time between samples that is so many steps is a gap; of fewer samples than there are it also exceeds what is left out. */
const GAP = 5;

/** The places behind which a recording stopped and started again. */
function gaps(time) {
  const steps = time.slice(1).map((t, k) => t - time[k]);
  const usual = [...steps].sort((a, b) => a - b)[Math.floor(0.95 * steps.length)] ?? step;
  const isGap = taken => taken > GAP * step && (time.length === samples || taken > 2.5 * usual);
  return steps.flatMap((taken, k) => (isGap(taken) ? [k] : []));
}

/** With nothing in each gap, so that no line crosses it. */
const broken = (values, at) => values.flatMap((value, k) => (at.has(k) ? [value, null] : [value]));

/** Channels by name over a stretch of time, as the plots have them. */
async function load(names, from, to, all) {
  const query = new URLSearchParams({ channels: names.join(','), ...(all ? {} : { max_points: POINTS }) });
  if (from !== undefined) {
    // a sample beyond each end: lines reach the edges
    query.set('from', from - 2 * step);
    query.set('to', to + 2 * step);
  }
  const { time, channels } = await ask(`${base}/data?${query}`);
  const stopped = new Set(gaps(time.values));
  const rows = names.map((name, k) => {
    const { scale, unit } = shown(channels[name].unit);
    const style = () => ({ mode: 'lines', line: { ...line(k), dash: 'solid', width: 1.5 }, showlegend: false });
    return { title: unit === '-' ? name : `${name}, ${unit}`, series: [{ name, values: broken(scaled(channels[name].values, scale), stopped), style }] };
  });
  return { time: broken(time.values, stopped), rows, isThinned: time.values.length < samples };
}

let drawing = 0;

async function draw() {
  const mine = ++drawing;
  const names = [...byId('choice').querySelectorAll('input:checked')].map(box => box.value);
  const plotted = element('div', { class: 'plot', role: 'img', 'aria-label': `${names.join(', ')} over time` });
  try {
    const data = names.length > 0 ? await load(names) : undefined;
    // what was chosen meanwhile is drawn instead
    if (mine !== drawing) return;
    const before = byId('plot').querySelector('.plot');
    const stretch = before?.layout && before.layout.xaxis.autorange !== true ? before.layout.xaxis.range : undefined;
    before?.remove();
    byId('plotted').textContent = data ? extent(data) : 'No channel is chosen.';
    if (!data) return;
    byId('plot').append(plotted);
    await timePlot(plotted, async (from, to, all) => (from === undefined ? data : load(names, from, to, all)));
    if (stretch) zoom(...stretch);
  } catch (error) {
    byId('plotted').textContent = error.message;
  }
}

/** Shows a stretch of time; without an end, all. */
function zoom(from, to) {
  const plotted = byId('plot').querySelector('.plot');
  if (!plotted?.layout) return;
  window.Plotly.relayout(plotted, from === undefined ? { 'xaxis.autorange': true } : { 'xaxis.range[0]': from, 'xaxis.range[1]': to });
}

const extent = ({ isThinned }) =>
  isThinned ? `The extremes of ${samples} samples; zoom in to see each of them.` : '';

byId('choice').addEventListener('change', draw);
byId('stretch').addEventListener('submit', event => {
  event.preventDefault();
  const [from, to] = ['from', 'to'].map(name => event.target.elements[name].valueAsNumber);
  const isOne = to - from >= step;
  byId('stretch-told').textContent = isOne ? '' : `From must be at least one sample (${step} s) before to.`;
  if (isOne) zoom(from, to);
});
byId('stretch').addEventListener('reset', () => {
  byId('stretch-told').textContent = '';
  zoom();
});

byId('delete').addEventListener('click', () => {
  // Escape leaves the answer as it was
  byId('sure').returnValue = '';
  byId('sure').showModal();
});
byId('sure').addEventListener('close', async () => {
  if (byId('sure').returnValue !== 'delete') return;
  try {
    await ask(base, { method: 'DELETE' });
    location.href = '/maneuvers';
  } catch (error) {
    byId('acted').textContent = error.message;
  }
});

// the chart library is on its way while the service reads the samples
document.head.append(element('link', { rel: 'preload', as: 'script', href: '/assets/plotly.js' }));
localTimes();
draw();
