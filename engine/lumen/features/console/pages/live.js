// @ts-check
// What happens, as it happens: a stream of the console's events that all pages of this browser share.
// Entries come once, in order, by the journal's position; a page that was away goes on where it was.
/** @import { CommandSent, Entry, LiveEvent, Now, Robot, RobotSent, Role } from "./types" */
import { blocks, parsed } from "./blocks.js";
import { follow } from "./follow.js";
import { redraw } from "./ui.js";

const AGAIN = 500,
  ANSWER = 2500,
  QUESTION = 30000,
  MOST = 300; // [ms], [ms], [ms], entries
export const JOB = 250000; // [ms] longer than the console gives a process that computes something

export const live = {
  /** `connecting`, `live`, `away` or `asleep`. */
  state: "connecting",
  since: Date.now(),
  role: /** @type {Role | null} */ (null),
  fleet: false,
  robots: /** @type {Map<string, Robot>} */ (new Map()),
  entries: /** @type {Entry[]} */ ([]),
  told: /** @type {Entry[]} */ ([]),
  commands: /** @type {CommandSent[]} */ ([]),
  skew: 0,
  // The last entry of each alarm of each robot: busy ones don't push it out.
  alarms: /** @type {Map<string, Entry>} */ (new Map()),
};
/** Events of a robot's body that people have to see. */
export const ALARMS = ["fallen", "motors.hot", "battery.low"];
/** @type {Map<string, [position: number, at_time: string]>} */
const seen = new Map();
/** @type {Set<(...event: LiveEvent) => void>} */
const heard = new Set();
/** @type {AbortController | null} */
let stream = null,
  timer = 0;

/**
 * Have `handler(kind, data)` told of each `entry`, `now` and `command`; what it returns ends that.
 * @param {(...event: LiveEvent) => void} handler
 */
export function listen(handler) {
  heard.add(handler);
  return () => heard.delete(handler);
}

/** @param {Record<string, any>} values */
const params = (values) =>
  new URLSearchParams(Object.entries(values).filter(([, value]) => value != null && value !== "")).toString();

/**
 * JSON of one of the console's paths; the error has what it says.
 * @param {string} path
 * @param {Record<string, any>} [values]
 * @param {number} [limit]
 * @returns {Promise<any>}
 */
export async function get(path, values = {}, limit = QUESTION) {
  const query = params(values);
  const answer = await fetch(query ? `${path}?${query}` : path, {
    signal: AbortSignal.timeout(limit),
    cache: "no-store",
  });
  return dataOf(answer);
}

/**
 * Send JSON to one of the console's paths, and return the JSON of its answer; the error has what it says.
 * @param {string} path
 * @param {Record<string, any>} body
 * @param {number} [limit]
 * @returns {Promise<any>}
 */
export async function post(path, body, limit = JOB) {
  const answer = await fetch(path, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(body),
    signal: AbortSignal.timeout(limit),
  });
  return dataOf(answer);
}

/** @param {Response} answer */
async function dataOf(answer) {
  const data = await answer.json().catch(() => ({}));
  if (!answer.ok)
    throw Object.assign(new Error(data.reason ?? data.detail ?? `${answer.status}`), { status: answer.status });
  return data;
}

/**
 * What is known of a robot, with `skew`: how far the clock of its exhibition is ahead of this browser's [ms].
 * Its `now()` is the time of that clock [ms since 1970]; it stops while the robot does not answer.
 * @param {string} name
 */
export const robotOf = (name) => live.robots.get(name);

/**
 * Whether what the page shows of a robot is so now, and a command would reach it.
 * @param {RobotSent} robot
 */
export const isHere = (robot) => live.state === "live" && robot.connected !== false;

/** The time of the console's clock [ms since 1970]. */
export const consoleNow = () => Date.now() + live.skew;

/** @param {RobotSent} robot */
function took(robot) {
  const skew = live.skew + 1000 * (robot.ahead ?? 0);
  const last = () => {
    if (live.state !== "live") return live.since;
    return robot.connected === false && robot.heard ? Date.parse(robot.heard) - live.skew : Date.now();
  };
  live.robots.set(robot.robot, { ...robot, skew, now: () => last() + skew });
  for (const button of document.querySelectorAll("rest-button")) button.heed?.([...live.robots.values()]);
}

