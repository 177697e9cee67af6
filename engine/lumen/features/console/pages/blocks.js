// @ts-check
// Reads server-sent events by fetch, so that a silent cut is noticed too.
const SILENCE = 3000; // [ms]: the console says something each second

/**
 * Tell `take` of each block of a stream until it ends, also if it is silent; the error has the `status` of a refusal.
 * @param {string} path
 * @param {(block: string) => void} take
 * @param {AbortSignal} signal
 */
export async function blocks(path, take, signal) {
  const mine = new AbortController(),
    end = () => mine.abort();
  let silent = 0;
  const alive = () => {
    clearTimeout(silent);
    silent = setTimeout(end, SILENCE);
  };
  signal.addEventListener("abort", end);
  if (signal.aborted) end();
  alive();
  try {
    const answer = await fetch(path, {
      signal: mine.signal,
      cache: "no-store",
      headers: { Accept: "text/event-stream" },
    });
    if (!answer.ok || !answer.body) throw Object.assign(new Error(`${answer.status}`), { status: answer.status });
    const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
    let text = "";
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return;
      alive();
      text += value.replaceAll("\r\n", "\n");
      let at;
      while ((at = text.indexOf("\n\n")) >= 0) {
        take(text.slice(0, at));
        text = text.slice(at + 2);
      }
    }
  } finally {
    clearTimeout(silent);
    signal.removeEventListener("abort", end);
  }
}

/**
 * The kind and the data of a block; null for a comment.
 * @param {string} block
 * @returns {[kind: string, data: any] | null}
 */
export function parsed(block) {
  let kind = "message",
    data = "";
  for (const line of block.split("\n")) {
    if (line.startsWith("event:")) kind = line.slice(6).trim();
    else if (line.startsWith("data:")) data += line.slice(5);
  }
  return data ? [kind, JSON.parse(data)] : null;
}
