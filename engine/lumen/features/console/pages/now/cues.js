// @ts-check
// Cues of an author: any motion, posture, state or event, whatever the behaviour is doing.
/** @import { Robot } from "../types" */
import { command } from "../commands.js";
import { Part, Select, html, t, useState, typed } from "../ui.js";

/**
 * A motion, a posture or a state; `free` if its name is typed.
 * @param {{ robot: Robot, kind: string, names: string[], field: string, free?: boolean }} props
 */
function Cue({ robot, kind, names, field, free = false }) {
  const [chosen, choose] = useState(names[0] ?? "");
  const send = (/** @type {SubmitEvent} */ event) => {
    event.preventDefault();
    if (chosen) command(robot.robot, kind, { [field]: chosen }, `${t(`command.${kind}`)} ${chosen}`);
  };
  return html`<form class="cue" onSubmit=${send}><label class="grow"><span>${t(`cue.${kind}`)}</span>
    ${
      free
        ? html`<input value=${chosen} onInput=${typed(choose)} autocomplete="off" />`
        : html`<${Select} value=${chosen} choose=${choose} options=${names.map((one) => [one, one])} />`
    }</label>
    <button>${t(`cue.${kind}.send`)}</button></form>`;
}

/** @param {{ robot: Robot }} props */
function EventCue({ robot }) {
  const [name, choose] = useState(robot.events?.[0] ?? ""),
    [data, set] = useState("{}"),
    [wrong, tell] = useState("");
  const send = (/** @type {SubmitEvent} */ event) => {
    event.preventDefault();
    let body = null;
    try {
      body = JSON.parse(data || "{}");
    } catch {
      tell(t("cue.data.wrong"));
      return;
    }
    tell("");
    command(robot.robot, "event", { event: name, data: body }, `${t("command.event")} ${name}`);
  };
  return html`<form class="cue" onSubmit=${send}><label class="grow"><span>${t("cue.event")}</span>
      <${Select} value=${name} choose=${choose}
        options=${(robot.events ?? []).map((one) => [one, one])} /></label>
    <label class="grow"><span>${t("cue.data")}</span><input class="code" value=${data}
      onInput=${typed(set)} aria-invalid=${wrong ? "true" : null} autocomplete="off"
      spellcheck=${false} /></label>
    <button>${t("cue.event.send")}</button><p class="bad" role="alert">${wrong}</p></form>`;
}

/** @param {{ robot: Robot }} props */
export function Cues({ robot }) {
  const { motions = [], postures = [], events = [] } = robot;
  return html`<${Part} title=${t("cues")} kind="cues">
    ${motions.length > 0 && html`<${Cue} robot=${robot} kind="motion" field="name" names=${motions} />`}
    ${postures.length > 0 && html`<${Cue} robot=${robot} kind="posture" field="name" names=${postures} />`}
    <${Cue} robot=${robot} kind="goto" field="state" names=${[]} free />
    ${events.length > 0 && html`<${EventCue} robot=${robot} />`}</${Part}>`;
}
