// @ts-check
// Transitions that wait for a person's GO, with the time after which they go or don't; and how far the robot goes
// alone.
/** @import { Approval, Deed, Robot } from "../types" */
import { command } from "../commands.js";
import { Place, Values } from "../places.js";
import { inPageLanguage } from "../quoted.js";
import { may } from "../session.js";
import { Choice, Part, Until, Usable, html, t } from "../ui.js";
import { isHere } from "../live.js";

/**
 * What a command of a robot is called: its verb, and the first text that says which.
 * @param {Deed} deed
 */
function named({ verb, ...fields }) {
  const which = Object.values(fields).find((one) => typeof one === "string");
  return [inPageLanguage(verb), which].join(" ");
}

/**
 * What a person decides on: the visitor's words or other data, what the robot will do, and what happens by itself.
 * @param {{ robot: Robot, one: Approval }} props
 */
function Matter({ robot, one }) {
  const { result, ...data } = one.data ?? {},
    would = one.would ?? [];
  return html`${
    typeof result === "string" &&
    html`<p class="bubble visitor-said">
      <span class="speaker">${t("visitor.said")}</span> <span>“${result}”</span></p>`
  }
    <${Values} values=${data} />
    <p>${t(would.length ? "approve.would" : "approve.would.nothing")}</p>
    ${
      would.length > 0 &&
      html`<ul class="would">${would.map(
        (deed) => html`<li>
      ${
        deed.verb === "say" ? html`${t("approve.says")} <b lang=${deed.language}>“${deed.text}”</b>` : named(deed)
      }</li>`,
      )}</ul>`
    }
    <p class="countdown">${
      one.until
        ? html`${t(one.else === "go" ? "approve.goes" : "approve.stays")}
      <strong><${Until} at=${one.until} now=${robot.now} /></strong>`
        : t("approve.waits")
    }</p>`;
}

/** @param {{ robot: Robot, one: Approval }} props */
function Waiting({ robot, one }) {
  const answer = (/** @type {boolean} */ go) =>
    command(
      robot.robot,
      "approve",
      { approval: one.id, go },
      `${inPageLanguage(one.event)} → ${one.targets.join(", ")}: ${t(go ? "approve.go" : "approve.stay")}`,
    );
  return html`<li class="approval"><p>
    <b>${inPageLanguage(one.event)}</b>: ${one.source} → ${one.targets.join(", ")} <${Place} file=${one.file}
    line=${one.line} /></p>
    <${Matter} robot=${robot} one=${one} />
    <${Usable} when=${isHere(robot)}><div class="actions">
      <button type="button" class="go" onClick=${() => answer(true)}>${t("approve.go")}</button>
      <button type="button" onClick=${() => answer(false)}>${t("approve.stay")}</button></div></${Usable}></li>`;
}

/** @param {{ robot: Robot }} props */
export function Approvals({ robot }) {
  const waiting = robot.waiting ?? [];
  return html`<div role="status"
    class="hidden">${waiting.length > 0 && t("approvals.count", { count: waiting.length })}</div>
    ${
      waiting.length > 0 &&
      html`<${Part} title=${t("approvals")} kind="approvals">
      <ul class="plain-list">${waiting.map((one) => html`<${Waiting} key=${one.id} robot=${robot} one=${one} />`)}</ul>
        </${Part}>`
    }`;
}

/**
 * Whether transitions that are marked wait for a person.
 * @param {{ robot: Robot }} props
 */
export function Autonomy({ robot }) {
  if (!robot.autonomy || !may("operator")) return null;
  const set = (/** @type {string} */ level) =>
    level !== robot.autonomy && command(robot.robot, "autonomy", { level }, t(`autonomy.${level}`));
  return html`<${Choice} legend=${t("autonomy")} name="autonomy-${robot.robot}" value=${robot.autonomy} choose=${set}
    options=${["ask", "alone"].map((level) => [level, t(`autonomy.${level}`)])} />`;
}

/**
 * Whether a language model may answer visitors.
 * @param {{ robot: Robot }} props
 */
export function Model({ robot }) {
  if (!robot.model || !may("operator")) return null;
  const told = (/** @type {boolean} */ on) => t(on ? "model.on" : "model.off"),
    now = robot.model === "on";
  const set = (/** @type {string} */ value) => {
    const on = value === "true";
    if (on !== now) command(robot.robot, "model", { on }, `${t("model")} ${told(on)}`);
  };
  return html`<${Choice} legend=${t("model")} name="model-${robot.robot}" value=${`${now}`} choose=${set}
    options=${[true, false].map((on) => [`${on}`, told(on)])} />`;
}
