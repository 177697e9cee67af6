// @ts-check
// The situation in one sentence: what the robot does, for whom, since when, and how long it still takes.
/** @import { Motion, Robot, State } from "../types" */
import { isHere } from "../live.js";
import { inPageLanguage } from "../quoted.js";
import { html, span, t, useSeconds } from "../ui.js";
import { innermost } from "./states.js";

/** @param {string} text */
const first = (text) => text.charAt(0).toLocaleUpperCase() + text.slice(1);

/**
 * When an active state was entered last.
 * @param {State[]} states
 */
const changed = (states) =>
  innermost(states)
    .map((one) => one.since)
    .sort()
    .at(-1) ?? null;

/**
 * Of a motion that says how far it is: how long it still takes [s], null if nobody knows.
 * @param {Motion} motion
 * @param {Robot} robot
 */
function left({ since, progress }, robot) {
  const begun = Date.parse(since),
    told = Date.parse(robot.time ?? "");
  return progress ? Math.max(0, (begun + (told - begun) / progress - robot.now()) / 1000) : null;
}

/**
 * A motion in words; of a verb that a feature adds, the verb itself.
 * @param {Motion} motion
 */
function moving({ verb, name }) {
  const known = `now.${verb}`,
    text = t(known, { name });
  return text === known ? `${inPageLanguage(verb)} ${name}`.trim() : text;
}

/**
 * What the robot does now, and since when.
 * @param {Robot} robot
 * @returns {[deed: string, since: string | null]}
 */
function deed(robot) {
  const { motion, saying } = robot;
  if (robot.stopped) return [t("now.rests"), null];
  if (motion) return [moving(motion), motion.since];
  if (saying) return [t("now.speaks"), saying.since];
  return [t("now.waits"), changed(robot.states ?? [])];
}

/** @param {{ robot: Robot }} props */
export function Situation({ robot }) {
  useSeconds();
  const [what, since] = deed(robot),
    rest = robot.motion && !robot.stopped ? left(robot.motion, robot) : null;
  const parts = [
    first(what) + (robot.visitor ? ` ${t("now.for", { name: robot.visitor })}` : ""),
    since && span((robot.now() - Date.parse(since)) / 1000),
    rest !== null && t("now.left", { seconds: Math.round(rest) }),
  ];
  const known = isHere(robot) ? "" : `${t("last.known")}: `;
  return html`<p class="situation">${known}${parts.filter(Boolean).join(", ")}</p>`;
}
