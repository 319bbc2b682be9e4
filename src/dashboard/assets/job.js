// The page of a job: followed while it runs, with plots of what it found when it is over.
import { drawnFigures } from './export.js';
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

/** A step of so many standard errors counts as the beginning of the way. */
const LONGEST_STEP = 100;

/** Seconds as people say them. */
const lasting = seconds => {
  const whole = Math.max(0, Math.floor(seconds));
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60];
  if (whole < 60) return `${whole} s`;
  return hours > 0 ? `${hours} h ${minutes} min` : `${minutes} min ${whole % 60} s`;
};

/** Says how long the job runs, or how many are before it, by the service's clock. */
function clock() {
  const { now, started } = page.dataset;
  const ahead = Date.parse(now) - Date.now();
  let since = started ? Date.parse(started) : undefined;
  let waits = false;
  const say = text => { byId('elapsed').textContent = text; };
  const tick = setInterval(() => {
    if (!waits && since !== undefined) say(`running for ${lasting((Date.now() + ahead - since) / 1000)}`);
  }, 1000);
  const place = async () => {
    if (!waits) return;
    try {
      const told = await ask(base);
      if (waits && told.ahead !== undefined) say(told.ahead === 0 ? 'next in the queue' : `${told.ahead} ${told.ahead === 1 ? 'job is' : 'jobs are'} before it in the queue`);
    } catch {
      // what follows the log says that the connection is lost
    }
    setTimeout(place, 3000);
  };
  return {
    begin: () => {
      waits = false;
      since ??= Date.now() + ahead;
      say('');
    },
    queued: () => {
      if (waits) return;
      waits = true;
      place();
    },
    finish: () => clearInterval(tick),
  };
}

/** Follows the log; what was seen is not asked for again, whether the connection or the service went away. */
function follow() {
  const iterations = [];
  let furthest = 0;
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
  // the newest first
  const step = text => {
    byId('steps').hidden = false;
    byId('steps').prepend(element('li', {}, text));
  };
  const way = (share, text) => {
    const [bar, said] = byId('way').children;
    byId('way').hidden = false;
    bar.value = Math.min(1, Math.max(0, share));
    said.textContent = text;
  };
  const { begin, queued, finish } = clock();
  const search = { tried: 0, promising: 0, rounds: 0, round: 0 };
  const searched = () => {
    const { tried, promising, rounds, round } = search;
    const of = promising > 0 ? `${tried} of about ${Math.max(promising, tried)} candidates fitted, ` : '';
    way(promising > 0 ? tried / Math.max(promising, tried) : 0, `${of}round ${round}${rounds > 0 ? ` of at most ${rounds}` : ''}`);
  };
  const told = {
    queued: () => {
      say('waits for a worker');
      queued();
    },
    claimed: event => {
      status('running');
      begin();
      say(event.attempt > 1 ? `taken over, attempt ${event.attempt}` : 'a worker has it');
    },
    released: event => {
      status('queued');
      say(event.reason);
      queued();
    },
    prepared: event => { names = event.parameters; say(`${event.samples} samples, ${names.length} free parameters`); },
    start: event => say(event.text),
    iteration: event => {
      iterations.push(event);
      say(`iteration ${event.number}, -ln L ${event.cost.toPrecision(7)}`);
      if (event.step > 0) {
        const tolerance = Number(page.dataset.tolerance);
        const share = Math.log(LONGEST_STEP / event.step) / Math.log(LONGEST_STEP / tolerance);
        furthest = Math.max(furthest, share);
        way(furthest, `step ${event.step.toPrecision(2)} standard errors, ends at ${tolerance.toPrecision(1)}`);
      }
      drawSoon();
    },
    finding: event => step(event.finding),
    diagnosis: event => {
      const text = {
        fitted: () => `declared model fitted in ${event.iterations} iterations`,
        screened: () => `${event.candidates} candidates screened, ${event.visible} visible in these data`,
        refused: () => `refused ${event.name}: ${event.sentence}`,
        accepted: () => `accepted: ${event.sentence}`,
      }[event.step];
      if (event.step === 'screened') Object.assign(search, { tried: 0, promising: event.promising, rounds: event.rounds, round: event.round });
      if (event.step === 'tried') {
        search.tried += 1;
        say(`tried ${event.name}: likelihood ratio ${event.likelihood_ratio.toFixed(1)}`);
      }
      if (search.round > 0) searched();
      if (text) step(event.round > 0 ? `Round ${event.round}: ${text()}` : text());
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
      log.addEventListener(end, () => { log.close(); finish(); location.reload(); });
    }
  };
  open();
}

const POINTS = 3000;

