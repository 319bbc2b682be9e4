// The page of a job: followed while it runs, with plots of what it found when it is over.
import { axis, colour, line, plot, scaled, shown, timePlot } from './plot.js';
import { ask, element, localTimes, post } from './service.js';

const page = document.getElementById('job');
const { job } = page.dataset;
const base = `/v1/jobs/${job}`;
const byId = id => document.getElementById(id);

/** Cost, and parameters as shares of their largest change, by iteration. */
function drawCourse(iterations, names) {
  const number = iterations.map(iteration => iteration.number);
  const costs = iterations.map(iteration => iteration.cost);
  plot(byId('cost'), () => ({
    traces: [{ x: number, y: costs, mode: 'lines+markers', line: { color: colour('measured') }, hovertemplate: 'iteration %{x}: %{y:.6g}<extra></extra>' }],
    layout: { height: 260, xaxis: axis('iteration', { dtick: number.length > 12 ? undefined : 1 }), yaxis: axis('') },
  }));
  const changes = (iterations[0]?.parameters ?? []).map((start, k) => iterations.map(iteration => iteration.parameters[k] - start));
  plot(byId('course'), () => ({
    traces: changes.map((values, k) => {
      const largest = Math.max(...values.map(Math.abs)) || 1;
      return {
        x: number, y: values.map(value => value / largest), mode: 'lines', name: names[k] ?? `${k + 1}`, line: line(k),
        customdata: iterations.map(iteration => iteration.parameters[k]), hovertemplate: '%{customdata:.5g}',
      };
    }),
    layout: { height: 260, xaxis: axis('iteration', { dtick: number.length > 12 ? undefined : 1 }), yaxis: axis(''), legend: { orientation: 'v' } },
  }));
}

/** Follows the log; what was seen is not asked for again, whether the connection or the service went away. */
function follow() {
  const iterations = [];
  let names = [];
  let last = 0;
  let timer;
  const say = text => { byId('state').textContent = text; };
  const badge = document.querySelector('.state');
  const status = name => {
    badge.className = `state ${name}`;
    badge.textContent = name;
  };
  const connection = text => { byId('connection').textContent = text; };
  const drawSoon = () => { timer ??= setTimeout(() => { timer = undefined; drawCourse(iterations, names); }, 200); };
  const step = text => {
    byId('steps').hidden = false;
    byId('steps').append(element('li', {}, text));
  };
  const told = {
    queued: () => say('waits for a worker'),
    claimed: event => {
      status('running');
      say(event.attempt > 1 ? `taken over, attempt ${event.attempt}` : 'a worker has it');
    },
    released: event => {
      status('queued');
      say(event.reason);
    },
    prepared: event => { names = event.parameters; say(`${event.samples} samples, ${names.length} free parameters`); },
    start: event => say(event.text),
    iteration: event => {
      iterations.push(event);
      say(`iteration ${event.number}, -ln L ${event.cost.toPrecision(7)}`);
      drawSoon();
    },
    finding: event => step(event.finding),
    diagnosis: event => {
      const text = {
        fitted: () => `round ${event.round}: fitted in ${event.iterations} iterations, -ln L ${event.cost.toPrecision(7)}`,
        screened: () => `round ${event.round}: ${event.candidates} candidates screened, ${event.visible} visible in these data`,
        tried: () => `tried ${event.name}: likelihood ratio ${event.likelihood_ratio.toFixed(1)}`,
        refused: () => `refused ${event.name}: ${event.sentence}`,
        accepted: () => `accepted ${event.name}: ${event.sentence}`,
      }[event.step];
      if (text) step(text());
    },
    cancel_requested: () => {
      status('cancelling');
      say('asked to stop');
    },
  };
  const open = () => {
    const log = new EventSource(`${base}/events?after=${last}`);
    log.onopen = () => connection('');
    log.onerror = () => {
      connection('The connection is lost; what happens meanwhile is shown when it is back.');
      // the browser tries again by itself, unless it was refused
      if (log.readyState === EventSource.CLOSED) setTimeout(open, 2000);
    };
    const take = handle => message => {
      const event = JSON.parse(message.data);
      if (event.seq <= last) return;
      last = event.seq;
      handle(event);
    };
    for (const [name, handle] of Object.entries(told)) log.addEventListener(name, take(handle));
    for (const end of ['succeeded', 'failed', 'cancelled']) {
      log.addEventListener(end, () => { log.close(); location.reload(); });
    }
  };
  open();
}

const POINTS = 3000;

