// Runs once for all pages of a browser, which has six connections for one server: each stream is read here, once.
import { blocks } from "./blocks.js";

const GONE = 60000; // [ms] after which a page that says nothing any more was closed without a word
const streams = new Map(),
  heard = new Map(); // who follows, by the stream's id; when a page was heard last

function join(page, id, path) {
  let one = streams.get(id);
  if (!one) {
    const made = (one = { pages: new Set(), ending: new AbortController() });
    const tell = (what) => {
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

function leave(page, id) {
  const one = streams.get(id);
  if (!one?.pages.delete(page) || one.pages.size) return;
  streams.delete(id);
  one.ending.abort();
}

onconnect = ({ ports: [page] }) => {
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
