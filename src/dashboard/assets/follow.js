// Follows a job while it runs: the state in words, and the page anew when the job is over.
const state = document.getElementById('state');
const log = new EventSource(`/v1/jobs/${state.dataset.job}/events`);
const on = (name, text) =>
  log.addEventListener(name, event => { state.textContent = text(JSON.parse(event.data)); });
on('start', event => event.text);
on('iteration', event => `iteration ${event.number}, -ln L ${event.cost}`);
on('finding', event => event.finding);
for (const end of ['succeeded', 'failed', 'cancelled']) {
  log.addEventListener(end, () => { log.close(); location.reload(); });
}
