// Sending a file, with its progress.
import { inWords } from './service.js';

/** Sends a file; `onShare` is told which share of it is on its way. The answer as JSON; throws what went wrong, as `ask` does. */
export function upload(address, type, file, onShare) {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open('POST', address);
    request.setRequestHeader('content-type', type);
    request.upload.addEventListener('progress', event => onShare(event.loaded / event.total));
    request.addEventListener('error', () => reject(new Error('The connection broke off; is the service running? Nothing is lost here, send it again.')));
    request.addEventListener('load', () => {
      let body;
      try {
        body = JSON.parse(request.responseText);
      } catch {
        body = { detail: request.responseText };
      }
      if (request.status < 300) resolve({ maneuver: body, isNew: request.status === 201 });
      else reject(Object.assign(new Error(inWords(body)), { problem: body, status: request.status }));
    });
    request.send(file);
  });
}
