// @ts-check
// Runs once for all pages of a browser, which has six connections for one server: each stream is read here, once.
/** @import { SharedWorkerScope } from "./types" */
import { blocks } from "./blocks.js";

const GONE = 60000; // [ms] after which a page that says nothing any more was closed without a word
/** @type {Map<string, { pages: Set<MessagePort>, ending: AbortController }>} */
const streams = new Map(); // which pages follow, by the stream's id
/** @type {Map<MessagePort, number>} */
const heard = new Map(); // when a page was heard last

/**
 * @param {MessagePort} page
 * @param {string} id
 * @param {string} path
 */
function join(page, id, path) {
  let one = streams.get(id);
  if (!one) {
    const made = (one = { pages: new Set(), ending: new AbortController() });
    const tell = (/** @type {{ block: string } | { lost: true }} */ what) => {
      for (const each of made.pages) each.postMessage({ id, ...what });
    };
    streams.set(id, made);
    blocks(path, (block) => tell({ block }), made.ending.signal)
      .catch(() => {})
      .finally(() => {
        if (streams.get(id) === made) streams.delete(id);
        tell({ lost: true });
      });
  }
  one.pages.add(page);
}

/**
 * @param {MessagePort} page
 * @param {string} id
 */
function leave(page, id) {
  const one = streams.get(id);
  if (!one?.pages.delete(page) || one.pages.size) return;
  streams.delete(id);
  one.ending.abort();
}

const scope = /** @type {SharedWorkerScope} */ (/** @type {unknown} */ (globalThis));
scope.onconnect = (/** @type {MessageEvent} */ { ports: [page] }) => {
  page.onmessage = ({ data: { follow, leave: left, id } }) => {
    heard.set(page, Date.now());
    if (follow) join(page, id, follow);
    if (left) leave(page, id);
  };
};

setInterval(() => {
  for (const [page, at] of heard) {
    if (Date.now() - at < GONE) continue;
    for (const id of [...streams.keys()]) leave(page, id);
    heard.delete(page);
  }
}, GONE / 4);
