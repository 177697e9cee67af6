// @ts-check
// Follows a stream of server-sent events, over one connection for all pages of this browser where it can share.
import { blocks } from "./blocks.js";

const SILENCE = 4000,
  HERE = 5000; // [ms] without a word from what is shared; between two words of ours
/** @type {Map<string, { lost: () => void, take: (block: string) => void }>} */
const followed = new Map();
/** @type {SharedWorker | null} */
let worker = null,
  shares = typeof SharedWorker !== "undefined";

/**
 * Tell `take` of each block; `lost` is called once it has ended. Those with the same `who` share. What is returned
 * leaves it.
 * @param {string} path
 * @param {string | null} who
 * @param {(block: string) => void} take
 * @param {() => void} lost
 */
export function follow(path, who, take, lost) {
  const id = `${who} ${path}`,
    ending = new AbortController();
  let silent = 0;
  const end = () => {
    clearTimeout(silent);
    ending.abort();
    if (followed.get(id) === mine) followed.delete(id);
  };
  const over = () => {
    if (!ending.signal.aborted) {
      end();
      lost();
    }
  };
  const alive = () => {
    clearTimeout(silent);
    silent = setTimeout(() => {
      unshare();
      over();
    }, SILENCE);
  };
  const mine = {
    lost: over,
    take: (/** @type {string} */ block) => {
      alive();
      take(block);
    },
  };
  const port = shared();
  if (!port) {
    blocks(path, take, ending.signal)
      .catch(() => {})
      .finally(over);
    return end;
  }
  followed.set(id, mine);
  alive();
  port.postMessage({ follow: path, id });
  return () => {
    port.postMessage({ leave: true, id });
    end();
  };
}

/**
 * The way to what is shared; null where this browser has no such thing.
 * @returns {MessagePort | null}
 */
function shared() {
  if (worker || !shares) return worker?.port ?? null;
  try {
    worker = new SharedWorker("/pages/shared.js", { type: "module", name: "lumen" });
  } catch {
    shares = false;
    return null;
  }
  worker.onerror = () => {
    shares = false;
    unshare();
  };
  worker.port.onmessage = ({ data: { id, block, lost } }) =>
    lost ? followed.get(id)?.lost() : followed.get(id)?.take(block);
  return worker.port;
}

/** What is shared says nothing any more: whoever follows begins anew. */
function unshare() {
  worker?.port.close();
  worker = null;
  for (const one of [...followed.values()]) one.lost();
}

setInterval(() => worker?.port.postMessage({}), HERE);
addEventListener("pagehide", () => {
  for (const id of followed.keys()) worker?.port.postMessage({ leave: true, id });
});
