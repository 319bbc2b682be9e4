// Plots in the look of the pages: the chart library, loaded when it is first needed, and what all plots share.

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

const drawn = new Map();

/**
 * Draws, or draws anew what has changed. `make` gives traces and layout, in the colours of the moment: it is asked again when
 * light turns to dark.
 */
export async function plot(element, make) {
  const plotly = await loaded();
  drawn.set(element, make);
  const { traces, layout } = make();
  // the library fills what is there, and leaves no room of itself
  element.style.height = `${layout.height + 2}px`;
  await plotly.react(element, traces, {
    paper_bgcolor: 'rgba(0,0,0,0)', plot_bgcolor: 'rgba(0,0,0,0)',
    font: { family: 'system-ui, sans-serif', size: 12, color: colour('ink') },
    margin: { l: 60, r: 15, t: 10, b: 40 }, legend: { orientation: 'h', y: 1.02, yanchor: 'bottom' },
    hoverlabel: { bgcolor: colour('raised'), bordercolor: colour('line'), font: { color: colour('ink') } },
    dragmode: 'zoom', ...layout,
  }, {
    responsive: true, displayModeBar: false, doubleClick: 'reset',
  });
  return plotly;
}

matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  for (const [element, make] of drawn) plot(element, make);
});

/**
 * Rows of plots over one time, that are zoomed together; `load(from, to)` brings the rows of a stretch of time, each with
 * `title` and `series` (`name`, `values`, `style`), so that what is zoomed into has all its samples.
 */
export async function timePlot(element, load) {
  let data = await load();
  const height = 150;
  const make = () => {
    const { time, rows } = data;
    const traces = [];
    const layout = {
      height: 60 + height * rows.length, hovermode: 'x unified', hoversubplots: 'axis', showlegend: true,
      xaxis: axis('time, s', { anchor: `y${rows.length}`, showspikes: true, spikemode: 'across', spikethickness: 1, spikedash: 'solid', spikecolor: colour('soft'), range: data.range ?? [time[0], time.at(-1)] }),
      uirevision: 'kept',
    };
    rows.forEach((row, at) => {
      const number = at === 0 ? '' : at + 1;
      const top = 1 - at / rows.length;
      layout[`yaxis${number}`] = axis(row.title, { domain: [top - 0.88 / rows.length, top] });
      for (const series of row.series) {
        traces.push({
          x: time, y: series.values, name: series.name, yaxis: `y${number}`, xaxis: 'x', legendgroup: series.name,
          showlegend: !traces.some(trace => trace.legendgroup === series.name),
          hovertemplate: `${row.title}: %{y:.5g}${row.series.length > 1 ? ` (${series.name})` : ''}<extra></extra>`, ...series.style(),
        });
      }
    });
    return { traces, layout };
  };
  await plot(element, make);
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
      plot(element, make);
    }
  });
}
