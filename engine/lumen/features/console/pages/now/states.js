// @ts-check
// The active states as boxes in boxes, each with how long it has been active, and the timers that run.
/** @import { Robot, State } from "../types" */
import { Place } from "../places.js";
import { inPageLanguage } from "../quoted.js";
import { Part, Since, Until, html, t } from "../ui.js";

/**
 * The innermost active states of a tree, one for each region.
 * @param {State[]} states
 * @returns {State[]}
 */
export function innermost(states) {
  return states.flatMap((one) => (one.children?.length ? innermost(one.children) : [one]));
}

/**
 * Whether nothing has changed within a state since it was entered.
 * @param {State} state
 */
const still = (state) => innermost([state]).every((one) => one.since === state.since);

/**
 * Which of the states side by side are shown: the first, where a visit is, and those in which something changed.
 * @param {State[]} states
 */
export const folded = (states) => (states.length > 1 ? states.slice(1).filter(still) : []);

/**
 * @param {{ states: State[], now: () => number }} props
 * @returns {any}
 */
function Boxes({ states, now }) {
  const away = new Set(folded(states)),
    box = (/** @type {State} */ state) => html`<${Box} key=${state.path} state=${state} now=${now} />`;
  return html`<ul class="boxes">${states.filter((state) => !away.has(state)).map(box)}</ul>
    ${
      away.size > 0 &&
      html`<details class="still"><summary>${t("states.still")}${" "}
      <span class="state-name">${[...away].map((state) => state.name).join(", ")}</span></summary>
      <ul class="boxes">${[...away].map(box)}</ul></details>`
    }`;
}

/** @param {{ state: State, now: () => number }} props */
function Box({ state, now }) {
  const leaf = !state.children?.length;
  const name = state.name.slice(state.name.lastIndexOf(".") + 1); // the boxes around it show the rest of a path
  return html`<li class="state ${leaf ? "leaf" : ""}">
    <p class="state-head"><span class="state-name">${name}</span><span class="since" title=${t("since")}>
      <${Since} at=${state.since} now=${now} /></span></p>
    ${
      leaf
        ? html`<${Place} file=${state.file} line=${state.line} />`
        : html`<${Boxes} states=${state.children} now=${now} />`
    }</li>`;
}

/** @param {{ robot: Robot }} props */
export function States({ robot }) {
  const { states = [], timers = [] } = robot;
  return html`<${Part} title=${t("where")} kind="states">
    <${Boxes} states=${states} now=${robot.now} />
    ${
      timers.length > 0 &&
      html`<h3>${t("timers")}</h3><ul class="timers">${timers.map(
        (timer) => html`
      <li key=${timer.event + timer.due}><span>${inPageLanguage(timer.event)}</span><strong>
        <${Until} at=${timer.due} now=${robot.now} /></strong></li>`,
      )}</ul>`
    }
  </${Part}>`;
}
