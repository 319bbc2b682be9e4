// The page of all jobs: kept up to date, and a first job to try.
import { localTimes } from './service.js';
import { uploadExamples } from './examples.js';

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
      const focused = list.contains(document.activeElement) ? document.activeElement.getAttribute('href') : null;
      list.replaceChildren(...fresh.childNodes);
      localTimes(list);
      if (focused) list.querySelector(`a[href="${CSS.escape(focused)}"]`)?.focus();
    }
    if (live.textContent === LOST) live.textContent = '';
  } catch {
    live.textContent = LOST;
  }
}

localTimes();
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