/** What the effects of a diagnosis explain: residuals before and after, in a flight that took no part where there is one. */
async function drawExplained(segments, rowsOf) {
  const place = byId('explained');
  if (!place) return;
  const withDeclared = segments.filter(segment => segment.outputs.some(output => output.declared?.length > 0));
  const of = role => withDeclared.find(segment => segment.role === role);
  const shownOne = of('final') ?? of('validation') ?? of('estimation');
  if (shownOne) {
    const rows = rowsOf(shownOne).filter(row => row.series.some(series => series.name === 'residual'));
    const plotted = element('div', { class: 'plot', role: 'img', 'aria-label': `residuals of ${shownOne.segment} before and after` });
    const words = { final: 'final test', validation: 'validation', estimation: 'estimation' }[shownOne.role];
    place.append(element('figure', {}, element('figcaption', {}, `Residuals of ${shownOne.segment} (${words}), with the declared model and with the effects`), plotted));
    await timePlot(plotted, async () => ({ time: shownOne.time, rows: rows.map(row => ({ ...row, share: 1.1, label: undefined })), isThinned: false }));
  }
  delete place.dataset.loading;
}

/** All segments, outputs above inputs, residuals by themselves. */
async function drawHistories() {
  const place = byId('histories-plots');
  const address = (from, to, all) => {
    const query = new URLSearchParams(all ? {} : { max_points: POINTS });
    if (from !== undefined) {
      query.set('from', from);
      query.set('to', to);
    }
    return `${base}/time-histories?${query}`;
  };
  const rowsOf = segment => {
    const of = (quantity, series, what = '') => {
      const { scale, unit } = shown(quantity.unit);
      return { title: `${quantity.name}${what}, ${unit}`, series: series(scale) };
    };
    const lines = (name, values, tint, width = 2, rank = 3) => ({
      name, values, rank, style: () => ({ mode: 'lines', line: { color: colour(tint), width } }),
    });
    const rest = (measured, model) => measured.map((value, k) => (value === null || model[k] === null ? null : value - model[k]));
    const outputs = segment.outputs.flatMap(({ declared = [], ...output }) => [
      of(output, scale => [
        ...(declared.length > 0 ? [lines('declared model', scaled(declared, scale), 'declared', 2, 2)] : []),
        lines(declared.length > 0 ? 'model with the effects' : 'model', scaled(output.model, scale), 'model'),
        { name: 'measured', rank: 1, values: scaled(output.measured, scale), style: () => ({ mode: 'markers', marker: { color: colour('measured'), size: 3, opacity: 0.6 } }) },
      ]),
      {
        ...of(output, scale => [
          ...(declared.length > 0 ? [lines('residual of the declared model', scaled(rest(output.measured, declared), scale), 'declared', 1, 5)] : []),
          lines('residual', scaled(output.residual, scale), 'measured', 1, 4),
        ], ' residual'),
        share: 0.6, label: `residual, ${shown(output.unit).unit}`,
      },
    ]);
    const inputs = segment.inputs.map(input => ({ ...of(input, scale => [lines('input', scaled(input.values, scale), 'input', 1.5, 6)]), share: 0.8 }));
    return [...outputs, ...inputs];
  };
  const { segments } = await ask(address());
  await drawExplained(segments, rowsOf);
  place.replaceChildren();
  for (const first of segments) {
    const aside = { estimation: '', validation: ' (validation)', final: ' (final test)' }[first.role];
    const plotted = element('div', { class: 'plot', role: 'img', 'aria-label': `${first.segment} over time, measured and by the model` });
    place.append(element('figure', {}, element('figcaption', {}, first.segment + aside), plotted));
    const load = async (from, to, all) => {
      const segment = from === undefined
        ? first
        : (await ask(address(from, to, all))).segments.find(other => other.segment === first.segment);
      return { time: segment.time, rows: rowsOf(segment), isThinned: first.time.length < first.samples };
    };
    await timePlot(plotted, load);
  }
  delete place.dataset.loading;
}

/** A probability as tables have it: what is too small to matter is only said to be small. */
const pValue = p => (p < 1e-4 ? 'p < 0.0001' : `p = ${p.toFixed(p < 0.01 ? 4 : 2)}`);

/** Autocorrelation with its band, and spectrum, of each output. */
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
      element('div', { class: 'columns' }, ...plots.map(plotted => element('div', {}, plotted))));
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
drawnFigures();
if (page.dataset.over === 'false') {
  follow();
} else if (page.dataset.result === 'true') {
  const failed = place => error => { place.textContent = error.message; };
  drawHistories().catch(failed(byId('histories-plots')))
    .then(drawResiduals).catch(failed(byId('residuals')))
    .then(() => byId('cost') && drawIterations()).catch(failed(byId('cost')));
}