/** @param {string} state */
function become(state) {
  if (live.state !== state) Object.assign(live, { state, since: Date.now() });
  redraw();
}

/** Begin, or begin again: after signing in, when the page is seen again. */
export async function connect() {
  clearTimeout(timer);
  stream?.abort();
  const mine = (stream = new AbortController());
  try {
    /** @type {Now} */
    const now = await get("/api/now", {}, ANSWER);
    if (mine !== stream) return; // asked before a later `connect`, as another person perhaps
    live.role = now.role ?? "author";
    live.fleet = now.fleet ?? false;
    live.skew = Date.parse(now.time) - Date.now();
    live.robots.clear();
    now.robots.forEach(took);
    if (live.role === "nobody" && lumen.page !== "subtitles") {
      become("live");
      again(mine, 2000);
      return;
    }
    await read(mine);
  } catch (error) {
    const { status } = /** @type {{ status?: number }} */ (error);
    if (mine.signal.aborted) return;
    if (status === 401 || status === 403) {
      Object.assign(live, { role: "nobody" });
      become("live");
      again(mine, 2000);
      return;
    }
  }
  again(mine, AGAIN);
}

/**
 * @param {AbortController} mine
 * @param {number} pause
 */
function again(mine, pause) {
  if (mine !== stream) return;
  if (live.role !== "nobody") become("away");
  timer = setTimeout(connect, pause);
}

/** Where to continue: after what was seen last of each robot. Of other robots the console sends the latest entries. */
function after() {
  return [...seen]
    .filter(([robot]) => !lumen.robot || robot === lumen.robot)
    .map(([robot, [position]]) => `${robot}:${position}`)
    .join(",");
}

/**
 * Follow what happens until that is lost. What was before is asked for by itself; what comes meanwhile waits.
 * @param {AbortController} mine
 */
async function read(mine) {
  /** @type {string[] | null} */
  let waiting = [];
  let lose = () => {};
  const lost = new Promise((done) => {
    lose = () => done(null);
  });
  const leave = follow("/api/events", live.role, (block) => (waiting ? waiting.push(block) : take(block, mine)), lose);
  mine.signal.addEventListener("abort", lose);
  try {
    await blocks(
      `/api/events?${params({ robot: lumen.robot, after: after(), once: 1 })}`,
      (block) => take(block),
      mine.signal,
    );
    become("live");
    const came = waiting;
    waiting = null;
    for (const block of came) take(block, mine);
    await lost;
  } finally {
    leave();
  }
}

/**
 * @param {Entry[]} list
 * @param {Entry} entry
 */
const add = (list, entry) => {
  list.push(entry);
  if (list.length > MOST) list.shift();
};

/**
 * What a block says. Where entries are missing before one that comes `live` they are asked for, and it with them.
 * @param {string} block
 * @param {AbortController | null} [shared]
 */
function take(block, shared = null) {
  const event = /** @type {LiveEvent | null} */ (parsed(block));
  if (!event || shared?.signal.aborted) return;
  const [kind, body] = event;
  if (kind === "entry") {
    if (lumen.robot && body.robot !== lumen.robot) return;
    const [last, when] = seen.get(body.robot) ?? [-1, ""]; // a journal that begins anew counts anew, later
    if (body.position <= last && body.at_time <= when) return;
    if (shared && body.position > last + 1) {
      connect();
      return;
    }
    seen.set(body.robot, [body.position, body.at_time]);
    add(live.entries, body);
    if (body.heard && ALARMS.includes(body.heard)) live.alarms.set(`${body.robot} ${body.heard}`, body);
    if (body.text) add(live.told, body); // of those that people read as many are kept, however many faces come between
  } else if (kind === "now") took(body);
  else if (kind === "command") live.commands = [body, ...live.commands].slice(0, 20);
  for (const handler of heard) handler(...event);
  redraw();
}

// A page that nobody sees leaves its connection to those that are seen: a browser has six for one server.
document.addEventListener("visibilitychange", () => {
  if (document.hidden)
    timer = setTimeout(() => {
      if (document.hidden) {
        stream?.abort();
        stream = null;
        become("asleep");
      }
    }, 10000);
  else if (live.state !== "live") connect();
  else clearTimeout(timer);
});
addEventListener("online", connect);
addEventListener("pageshow", (event) => {
  if (event.persisted) connect();
});
