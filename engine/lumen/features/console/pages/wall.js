// @ts-check
// Several robots: a tile each, with what is wrong with it and its own Rest.
/** @import { Robot } from "./types" */
import { consoleNow, isHere, live } from "./live.js";
import { inPageLanguage } from "./quoted.js";
import { Resume } from "./resume.js";
import { Badge, Since, html, percent, t, useRedraw } from "./ui.js";
import { innermost } from "./now/states.js";
import { LOW, MILD, alarmsOf, batteryOf } from "./now/troubles.js";

/**
 * How a robot is, as badges: what is wrong, what it waits for, that it rests; else that it runs.
 * @param {Robot} robot
 * @returns {[state: string, text: string][]}
 */
function badges(robot) {
  /** @type {[string, string][]} */
  const all = alarmsOf(robot).map((kind) => [MILD.includes(kind) ? "warn" : "bad", t(`alarm.${kind}`)]);
  const by = inPageLanguage(robot.stopped_by ?? "?");
  if (robot.stopped && isHere(robot)) all.push(["stopped", t("tile.stopped", { by })]);
  return all.length ? all : [["well", t("tile.well")]];
}

/** @param {{ robot: Robot }} props */
function Tile({ robot }) {
  const { robot: name, saying } = robot,
    link = `/robot/${encodeURIComponent(name)}`,
    battery = batteryOf(robot);
  const said = badges(robot),
    leaf = innermost(robot.states ?? []);
  return html`<li class="tile" data-state=${said[0][0]} aria-label=${name}>
    <div class="tile-head"><h2><a href=${link}>${name}</a></h2><rest-button robot=${name}></rest-button></div>
    ${said.map(([state, text]) => html`<p class="badge" key=${text} data-state=${state}>${text}</p>`)}
    ${!isHere(robot) && html`<p class="quiet">${t("last.known")} <${Since} at=${robot.heard} now=${consoleNow} /></p>`}
    <${Resume} robot=${robot} />
    <p class="where">${leaf.map((one) => one.name).join(" · ") || (robot.configuration ?? []).join(" · ")}
      ${leaf[0] && html` <span class="quiet"><${Since} at=${leaf[0].since} now=${robot.now} /></span>`}</p>
    <p class="line">${saying ? html`“${saying.text}”` : html`<span class="quiet">${t("says.nothing")}</span>`}</p>
    <dl class="facts"><div><dt>${t("visitor")}</dt><dd>${robot.visitor || t("nobody.here")}</dd></div>
      <div><dt>${t("battery")}</dt><dd>${battery === null ? t("unknown") : percent(battery)}
        ${battery !== null && battery < LOW && html` <${Badge} state="bad">${t("battery.low")}</${Badge}>`}</dd></div>
      <div><dt>${t("realtime")}</dt><dd>${robot.realtime == null ? t("unknown") : percent(robot.realtime * 100)}</dd>
        </div></dl></li>`;
}

export function Wall() {
  useRedraw();
  const robots = [...live.robots.values()].sort((a, b) => a.robot.localeCompare(b.robot));
  return html`<h1 class="hidden">${t("page.wall")}</h1><ul class="wall">${robots.map(
    (robot) => html`<${Tile}
    key=${robot.robot} robot=${robot} />`,
  )}</ul>`;
}
