// @ts-check
// Resume: a robot that rests, or a behaviour that waits, goes on once a person has looked at the room.
/** @import { Robot } from "./types" */
import { command } from "./commands.js";
import { isHere } from "./live.js";
import { waitsForResume } from "./now/troubles.js";
import { inPageLanguage } from "./quoted.js";
import { may } from "./session.js";
import { Ask, Usable, html, t, useState } from "./ui.js";

/**
 * The button and its question; nothing if the robot neither rests nor waits, or the person may not.
 * @param {{ robot: Robot }} props
 */
export function Resume({ robot }) {
  const [asking, ask] = useState(false),
    waits = waitsForResume(robot);
  if (!may("operator") || !(robot.stopped || waits)) return null;
  return html`<${Usable} when=${isHere(robot)}>
      <button type="button" class="resume" onClick=${() => ask(true)}>${t("resume")}</button></${Usable}>
    ${
      asking &&
      html`<${Ask} title=${t("resume.ask", { name: robot.robot })} label=${t("resume")} onClose=${() => ask(false)}
      onYes=${() => command(robot.robot, "resume")}>
      ${!waits && html`<p>${t("resume.by", { by: inPageLanguage(robot.stopped_by ?? "?") })}</p>`}
      <p>${t("resume.room")}</p></${Ask}>`
    }`;
}
