// @ts-check
// Many houses: their robots, the steps of a rollout, and what stops it.
/** @import { Fleet, FleetRobot, House as Home, Rollout as Rolled } from "../types" */
import { get, post } from "../live.js";
import { Quote, inPageLanguage, reasonOf } from "../quoted.js";
import { may } from "../session.js";
import { Ask, Badge, Part, fixed, html, span, t, useEffect, useState } from "../ui.js";

const PERIOD = 2000; // [ms] how often the centre is asked
/** @type {Record<string, string>} */
const LEVELS = { proved: "open", away: "warn", unknown: "warn", refused: "bad", "rolled back": "bad", edited: "warn" };
/** @type {Record<string, string>} */
const VERDICTS = { going: "open", finished: "open", aborted: "bad", paused: "warn", "a person decides": "warn" };

/** @param {{ rollout: Rolled }} props */
function Steps({ rollout }) {
  return html`<ol class="steps">${rollout.steps.map((step, i) => {
    const now = i === rollout.step && !step.done;
    return html`<li aria-current=${now ? "step" : null}>
      <b>${inPageLanguage(step.to)}</b> ${t("fleet.most", { count: step.most })}
      ${" "}<${Badge} state=${step.done ? "open" : now ? VERDICTS[rollout.state] : "kind"}
        >${t(step.done ? "fleet.good" : now ? `fleet.${rollout.state}` : "fleet.later")}</${Badge}>
      ${
        now &&
        html` <span
        class="quiet">${t("fleet.watched", { watched: span(rollout.watched), pause: span(rollout.pause) })}</span>`
      }</li>`;
  })}</ol>`;
}

/** @param {{ rollout: Rolled, act: (decision: string) => void }} props */
function Actions({ rollout, act }) {
  const [asking, ask] = useState(false);
  const waits = rollout.state !== "going";
  return html`<div class="actions">
    <button type="button" onClick=${() => act(waits ? "go" : "pause")}>${t(waits ? "fleet.go" : "fleet.pause")}</button>
    <button type="button" class="strong" onClick=${() => ask(true)}>${t("fleet.abort")}</button></div>
    ${
      asking &&
      html`<${Ask} title=${t("fleet.abort.ask")} label=${t("fleet.abort")} onClose=${() => ask(false)}
      onYes=${() => act("abort")}>
      <p>${t("fleet.abort.more", { count: rollout.assigned.length })}</p></${Ask}>`
    }`;
}

/** @param {{ rollout: Rolled | null, act: (decision: string) => void }} props */
function Rollout({ rollout, act }) {
  if (!rollout)
    return html`<${Part} title=${t("fleet.rollout")} kind="rollout"><p class="quiet">${t("fleet.none")}</p></${Part}>`;
  const under = ["going", "paused", "a person decides"].includes(rollout.state);
  return html`<${Part} title=${t("fleet.rollout")} kind="rollout" aside=${html`<${Badge}
    state=${VERDICTS[rollout.state]}>${t(`fleet.${rollout.state}`)}</${Badge}>`}>
    <p>${t("fleet.bundle")} <span class="place">${rollout.bundle.slice(0, 12)}</span> <${Quote}
      text=${rollout.reason} /></p>
    <${Steps} rollout=${rollout} />
    ${rollout["abort-if"] && html`<p class="quiet">${t("fleet.abort.if")} <code>${rollout["abort-if"]}</code></p>`}
    ${under && may("operator") && html`<${Actions} rollout=${rollout} act=${act} />`}</${Part}>`;
}

/** @param {{ house: Home, robots: FleetRobot[] }} props */
function House({ house, robots }) {
  return html`<${Part} title=${house.name} kind="house" aside=${html`<span
    class="quiet">${t("fleet.here", { here: house.here, robots: house.robots })}</span>`}>
    <ul class="plain-list">${robots.map(
      (robot) => html`<li key=${robot.name}><b>${robot.name}</b>
      ${" "}<${Badge} state=${LEVELS[robot.state] ?? "kind"}>${t(`fleet.${robot.state}`)}</${Badge}>
      ${" "}<span class="place">${robot.bundle.slice(0, 12)}</span>${
        robot.pinned && html` <${Badge} state="kind">${t("fleet.pinned")}</${Badge}>`
      }
      ${robot.trouble && html`<p><${Quote} text=${robot.trouble} /></p>`}</li>`,
    )}</ul></${Part}>`;
}

export default function FleetPage() {
  const [fleet, set] = useState(/** @type {Fleet | null} */ (null)),
    [failed, fail] = useState("");
  const look = () =>
    get("/api/fleet").then(
      (found) => {
        set(found);
        fail("");
      },
      (error) => fail(reasonOf(error)),
    );
  useEffect(() => {
    look();
    const timer = setInterval(look, PERIOD);
    return () => clearInterval(timer);
  }, []);
  const act = (/** @type {string} */ decision) =>
    post("/api/fleet", { decision }).then(look, (error) => fail(reasonOf(error)));
  const here = (fleet?.robots ?? []).filter((one) => one.here).length;
  const trouble = failed || fleet?.trouble || fleet?.centre?.overruled;
  return html`<h1>${t("page.fleet")}</h1>
    ${trouble && html`<p class="notice bad" role="alert"><${Quote} text=${trouble} /></p>`}
    ${
      !fleet
        ? !failed && html`<p class="notice">${t("loading")}</p>`
        : html`
      <p class="quiet">${t("fleet.here", { here: fixed(here), robots: fixed(fleet.robots.length) })}</p>
      <${Rollout} rollout=${fleet.rollout} act=${act} />
      <div class="wall">${fleet.houses.map(
        (house) => html`<${House} key=${house.name} house=${house}
        robots=${fleet.robots.filter((one) => one.house === house.name)} />`,
      )}</div>`
    }`;
}
