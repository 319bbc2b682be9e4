// Flights that come with Trimtab: to be fitted, to be checked on, and one that takes no part in any decision.
import { ask } from './service.js';

const FLIGHTS = [['elevator-backlash-fit', 'estimation'], ['elevator-backlash-check', 'validation'], ['elevator-backlash-final', 'final']];

/** Uploads them; the address of the page where they are made a job. `tell` is told how it goes. */
export async function uploadExamples(tell) {
  const uses = [];
  for (const [at, [name, role]] of FLIGHTS.entries()) {
    const title = `example flight ${at + 1}`;
    tell(`Uploading ${title} ...`);
    const csv = await fetch(`/assets/${name}.csv`);
    const stored = await ask(`/v1/maneuvers?name=${encodeURIComponent(title)}`, {
      method: 'POST', headers: { 'content-type': 'text/csv' }, body: await csv.text(),
    });
    uses.push(`${role}=${stored.id}`);
  }
  return `/new?model=short-period&kind=diagnose&name=${encodeURIComponent('My first job')}&${uses.join('&')}`;
}
