// @ts-check
// What is asked of a robot, and what became of it: told at the page's foot until it is read.
/** @import { Answer } from "./types" */
import { Quote } from "./quoted.js";
import { fixed, html, redraw, t, useRedraw } from "./ui.js";

const LASTS = 5000; // [ms] that good news stays
/** @type {Told[]} */
const told = [];

/**
 * A command of this page, and how it stands.
 * @typedef {{ label: string, state: string, answer: Answer, key: number }} Told
 */

/**
 * Send a command; `label` is what people call it, `tell(state)` hears how it stands. Returns when it is over.
 * @param {string} robot
 * @param {string} name
 * @param {Record<string, any>} [fields]
 * @param {string} [label]
 * @param {(state: string) => void} [tell]
 */
export async function command(robot, name, fields = {}, label = t(`command.${name}`), tell = () => {}) {
  /** @type {Told} */
  const mine = { label, state: "sending", answer: {}, key: Math.random() };
  told.push(mine);
  if (told.length > 4) told.shift();
  await lumen.post({ robot, command: name, ...fields }, (state, answer) => {
    Object.assign(mine, { state, answer });
    tell(state);
    if (state === "finished") setTimeout(() => dismiss(mine), LASTS);
    redraw();
  });
  return mine;
}

/** @param {Told} mine */
function dismiss(mine) {
  if (told.includes(mine)) told.splice(told.indexOf(mine), 1);
  redraw();
}

/** @type {Record<string, string>} */
const SIGNS = { sending: "…", sent: "→", finished: "✓", failed: "✕", unsent: "✕", unknown: "?" };

/** @param {Told} one */
function sentence({ label, state, answer }) {
  const waits = state === "finished" && answer.answer?.waiting;
  const text = `${label}: ${t(waits ? "told.waits" : `told.${state}`, { seconds: fixed(answer.seconds ?? 0, 1) })}`;
  return answer.reason && state !== "finished" ? html`${text}: <${Quote} text=${answer.reason} />` : text;
}

export function Told() {
  useRedraw();
  return html`<div class="told" role="status">${told.map(
    (one) => html`<p key=${one.key} data-state=${one.state}>
    <span class="sign" aria-hidden="true">${SIGNS[one.state] ?? "?"}</span><span>${sentence(one)}</span>
    <button type="button" class="plain" onClick=${() => dismiss(one)}>${t("close")}</button></p>`,
  )}</div>`;
}
