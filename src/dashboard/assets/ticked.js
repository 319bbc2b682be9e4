// Jobs that are ticked for a comparison: kept while one searches, and in lists that are made anew.

const KEY = 'trimtab.ticked';
const MOST = 50;

const bar = document.getElementById('ticked');
const read = () => {
  try {
    return JSON.parse(sessionStorage.getItem(KEY)) ?? [];
  } catch {
    return [];
  }
};
let ids = read();

/** Ticks what is ticked, and says how many are. */
export function show() {
  const boxes = [...document.querySelectorAll('[data-tick]')];
  for (const box of boxes) box.checked = ids.includes(box.dataset.tick);
  const all = document.getElementById('tick-all');
  if (all) {
    all.checked = boxes.length > 0 && boxes.every(box => box.checked);
    all.disabled = boxes.length === 0;
  }
  if (!bar) return;
  bar.hidden = ids.length === 0;
  const [said, link] = bar.children;
  const many = ids.length > MOST;
  said.textContent = ids.length === 1
    ? '1 job is ticked; tick another to compare'
    : `${ids.length} jobs are ticked${many ? `; at most ${MOST} are compared` : ''}`;
  link.hidden = ids.length < 2 || many;
  link.href = `/compare?jobs=${ids.join(',')}`;
}

function keep(ticked) {
  ids = ticked;
  try {
    sessionStorage.setItem(KEY, JSON.stringify(ids));
  } catch {
    // where nothing may be kept it holds for this page
  }
  show();
}

document.getElementById('jobs')?.addEventListener('change', event => {
  const box = event.target;
  const meant = box.id === 'tick-all'
    ? [...document.querySelectorAll('[data-tick]')].map(one => one.dataset.tick)
    : [box.dataset.tick].filter(Boolean);
  if (meant.length === 0) return;
  const others = ids.filter(id => !meant.includes(id));
  keep(box.checked ? [...others, ...meant] : others);
});
bar?.querySelector('button').addEventListener('click', () => keep([]));
