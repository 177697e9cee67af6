// Cues of an author: any motion, posture, state or event, whatever the behaviour is doing.
import { command } from "../commands.js";
import { Part, html, t, useState } from "../ui.js";

function Cue({ robot, kind, names, field, free = false }) {
  const [chosen, choose] = useState(names[0] ?? "");
  const send = (event) => {
    event.preventDefault();
    if (chosen) command(robot.robot, kind, { [field]: chosen }, `${t(`command.${kind}`)} ${chosen}`);
  };
  return html`<form class="cue" onSubmit=${send}><label class="grow"><span>${t(`cue.${kind}`)}</span>
    ${
      free
        ? html`<input value=${chosen} onInput=${(e) => choose(e.target.value)} autocomplete="off" />`
        : html`<select value=${chosen} onChange=${(e) => choose(e.target.value)}>${names.map(
            (name) => html`<option
          value=${name} selected=${name === chosen}>${name}</option>`,
          )}</select>`
    }</label>
    <button>${t(`cue.${kind}.send`)}</button></form>`;
}

function EventCue({ robot }) {
  const [name, choose] = useState(robot.events?.[0] ?? ""),
    [data, set] = useState("{}"),
    [wrong, tell] = useState("");
  const send = (event) => {
    event.preventDefault();
    let body = null;
    try {
      body = JSON.parse(data || "{}");
    } catch {
      return tell(t("cue.data.wrong"));
    }
    tell("");
    command(robot.robot, "event", { event: name, data: body }, `${t("command.event")} ${name}`);
  };
  return html`<form class="cue" onSubmit=${send}><label class="grow"><span>${t("cue.event")}</span>
      <select value=${name} onChange=${(e) => choose(e.target.value)}>${(robot.events ?? []).map(
        (one) => html`<option
        value=${one} selected=${one === name}>${one}</option>`,
      )}</select></label>
    <label class="grow"><span>${t("cue.data")}</span><input class="code" value=${data}
      onInput=${(e) => set(e.target.value)} aria-invalid=${wrong ? "true" : null} autocomplete="off"
      spellcheck=${false} /></label>
    <button>${t("cue.event.send")}</button><p class="bad" role="alert">${wrong}</p></form>`;
}

export function Cues({ robot }) {
  return html`<${Part} title=${t("cues")} kind="cues">
    ${robot.motions?.length > 0 && html`<${Cue} robot=${robot} kind="motion" field="name" names=${robot.motions} />`}
    ${robot.postures?.length > 0 && html`<${Cue} robot=${robot} kind="posture" field="name" names=${robot.postures} />`}
    <${Cue} robot=${robot} kind="goto" field="state" names=${[]} free />
    ${robot.events?.length > 0 && html`<${EventCue} robot=${robot} />`}</${Part}>`;
}
