// A fit and a diagnosis in TypeScript, with types generated from openapi/trimtab.json: see tests/typescript/run.
import assert from 'node:assert';
import { readFile } from 'node:fs/promises';
import createClient from 'openapi-fetch';
import type { components, paths } from './api.js';

type Job = components['schemas']['Job'];
type Event = components['schemas']['Event'];

const data = process.env.TRIMTAB_DATA ?? 'data';
const client = createClient<paths>({ baseUrl: process.env.TRIMTAB_SERVER ?? 'http://127.0.0.1:8300' });

async function upload(file: string): Promise<string> {
  const bytes = await readFile(`${data}/${file}.csv`);
  const { data: maneuver, error } = await client.POST('/v1/maneuvers/files', {
    params: { query: { name: file } },
    headers: { 'content-type': 'application/octet-stream' },
    body: bytes as unknown as string,
    bodySerializer: (body) => body,
  });
  assert(maneuver, error?.detail);
  return maneuver.id;
}

async function run(spec: components['schemas']['JobSpec']): Promise<Job> {
  const { data: submitted, error } = await client.POST('/v1/jobs', { body: spec, headers: { prefer: 'wait=60' } });
  assert(submitted && 'id' in submitted, error?.detail);
  assert(submitted.finished, 'it takes no minute');
  return submitted;
}

async function events(id: string): Promise<Event[]> {
  const { data: page, error } = await client.GET('/v1/jobs/{id}/events', { params: { path: { id }, query: { limit: 1000 } } });
  assert(page && typeof page === 'object' && 'events' in page, error?.detail);
  return page.events;
}

const fit = await run({ model: 'short-period', maneuvers: [{ id: await upload('elevator') }] });
const table = await client.GET('/v1/jobs/{id}/parameters', { params: { path: { id: fit.id } } });
assert(table.data && typeof table.data === 'object');
const ma = table.data.parameters.find((row) => row.name === 'Ma');
// data/elevator.toml says what was flown
assert(ma?.standard_error && Math.abs(ma.estimate + 3.4) < 4 * ma.standard_error);
for (const event of await events(fit.id)) {
  // the compiler knows by `type` what an event has
  if (event.type === 'iteration') console.log(event.number, event.cost);
  if (event.type === 'succeeded') console.log(event.outcome);
}

const found = await run({
  kind: 'diagnose',
  model: 'short-period',
  maneuvers: [
    { id: await upload('effects/elevator-backlash-fit') },
    { id: await upload('effects/elevator-backlash-check'), role: 'validation' },
  ],
});
const diagnosis = await client.GET('/v1/jobs/{id}/diagnosis', { params: { path: { id: found.id } } });
assert(diagnosis.data);
assert.equal(diagnosis.data.effects[0].kind, 'backlash');
console.log(diagnosis.data.sentence);
