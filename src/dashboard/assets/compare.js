// The page of some jobs side by side: their time histories and residuals over each other.
import { drawnFigures } from './export.js';
import { colour, line, scaled, shown, timePlot } from './plot.js';
import { ask, element } from './service.js';

const place = document.getElementById('compared');
const jobs = place.dataset.jobs.split(',');

/** Of more jobs than these the plots show no line any more. */
const MOST_JOBS = 8;
const POINTS = 1500;

const histories = async (job, from, to, all) => {
  const query = new URLSearchParams(all ? {} : { max_points: POINTS });
  if (from !== undefined) {
    query.set('from', from);
    query.set('to', to);
  }
  return (await ask(`/v1/jobs/${job}/time-histories?${query}`)).segments;
};

/** The same for segments of the same samples, whatever they are called: length, ends and first measured values. */
const keyOf = segment => JSON.stringify([
  segment.samples, segment.time[0], segment.time.at(-1), segment.outputs.map(output => [output.name, output.measured[0]]),
]);

/** Segments that are shown in one plot: those of the same samples, and of the others the first of each job, the second, and so on. */
function together(all) {
  const same = new Map();
  for (const one of all) same.set(keyOf(one.segment), [...(same.get(keyOf(one.segment)) ?? []), one]);
  const groups = [...same.values()];
  const shared = groups.filter(group => group.length > 1).map(parts => ({ parts, isShared: true }));
  const apart = new Map();
  const seen = new Map();
  for (const [one] of groups.filter(group => group.length === 1)) {
    const rank = seen.get(one.at) ?? 0;
    seen.set(one.at, rank + 1);
    apart.set(rank, [...(apart.get(rank) ?? []), one]);
  }
  return [...shared, ...[...apart.values()].map(parts => ({ parts, isShared: false }))];
}

/** Rows of a plot: each output above its residual, then the inputs. */
function rowsOf({ parts, isShared }) {
  const names = kind => [...new Set(parts.flatMap(({ segment }) => segment[kind].map(series => `${series.name}\n${series.unit}`)))];
  const of = (kind, key, make) => parts.flatMap((part, nth) => {
    const found = part.segment[kind].find(series => `${series.name}\n${series.unit}` === key);
    const time = isShared ? part.segment.time : part.segment.time.map(t => t - part.begin);
    return found ? make(found, part, nth).map(series => ({ ...series, time })) : [];
  });
  const title = (key, more = '') => {
    const [name, unit] = key.split('\n');
    return { ...shown(unit), title: `${name}${more}, ${shown(unit).unit}` };
  };
  const lines = (name, values, at, width) => ({ name, values, style: () => ({ mode: 'lines', line: { ...line(at), width } }) });
  const dots = (name, values, at) => ({
    name, values, style: () => ({ mode: 'markers', marker: { color: at === undefined ? colour('ink') : line(at).color, size: 3, opacity: 0.6 } }),
  });
  const outputs = names('outputs').flatMap(key => {
    const { scale, title: above } = title(key);
    return [
      {
        title: above,
        series: [
          ...of('outputs', key, (output, { at }) => [lines(`model ${at + 1}`, scaled(output.model, scale), at, 2)]),
          ...of('outputs', key, (output, { at }, nth) => (isShared && nth > 0
            ? []
            : [dots(isShared ? 'measured' : `measured ${at + 1}`, scaled(output.measured, scale), isShared ? undefined : at)])),
        ],
      },
      {
        title: title(key, ' residual').title,
        share: 0.6,
        label: `residual, ${title(key).unit}`,
        series: of('outputs', key, (output, { at }) => [lines(`residual ${at + 1}`, scaled(output.residual, scale), at, 1)]),
      },
    ];
  });
  const inputs = names('inputs').map(key => ({
    title: title(key).title,
    share: 0.8,
    series: of('inputs', key, (input, { at }, nth) => (isShared && nth > 0
      ? []
      : [lines(isShared ? 'input' : `input ${at + 1}`, scaled(input.values, title(key).scale), isShared ? 6 : at, 1)])),
  }));
  return [...outputs, ...inputs];
}

async function draw() {
  const loaded = await Promise.all(jobs.slice(0, MOST_JOBS).map(job => histories(job)));
  const all = loaded.flatMap((segments, at) => segments.map(segment => ({ at, segment, begin: segment.time[0] })));
  place.replaceChildren();
  if (jobs.length > MOST_JOBS) place.append(element('p', { class: 'soft' }, `The first ${MOST_JOBS} jobs are drawn.`));
  for (const group of together(all)) {
    const called = group.parts.map(({ at, segment }) => `job ${at + 1}: ${segment.segment}`).join(', ');
    const plotted = element('div', { class: 'plot', role: 'img', 'aria-label': `measured and models over time of ${called}` });
    place.append(element('figure', {}, element('figcaption', {}, called), plotted));
    const end = Math.max(...group.parts.map(({ segment, begin }) => segment.time.at(-1) - (group.isShared ? 0 : begin)));
    const range = [group.isShared ? group.parts[0].begin : 0, end];
    const load = async (from, to, all) => {
      const parts = from === undefined ? group.parts : await Promise.all(group.parts.map(async part => {
        const shift = group.isShared ? 0 : part.begin;
        const segments = await histories(jobs[part.at], from + shift, to + shift, all);
        return { ...part, segment: segments.find(other => other.segment === part.segment.segment) };
      }));
      const { segment } = parts[0];
      const isThinned = group.parts.some(part => part.segment.time.length < part.segment.samples);
      return { time: segment.time, rows: rowsOf({ ...group, parts }), isThinned, range };
    };
    await timePlot(plotted, load);
  }
  delete place.dataset.loading;
}

drawnFigures();
draw().catch(error => { place.textContent = error.message; });
