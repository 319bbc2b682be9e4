// Talking to the service: answers as JSON, and what went wrong in words.

/** What a problem (RFC 9457) says, every fault with its place. */
export function inWords(problem) {
  const faults = (problem.errors ?? []).map(fault => `${fault.pointer} ${fault.message}`.trim());
  return [problem.detail ?? problem.title, ...faults].filter(Boolean).join('\n');
}

/** Asks the API; throws what went wrong, in words, with the whole answer as `problem`. */
export async function ask(address, options = {}) {
  let response;
  try {
    response = await fetch(address, options);
  } catch {
    throw new Error('the service does not answer; is it running?');
  }
  const text = await response.text();
  let body;
  try {
    body = text === '' ? {} : JSON.parse(text);
  } catch {
    body = { detail: text };
  }
  if (!response.ok) throw Object.assign(new Error(inWords(body)), { problem: body, status: response.status });
  return body;
}

/** Posts JSON. */
export const post = (address, body) => ask(address, {
  method: 'POST',
  headers: { 'content-type': 'application/json' },
  body: JSON.stringify(body ?? {}),
});

/** An element with attributes and content. */
export function element(name, attributes = {}, ...content) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value !== false && value !== undefined) made.setAttribute(key, value);
  }
  made.append(...content.filter(part => part !== undefined));
  return made;
}

/** Moments in the reader's own time. */
export function localTimes(within = document) {
  for (const time of within.querySelectorAll('time[datetime]')) {
    const moment = new Date(time.dateTime);
    if (!Number.isNaN(moment.valueOf())) {
      time.title = time.dateTime;
      time.textContent = moment.toLocaleString();
    }
  }
}
