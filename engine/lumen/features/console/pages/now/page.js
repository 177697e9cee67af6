// @ts-check
// Now: where the behaviour is, what it says, what may come, and how the robot is.
import { isHere, robotOf } from "../live.js";
import { may } from "../session.js";
import { Usable, html, t, useRedraw } from "../ui.js";
import { Approvals } from "./approvals.js";
import { Body } from "./body.js";
import { Buttons } from "./buttons.js";
import { BehaviorChart } from "./chart.js";
import { Cues } from "./cues.js";
import { Entries } from "./entries.js";
import { OwnParts } from "./skills.js";
import { Situation } from "./situation.js";
import { States } from "./states.js";
import { Lines, Talk } from "./talk.js";
import { Troubles } from "./troubles.js";
import { Ways } from "./ways.js";

/**
 * The buttons are below parts of a fixed height: what is pressed does not move when somebody speaks.
 * @param {{ name: string }} props
 */
export function NowPage({ name }) {
  useRedraw();
  const robot = robotOf(name);
  if (!robot) return null;
  return html`<h1 class="hidden">${t("page.now")}: ${name}</h1>
    <${Troubles} robot=${robot} />
    <${Situation} robot=${robot} />
    <div class="now" data-stale=${isHere(robot) ? null : "true"}><div class="column"><${Lines} robot=${robot} />
      <${Buttons} robot=${robot} /><${Approvals} robot=${robot} /><${Talk} robot=${robot} />
      <${Entries} robot=${robot} /></div>
      <div class="column"><${States} robot=${robot} /><${Ways} robot=${robot} /></div>
      <div class="column"><${Body} robot=${robot} /><${OwnParts} robot=${robot} />
        ${may("author") && html`<${Usable} when=${isHere(robot)}><${Cues} robot=${robot} /></${Usable}>`}</div></div>
    <${BehaviorChart} robot=${robot} />`;
}
