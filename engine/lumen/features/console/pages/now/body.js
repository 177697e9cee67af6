// @ts-check
// How the robot and what runs it are: power, heat, distance, time, processes, modules, queues.
/** @import { Robot } from "../types" */
import { Badge, Part, Since, Usable, clock, fixed, html, percent, t } from "../ui.js";
import { Quote, inPageLanguage } from "../quoted.js";
import { consoleNow, isHere } from "../live.js";
import { holds } from "../session.js";
import { Autonomy, Model } from "./approvals.js";
import { HOT, LOW, batteryOf, greatest, processesOf } from "./troubles.js";

const SLOW = 0.95; // of real time

/**
 * A fact in words; `full` if it has a meter with a `level` from 0 to 1.
 * @param {{ name: string, value: string, level?: number, state?: string, words?: string, full?: boolean }} props
 */
function Fact({ name, value, level = 0, state = "well", words = "", full = false }) {
  return html`<div class="fact" data-state=${state}><dt>${name}</dt><dd>
    <b>${value}</b>${words && html` <${Badge} state=${state === "well" ? "open" : "bad"}>${words}</${Badge}>`}
    ${full && html`<meter min="0" max="1" value=${level} aria-label=${name} ></meter>`}</dd></div>`;
}

/** @param {{ robot: Robot }} props */
function Senses({ robot }) {
  const { senses = {}, realtime } = robot,
    hot = greatest(senses.temperatures);
  const battery = batteryOf(robot),
    sonar = senses.sonar ?? {};
  const heat = Array.isArray(hot) ? hot[1] : hot,
    hotter = heat !== null && heat > HOT,
    slow = realtime != null && realtime < SLOW;
  const metres = (/** @type {number | null | undefined} */ value) =>
    value == null ? t("unknown") : `${fixed(value, 2)} m`;
  const unknown = sonar.leftSensor == null && sonar.rightSensor == null;
  const sides = [`${t("left")} ${metres(sonar.leftSensor)}`, `${t("right")} ${metres(sonar.rightSensor)}`];
  return html`<dl class="body-facts">
    <${Fact} name=${t("battery")} value=${battery === null ? t("unknown") : percent(battery)}
      full=${battery !== null}
      level=${(battery ?? 0) / 100} state=${battery !== null && battery < LOW ? "bad" : "well"}
        words=${battery !== null && battery < LOW ? t("battery.low") : ""} />
    <${Fact} name=${t("heat")}
      value=${heat === null ? t("unknown") : `${fixed(heat)} °C${Array.isArray(hot) ? ` ${hot[0]}` : ""}`}
      state=${hotter ? "bad" : "well"} words=${hotter ? t("heat.high") : ""} />
    <${Fact} name=${t("sonar")} value=${unknown ? t("unknown") : sides.join(" · ")} />
    ${robot.ears && html`<${Fact} name=${t("ears")} value=${t(`ears.${robot.ears.because}`)} />`}
    <${Fact} name=${t("realtime")} value=${realtime == null ? t("unknown") : percent(realtime * 100)}
      state=${slow ? "bad" : "well"} words=${slow ? t("realtime.slow") : ""} />
    <${Fact} name=${t("queues")} value=${robot.queues ? t("queues.both", robot.queues) : t("unknown")} /></dl>`;
}

/** @param {{ robot: Robot }} props */
function Processes({ robot }) {
  const processes = processesOf(robot);
  return html`<h3>${t("processes")}</h3>${
    processes.length
      ? html`<ul class="processes">${processes.map((one) => {
          const gone = one.state !== "here";
          return html`<li key=${one.parts.join()} data-state=${gone ? "bad" : "well"}>
            <span>${one.parts.join(", ")}</span>
      ${
        robot.connected === false
          ? html`<${Badge}>${t("unknown")}</${Badge}>`
          : html`<${Badge} state=${gone ? "bad" : "open"}>${t(`process.${one.state}`)}</${Badge}>`
      }
      <span class="quiet">${one.word ? `${inPageLanguage(one.word)} · ` : ""}${t("heard.ago")} <${Since} at=${one.heard}
        now=${consoleNow} /></span></li>`;
        })}</ul>`
      : html`<p class="quiet">${t("processes.none")}</p>`
  }`;
}

/** @param {{ robot: Robot }} props */
export function Body({ robot }) {
  const reload = robot.last_reload;
  return html`<${Part} title=${t("body")} kind="body">
    ${
      !isHere(robot) &&
      html`<p><${Badge} state="warn">${t("last.known")}</${Badge}>
      </p>`
    }<${Senses} robot=${robot} /><${Processes} robot=${robot} />
    ${
      reload &&
      html`<h3>${t("last.reload")}</h3><p><${Badge} state=${reload.verdict === "refused" ? "bad" : "open"}
        >${t(`verdict.${reload.verdict}`)}</${Badge}>${" "}
      <span class="quiet">${clock(reload.at)}</span> ${
        holds("author") &&
        html`<${Quote}
        text=${reload.text} />`
      } ${reload.verdict === "refused" && t("files.goes.on")} <a
        href="/robot/${encodeURIComponent(robot.robot)}/files">${t("page.files")}</a></p>`
    }
    <${Usable} when=${isHere(robot)}><${Autonomy} robot=${robot} /><${Model} robot=${robot} /></${Usable}></${Part}>`;
}
