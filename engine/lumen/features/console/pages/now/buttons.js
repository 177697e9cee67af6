// @ts-check
// The buttons that the behaviour declares for the states it is in; held, asked or pressed at once, as declared.
/** @import { Button as Declared, Robot } from "../types" */
import { command } from "../commands.js";
import { isHere } from "../live.js";
import { inPageLanguage } from "../quoted.js";
import { may } from "../session.js";
import { Ask, Part, html, inLanguage, t, useEffect, useRef, useState } from "../ui.js";

const HELD = 1000; // [ms]

/**
 * A button as it can be used now: none while the robot does not answer.
 * @param {Robot} robot
 * @param {Declared} button
 */
const usable = (robot, button) =>
  isHere(robot) ? button : { ...button, enabled: false, reason: t("robot.silent", { name: robot.robot }) };

/** @param {{ robot: Robot, button: Declared }} props */
function Button({ robot, button: declared }) {
  const button = usable(robot, declared);
  const [held, hold] = useState(false),
    [asking, ask] = useState(false),
    timer = useRef(0),
    since = useRef(0); // the timeStamp of the press [ms]; a busy page hears press and release late
  const label = inLanguage(button.label);
  const press = () => command(robot.robot, "event", { event: button.event, data: button.data ?? null }, label);
  const begin = (/** @type {KeyboardEvent | PointerEvent} */ event) => {
    if (button.confirm !== "hold" || !button.enabled || timer.current) return;
    if (event instanceof KeyboardEvent) {
      if (event.repeat || !["Enter", " "].includes(event.key)) return;
      event.preventDefault();
    } else {
      // It is held, wherever it moves.
      /** @type {HTMLElement} */ (event.currentTarget).setPointerCapture(event.pointerId);
    }
    wait(event);
  };
  const wait = (/** @type {Event} */ event) => {
    hold(true);
    since.current = event.timeStamp;
    timer.current = setTimeout(() => {
      end();
      press();
    }, HELD);
  };
  const end = () => {
    clearTimeout(timer.current);
    timer.current = 0;
    hold(false);
  };
  const release = (/** @type {Event} */ event) => {
    const full = timer.current && event.timeStamp - since.current >= HELD;
    end();
    if (full) press();
  };
  const click = () => {
    if (!button.enabled || button.confirm === "hold") return;
    if (button.confirm === "ask") ask(true);
    else press();
  };
  useEffect(() => end, []);
  useEffect(() => {
    if (!button.key) return undefined;
    const pressed = (/** @type {KeyboardEvent} */ event) => {
      if (event.key !== button.key || event.repeat || event.ctrlKey || event.metaKey || event.altKey) return;
      if (/** @type {Element} */ (event.target).closest("input, textarea, select, dialog")) return;
      event.preventDefault();
      if (!button.enabled) return;
      if (button.confirm !== "hold") click();
      else if (!timer.current) wait(event);
    };
    const released = (/** @type {KeyboardEvent} */ event) => {
      if (event.key === button.key) release(event);
    };
    addEventListener("keydown", pressed);
    addEventListener("keyup", released);
    return () => {
      removeEventListener("keydown", pressed);
      removeEventListener("keyup", released);
    };
  });
  const describing = !button.enabled
    ? inPageLanguage(button.reason)
    : button.confirm === "hold"
      ? t("button.hold")
      : "";
  return html`<li><button type="button" class="declared ${held ? "held" : ""}"
    aria-disabled=${button.enabled ? null : "true"}
      aria-description=${describing} aria-keyshortcuts=${button.key || null} onClick=${click}
      onPointerDown=${begin} onPointerUp=${release} onPointerLeave=${end} onPointerCancel=${end} onKeyDown=${begin}
        onKeyUp=${release} onBlur=${end}
      onContextMenu=${(/** @type {Event} */ event) => event.preventDefault()}>
      <span>${label}</span>${button.key && html`<kbd aria-hidden="true">${button.key}</kbd>`}
      ${
        button.confirm === "hold" &&
        html`<svg class="ring" viewBox="0 0 36 36" aria-hidden="true">
        <circle class="track" cx="18" cy="18" r="15" /><circle class="fill" cx="18" cy="18" r="15" pathLength="100" />
        </svg>`
      }
    </button>${describing && html`<p class="reason" aria-hidden="true">${describing}</p>`}
    ${
      asking &&
      html`<${Ask} title=${t("button.ask", { label })} label=${label} onClose=${() => ask(false)} onYes=${press}>
      ${may("author") && html`<p>${t("button.event", { event: button.event })}</p>`}</${Ask}>`
    }</li>`;
}

/** @param {{ robot: Robot }} props */
export function Buttons({ robot }) {
  const buttons = robot.buttons ?? [];
  return html`<${Part} title=${t("buttons")} kind="buttons">
    ${
      buttons.length
        ? html`<ul class="declared-list">${buttons.map(
            (button) => html`<${Button}
          key=${`${button.state} ${button.event} ${JSON.stringify(button.label)}`} robot=${robot}
          button=${button} />`,
          )}</ul>`
        : html`<p class="quiet">${t("buttons.none")}</p>`
    }</${Part}>`;
}
