// The page of all jobs: kept up to date, and a first job to try.
import { localTimes } from './service.js';
import { uploadExamples } from './examples.js';
import { show as showTicked } from './ticked.js';

const EVERY_MS = 2000;
const LOST = 'The service does not answer; trying again.';
const list = document.getElementById('jobs');
const live = document.getElementById('live');

async function refresh() {
  if (document.hidden) return;
  try {
    const answer = await fetch(location.href);
    if (!answer.ok) throw new Error();
    const page = new DOMParser().parseFromString(await answer.text(), 'text/html');
    const fresh = page.getElementById('jobs');
    // the first job of all came by the API
    if (fresh && !list) location.reload();
    else if (fresh && fresh.innerHTML !== refresh.last) {
      refresh.last = fresh.innerHTML;
      // who is at a link by keyboard stays there
      const focused = list.contains(document.activeElement) ? document.activeElement : null;
      const { href, tick } = { href: focused?.getAttribute('href'), tick: focused?.dataset.tick };
      list.replaceChildren(...fresh.childNodes);
      localTimes(list);
      showTicked();
      if (href) list.querySelector(`a[href="${CSS.escape(href)}"]`)?.focus();
      if (tick) list.querySelector(`[data-tick="${CSS.escape(tick)}"]`)?.focus();
    }
    if (live.textContent === LOST) live.textContent = '';
  } catch {
    live.textContent = LOST;
  }
}

localTimes();
showTicked();
if (!list || list.dataset.live === 'true') setInterval(refresh, EVERY_MS);

const examples = document.getElementById('examples');
examples?.addEventListener('click', async () => {
  examples.disabled = true;
  try {
    location.href = await uploadExamples(text => { live.textContent = text; });
  } catch (error) {
    live.textContent = error.message;
    examples.disabled = false;
  }
});
