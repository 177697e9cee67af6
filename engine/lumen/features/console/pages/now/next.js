// @ts-check
// What can happen next, as sentences: what a visitor or the operator can cause now, and what comes of it.
/** @import { Button, Robot } from "../types" */
import { inLanguage, t } from "../ui.js";

/** Events of visitors and operators that have a sentence of their own. */
const CAUSES = new Set(["face", "touched", "released", "recognised", "gender", "visitor.left", "stop", "resume"]);
const ROW = /^hears (?:(not|asked) )?(.+)$/;

/**
 * What the visitor says, from the row of `hears`: `hears not dance|sing`.
 * @param {string} event
 */
function said(event) {
  if (event === "hears else") return t("next.hears.else");
  const [, way, names] = ROW.exec(event) ?? [];
  if (!names) return null;
  const words = names
    .split("|")
    .map((one) => `“${one.replaceAll("_", " ")}”`)
    .join(t("next.or"));
  return t(way ? `next.hears.${way}` : "next.hears", { words });
}

/**
 * Who causes an event, in words; null if neither a visitor nor the operator does.
 * @param {string} event
 * @param {Button[]} buttons
 */
function cause(event, buttons) {
  const button = buttons.find((one) => one.event === event && one.enabled !== false);
  if (button) return t("next.press", { label: inLanguage(button.label) });
  if (event === "heard") return t("next.heard");
  return CAUSES.has(event) ? t(`next.${event}`) : said(event);
}

/**
 * The sentences about a robot, each once, in the order of its ways: `[cause, what comes of it]`.
 * @param {Robot} robot
 * @returns {[cause: string, then: string][]}
 */
export function next(robot) {
  /** @type {Map<string, Set<string>>} */
  const found = new Map();
  for (const way of robot.ways ?? []) {
    const who = way.open ? cause(way.event, robot.buttons ?? []) : null;
    if (who === null) continue;
    const then = way.targets?.length
      ? t("next.goes", { states: way.targets.map((one) => `“${one}”`).join(", ") })
      : t("next.stays");
    found.set(who, (found.get(who) ?? new Set()).add(then));
  }
  return [...found].map(([who, then]) => [who, [...then].join(t("next.or"))]);
}