/** All segments, outputs above inputs, residuals by themselves. */
async function drawHistories() {
  const place = byId('histories-plots');
  const address = (from, to) => {
    const stretch = from === undefined ? '' : `&from=${from}&to=${to}`;
    return `${base}/time-histories?max_points=${POINTS}${stretch}`;
  };
  const rowsOf = segment => {
    const of = (quantity, series) => {
      const { scale, unit } = shown(quantity.unit);
      return { title: `${quantity.name}, ${unit}`, series: series(scale) };
    };
    const lines = (name, values, tint, width = 2) => ({
      name, values, style: () => ({ mode: 'lines', line: { color: colour(tint), width } }),
    });
    const outputs = segment.outputs.map(({ declared = [], ...output }) => of(output, scale => [
      { name: 'measured', values: scaled(output.measured, scale), style: () => ({ mode: 'markers', marker: { color: colour('measured'), size: 3 } }) },
      ...(declared.length > 0 ? [lines('declared model', scaled(declared, scale), 'declared')] : []),
      lines(declared.length > 0 ? 'model with the effects' : 'model', scaled(output.model, scale), 'model'),
    ]));
    const inputs = segment.inputs.map(input => of(input, scale => [lines('input', scaled(input.values, scale), 'ink', 1)]));
    return [...outputs, ...inputs];
  };
  const { segments } = await ask(address());
  place.replaceChildren();
  for (const first of segments) {
    const aside = first.role === 'estimation' ? '' : ' (took no part in the fit)';
    const plotted = element('div', { class: 'plot', role: 'img', 'aria-label': `${first.segment} over time, measured and by the model` });
    place.append(element('figure', {}, element('figcaption', {}, first.segment + aside), plotted));
    const load = async (from, to) => {
      const segment = from === undefined
        ? first
        : (await ask(address(from, to))).segments.find(other => other.segment === first.segment);
      return { time: segment.time, rows: rowsOf(segment), isThinned: first.time.length < first.samples };
    };
    await timePlot(plotted, load);
  }
  delete place.dataset.loading;
}

/** Autocorrelation with its band, and spectrum, of each output. */
/** A probability as tables have it: what is too small to matter is only said to be small. */
const pValue = p => (p < 1e-4 ? 'p < 0.0001' : `p = ${p.toFixed(p < 0.01 ? 4 : 2)}`);

async function drawResiduals() {
  const place = byId('residuals');
  const { outputs } = await ask(`${base}/residual-analysis`);
  place.replaceChildren();
  for (const output of outputs) {
    const { scale, unit } = shown(output.unit);
    const plots = ['autocorrelation', 'spectrum'].map(name =>
      element('div', { class: 'plot', role: 'img', 'aria-label': `${name} of the residual of ${output.output}` }));
    const whiteness = output.portmanteau.probability < 0.01
      ? 'not white: noise alone would hardly be like this'
      : 'as white noise would be';
    place.append(
      element('h3', {}, output.output),
      element('p', { class: 'soft' }, `rms ${(output.rms * scale).toPrecision(4)} ${unit}; ${whiteness} (Ljung and Box, ${pValue(output.portmanteau.probability)})`),
      element('div', { class: 'columns' }, ...plots));
    const lags = output.autocorrelation.map((_, lag) => lag);
    await plot(plots[0], () => ({
      traces: [{ x: lags, y: output.autocorrelation, type: 'bar', marker: { color: colour('measured') }, hovertemplate: 'lag %{x}: %{y:.3f}<extra></extra>' }],
      layout: {
        height: 220, xaxis: axis('lag, samples'), yaxis: axis('autocorrelation'),
        shapes: [{ type: 'rect', xref: 'paper', x0: 0, x1: 1, y0: -output.band, y1: output.band, fillcolor: colour('soft'), opacity: 0.18, line: { width: 0 } }],
      },
    }));
    await plot(plots[1], () => ({
      traces: [{
        x: output.spectrum.map(point => point.frequency),
        y: output.spectrum.map(point => point.density * scale * scale),
        mode: 'lines', line: { color: colour('measured'), width: 1.5 }, hovertemplate: '%{x:.3g} Hz: %{y:.3g}<extra></extra>',
      }],
      layout: { height: 220, xaxis: axis('frequency, Hz'), yaxis: axis(`density, (${unit})\u00b2/Hz`, { type: 'log' }) },
    }));
  }
  delete place.dataset.loading;
}

/** Names of the free parameters, as the log has them. */
async function drawIterations() {
  const [{ iterations }, log] = await Promise.all([
    ask(`${base}/iterations`), ask(`${base}/events?format=json&limit=20`),
  ]);
  const prepared = log.events.findLast(event => event.type === 'prepared');
  drawCourse(iterations, prepared?.parameters ?? []);
}

const ACTS = {
  cancel: async () => { await post(`${base}/cancel`); return 'asked to stop'; },
  rerun: async () => { location.href = `/jobs/${(await post(`${base}/rerun`)).id}`; return ''; },
  diagnose: async () => {
    const spec = await ask(`${base}/spec`);
    const made = await post('/v1/jobs', { ...spec, kind: 'diagnose', name: `${spec.name || spec.model.name || spec.model}: what is missing` });
    location.href = `/jobs/${made.id}`;
    return '';
  },
};

for (const button of document.querySelectorAll('button[data-act]')) {
  button.addEventListener('click', async () => {
    button.disabled = true;
    try {
      byId('acted').textContent = await ACTS[button.dataset.act]();
    } catch (error) {
      byId('acted').textContent = error.message;
      button.disabled = false;
    }
  });
}

localTimes();
if (page.dataset.over === 'false') {
  follow();
} else if (page.dataset.result === 'true') {
  const failed = place => error => { place.textContent = error.message; };
  drawHistories().catch(failed(byId('histories-plots')))
    .then(drawResiduals).catch(failed(byId('residuals')))
    .then(() => byId('cost') && drawIterations()).catch(failed(byId('cost')));
}
