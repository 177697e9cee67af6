// Several robots: a tile each, with its own Rest.
import { live } from "./live.js";
import { Since, html, percent, t, useRedraw } from "./ui.js";
import { LOW } from "./now/body.js";
import { innermost } from "./now/states.js";
import { lostBody } from "./now/troubles.js";
import { inPageLanguage } from "./quoted.js";

function Tile({ robot }) {
  const { robot: name, saying, skew } = robot, link = `/robot/${encodeURIComponent(name)}`;
  const state = robot.connected === false ? "away" : lostBody(robot) ? "lost" : robot.stopped ? "stopped" : "well";
  const leaf = innermost(robot.states ?? []);
  return html`<li class="tile" data-state=${state} aria-label=${name}>
    <div class="tile-head"><h2><a href=${link}>${name}</a></h2><rest-button robot=${name}></rest-button></div>
    <p class="badge" data-state=${state}>${t(`tile.${state}`, { by: inPageLanguage(robot.stopped_by ?? "?") })}</p>
    <p class="where">${leaf.map((one) => one.name).join(" · ") || (robot.configuration ?? []).join(" · ")}
      ${leaf[0] && html` <span class="quiet"><${Since} at=${leaf[0].since} skew=${skew} /></span>`}</p>
    <p class="line">${saying ? html`“${saying.text}”` : html`<span class="quiet">${t("says.nothing")}</span>`}</p>
    <dl class="facts"><div><dt>${t("visitor")}</dt><dd>${robot.visitor || t("nobody.here")}</dd></div>
      <div><dt>${t("battery")}</dt><dd>${robot.battery == null ? t("unknown") : percent(robot.battery)}${robot.battery != null && robot.battery < LOW && html` <span class="badge" data-state="bad">${t("battery.low")}</span>`}</dd></div>
      <div><dt>${t("realtime")}</dt><dd>${robot.realtime == null ? t("unknown") : percent(robot.realtime * 100)}</dd></div></dl></li>`;
}

export function Wall() {
  useRedraw();
  const robots = [...live.robots.values()].sort((a, b) => a.robot.localeCompare(b.robot));
  return html`<h1 class="hidden">${t("page.wall")}</h1><ul class="wall">${robots.map((robot) => html`<${Tile} key=${robot.robot} robot=${robot} />`)}</ul>`;
}
