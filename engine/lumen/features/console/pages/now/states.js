// The active states as boxes in boxes, each with how long it has been active, and the timers that run.
import { Place } from "../places.js";
import { inPageLanguage } from "../quoted.js";
import { Part, Since, Until, html, t } from "../ui.js";

/** The innermost active states of a tree, one for each region. */
export function innermost(states) {
  return states.flatMap((one) => (one.children?.length ? innermost(one.children) : [one]));
}

function Box({ state, now }) {
  const leaf = !state.children?.length;
  return html`<li class="state ${leaf ? "leaf" : ""}">
    <p class="state-head"><span class="state-name">${state.name}</span><span class="since" title=${t("since")}><${Since} at=${state.since} now=${now} /></span></p>
    ${leaf ? html`<${Place} file=${state.file} line=${state.line} />`
      : html`<ul>${state.children.map((child) => html`<${Box} key=${child.path} state=${child} now=${now} />`)}</ul>`}</li>`;
}

export function States({ robot }) {
  const states = robot.states ?? [];
  return html`<${Part} title=${t("where")} kind="states">
    <ul class="boxes">${states.map((state) => html`<${Box} key=${state.path} state=${state} now=${robot.now} />`)}</ul>
    ${robot.timers?.length > 0 && html`<h3>${t("timers")}</h3><ul class="timers">${robot.timers.map((timer) => html`
      <li key=${timer.event + timer.due}><span>${inPageLanguage(timer.event)}</span><strong><${Until} at=${timer.due} now=${robot.now} /></strong></li>`)}</ul>`}
  </${Part}>`;
}
