// @ts-check
// What is wrong with a robot and what helps, above all else on its page: until it is over, or somebody has read it.
/** @import { Data, Entry, Reading, Robot } from "../types" */
import { ALARMS, consoleNow, get, live } from "../live.js";
import { Quote } from "../quoted.js";
import { Since, clock, fixed, html, keep, kept, redraw, t, useEffect, useState } from "../ui.js";

const PART = "robot"; // that moves it, as `lumen run --only robot` says
/** @type {Record<string, string>} */
const BODY = { fallen: "trouble.fallen", "battery.low": "trouble.battery", "motors.hot": "trouble.hot" };
export const LOW = 20,
  HOT = 75; // [%], [°C]
const TROUBLES = /^(fallen|battery\.low|motors\.hot|[a-z]+\.lost|error\..*)$/;
const RECENT = 600000,
  AGAIN = 3000; // [ms] for how long a fall is new; how often it is asked why nobody answers
const READ = "lumen.read",
  MANY = 50; // what somebody has read stays read on the next page: so many
/** @type {Set<string>} */
const read = new Set();

/** @param {Entry} entry */
const named = (entry) => `${entry.robot} ${entry.at_time}`;
/** @param {Entry} entry */
const isRead = (entry) => read.has(named(entry)) || (kept(READ) ?? "").split("\n").includes(named(entry));

/** @param {Entry} entry */
function haveRead(entry) {
  read.add(named(entry)); // a private window keeps nothing
  keep(READ, [...(kept(READ) ?? "").split("\n"), named(entry)].slice(-MANY).join("\n"));
  redraw();
}

/**
 * Whether an entry is about something that went wrong.
 * @param {Entry} entry
 */
export const isTrouble = (entry) => TROUBLES.test(entry.heard ?? "");

/**
 * The processes that count: one that has gone counts for nothing once another one does what it did.
 * @param {Robot} robot
 */
export function processesOf(robot) {
  const all = robot.processes ?? [],
    here = new Set(all.filter((one) => one.state === "here").flatMap((one) => one.parts));
  const last = new Map(all.map((one) => [one.parts.join(), one]));
  return all.filter(
    (one) => one.state === "here" || (last.get(one.parts.join()) === one && one.parts.some((part) => !here.has(part))),
  );
}

/**
 * The process that moved the robot, where that has gone; else null.
 * @param {Robot} robot
 */
export const lostBody = (robot) =>
  processesOf(robot).find((one) => one.state !== "here" && one.parts.includes(PART)) ?? null;

/**
 * Whether the behaviour waits until a person lets it go on, though nobody stopped the robot itself.
 * @param {Robot} robot
 */
export const waitsForResume = (robot) =>
  !robot.stopped && (robot.ways ?? []).some((way) => way.event === "resume" && way.open && way.targets.length > 0);

/**
 * The name of the text about an alarm.
 * @param {Entry} entry
 */
const textOf = ({ heard = "" }) => BODY[heard] ?? heard;

/**
 * The numbers of an event as people of the page's language write them.
 * @param {Data | null | undefined} data
 */
const shown = (data) =>
  Object.fromEntries(
    Object.entries(data ?? {}).map(([key, value]) => [key, typeof value === "number" ? fixed(value) : value]),
  );

/**
 * The last time that the robot felt each of what is wrong with it, as far as nobody has read that.
 * @param {Robot} robot
 */
const felt = (robot) =>
  ALARMS.flatMap((kind) => live.alarms.get(`${robot.robot} ${kind}`) ?? []).filter(
    (one) => !isRead(one) && Date.now() + robot.skew - Date.parse(one.at_time) < RECENT,
  );

/**
 * The greatest number in a reading, however its joints or sides are called: the number, or its name and the number.
 * @param {Reading | null | undefined} reading
 * @returns {number | [name: string, value: number] | null}
 */
export function greatest(reading) {
  if (typeof reading === "number") return reading;
  const numbers = Object.entries(reading ?? {}).flatMap(([name, value]) =>
    typeof value === "number" ? [/** @type {[string, number]} */ ([name, value])] : [],
  );
  return numbers.sort((a, b) => b[1] - a[1])[0] ?? null;
}
/**
 * The temperature of the hottest motor [°C]; null if none is known.
 * @param {Robot} robot
 */
export function hottest(robot) {
  const found = greatest(robot.senses?.temperatures);
  return Array.isArray(found) ? found[1] : found;
}
/**
 * How full the battery is [%]; null if that is not known.
 * @param {Robot} robot
 */
export const batteryOf = (robot) => robot.battery ?? robot.senses?.battery?.percentage ?? null;

/**
 * The alarms of a robot, the worst first, each a text `alarm.…`; `MILD` ones wait for a person and are no fault.
 * @param {Robot} robot
 * @returns {string[]}
 */
export function alarmsOf(robot) {
  if (robot.connected === false) return ["away"];
  const battery = batteryOf(robot),
    known = new Set(felt(robot).map((one) => one.heard));
  /** @type {Record<string, unknown>} */
  const found = {
    lost: lostBody(robot),
    fallen: known.has("fallen"),
    hot: known.has("motors.hot") || (hottest(robot) ?? 0) > HOT,
    battery: known.has("battery.low") || (battery !== null && battery < LOW),
    asks: robot.waiting?.length,
    waits: waitsForResume(robot),
  };
  return Object.keys(found).filter((kind) => found[kind]);
}
export const MILD = ["asks", "waits"];

/** @param {{ robot: Robot }} props */
function Away({ robot }) {
  const [why, set] = useState("");
  useEffect(() => {
    const ask = () =>
      get("/api/now").then(
        (now) => set(now.bus ?? ""),
        () => {},
      );
    const timer = setInterval(ask, AGAIN);
    ask();
    return () => clearInterval(timer);
  }, []);
  return html`<p class="notice bad" role="alert"><b>${t("robot.away", { name: robot.robot })}</b> ${
    why
      ? html`<${Quote}
    text=${why} />`
      : t("robot.away.why")
  }</p>`;
}

/** @param {{ robot: Robot }} props */
export function Troubles({ robot }) {
  const lost = robot.connected === false ? null : lostBody(robot),
    name = robot.robot;
  return html`${robot.connected === false && html`<${Away} robot=${robot} />`}
    ${
      lost &&
      html`<div class="notice bad"><p role="alert">
      <b>${t("trouble.lost", { name })}</b> ${t("trouble.lost.do")}</p>
      <p>${t("heard.ago")} <${Since} at=${lost.heard} now=${consoleNow} /></p></div>`
    }
    ${felt(robot).map(
      (one) => html`<div class="notice bad" key=${one.position}><p role="alert">
        <b>${clock(one.at_time)} ${t(textOf(one), shown(one.data))}</b> ${t(`${textOf(one)}.do`)}</p>
      <button type="button" onClick=${() => haveRead(one)}>${t("trouble.read")}</button></div>`,
    )}`;
}
