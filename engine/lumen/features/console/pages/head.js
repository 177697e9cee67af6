// @ts-check
// The header of each page: which robot, whether the page is live, alarms, the other pages, and the settings.
/** @import { Robot } from "./types" */
import { alarm } from "./alarm.js";
import { consoleNow, live } from "./live.js";
import { MILD, alarmsOf, lostBody, waitsForResume } from "./now/troubles.js";
import { inPageLanguage } from "./quoted.js";
import { Resume } from "./resume.js";
import { ROLES, askPin, leave, mode, show } from "./session.js";
import {
  LANGUAGES,
  Select,
  Since,
  byId,
  html,
  ticked,
  keep,
  kept,
  language,
  redraw,
  speak,
  t,
  useEffect,
  useLayoutEffect,
  useRedraw,
  useRef,
  useState,
} from "./ui.js";

const PAGES = ["", "day", "files", "see"];

/**
 * The alarms of robots, `[robot, kind, when]` each: another fall is another alarm. Mild ones are left out.
 * @typedef {[robot: string, kind: string, when: string]} Alarm
 * @param {Robot[]} robots
 * @returns {Alarm[]}
 */
const wrong = (robots) =>
  robots.flatMap((one) =>
    alarmsOf(one)
      .filter((kind) => !MILD.includes(kind))
      .map((kind) => /** @type {Alarm} */ ([one.robot, kind, live.alarms.get(`${one.robot} ${kind}`)?.at_time ?? ""])),
  );

/**
 * How the page and its robot are, in a word.
 * @param {Robot | null | undefined} robot
 * @param {Alarm[]} alarms
 */
function connection(robot, alarms) {
  if (live.state !== "live") return live.state;
  if (robot?.connected === false) return "robot-away";
  if (robot && lostBody(robot)) return "robot-lost";
  return alarms.length ? "alarm" : "live";
}

/** @param {{ robot: Robot | null | undefined, alarms: Alarm[] }} props */
function Connection({ robot, alarms }) {
  const state = connection(robot, alarms),
    away = state === "robot-away";
  const at = away ? robot?.heard : new Date(live.since).toISOString();
  return html`<p class="connection" data-state=${state} role="status"><span class="dot" aria-hidden="true">
    </span>${t(`connection.${state}`)}
    ${
      ["live", "alarm", "robot-lost"].includes(state)
        ? null
        : html`<span aria-hidden="true"> <${Since} at=${at} now=${away ? consoleNow : Date.now} /></span>`
    }</p>`;
}

/**
 * The alarms in the header of a page that does not show them itself; each leads to the page that says what to do.
 * @param {{ alarms: Alarm[], name: string | null }} props
 */
function Alarms({ alarms, name }) {
  const shown = name !== null && lumen.page !== "" ? alarms : [];
  return html`<div class="alarms" role="alert">${shown.map(
    ([robot, kind]) => html`
    <p key=${robot + kind}><b>${robot}: ${t(`alarm.${kind}`)}.</b> <a
      href="/robot/${encodeURIComponent(robot)}">${t("alarm.open")}</a></p>`,
  )}</div>`;
}

/** @param {{ robot: Robot | null | undefined }} props */
function Stopped({ robot }) {
  const waits = robot && waitsForResume(robot),
    by = inPageLanguage(robot?.stopped_by ?? "?");
  if (!robot || (!robot.stopped && !waits)) return null;
  return html`<div class="stopped"><p role="status">
    <strong>${t(waits ? "waits" : "stopped")}</strong> ${t(waits ? "waits.more" : "stopped.by", { by })}</p>
    <${Resume} robot=${robot} /></div>`;
}

function Theme() {
  const now = kept("lumen.theme") ?? "auto";
  const set = (/** @type {string} */ theme) => {
    if (theme === "auto") delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = theme;
    keep("lumen.theme", theme === "auto" ? null : theme);
    redraw();
  };
  return html`<label>${t("theme")}<${Select} value=${now} choose=${set}
      options=${["auto", "light", "dark"].map((theme) => [theme, t(`theme.${theme}`)])} /></label>`;
}

/** A sound as an alarm begins: this browser makes it, so each person decides for themselves. */
function Sound() {
  const on = kept("lumen.sound") === "on";
  const set = (/** @type {boolean} */ wanted) => {
    keep("lumen.sound", wanted ? "on" : null);
    if (wanted) alarm.sound();
    redraw();
  };
  return html`<label class="check">
    <input type="checkbox" checked=${on} onChange=${ticked(set)} /> ${t("sound")}</label>`;
}

function Settings() {
  const [open, set] = useState(false),
    button = useRef(/** @type {HTMLButtonElement | null} */ (null));
  // In the same frame as the sheet: Escape closes it as soon as it is seen.
  useLayoutEffect(() => {
    if (!open) return undefined;
    const pressed = (/** @type {KeyboardEvent} */ event) => {
      if (event.key === "Escape" && !event.repeat) {
        set(false);
        button.current?.focus();
      }
    };
    addEventListener("keydown", pressed);
    return () => removeEventListener("keydown", pressed);
  }, [open]);
  const modes = ROLES.slice(1, ROLES.indexOf(live.role ?? "nobody") + 1);
  return html`<div class="settings"><button type="button" class="plain" ref=${button} aria-expanded=${open}
    aria-controls="settings" onClick=${() => set(!open)}>
      <span aria-hidden="true">☰</span> <span class="word">${t("settings")}</span></button>
    <div id="settings" hidden=${!open} class="sheet">
      ${
        modes.length > 1 &&
        html`<label>${t("mode")}<${Select} value=${mode()} choose=${show}
          options=${modes.map((one) => [one, t(`mode.${one}`)])} /></label>`
      }
      <label>${t("language")}<${Select} value=${language()} choose=${speak}
        options=${Object.entries(LANGUAGES).map(([code, name]) => [code, name, code])} /></label>
      <${Theme} /><${Sound} />
      ${
        live.role === "nobody"
          ? html`<button type="button" onClick=${askPin}>${t("sign.in")}</button>`
          : html`<button type="button" onClick=${askPin}>${t("sign.other")}</button>
            <button type="button" onClick=${leave}>${t("sign.out")}</button>`
      }
    </div></div>`;
}

/** @param {{ name: string, several: boolean }} props */
function Links({ name, several }) {
  const base = `/robot/${encodeURIComponent(name)}`;
  return html`<nav aria-label=${t("pages")}><ul>
    ${several && html`<li><a href="/">${t("page.wall")}</a></li>`}
    ${PAGES.map(
      (page) => html`<li><a href=${page ? `${base}/${page}` : base}
      aria-current=${page === lumen.page ? "page" : null}>${t(`page.${page || "now"}`)}</a></li>`,
    )}
    ${live.fleet && html`<li><a href="/fleet">${t("page.fleet")}</a></li>`}
    <li><a href="${base}/subtitles" target="_blank">${t("page.subtitles")}</a></li></ul></nav>`;
}

export function Head() {
  useRedraw();
  const names = [...live.robots.keys()],
    name = lumen.robot ?? (names.length === 1 ? names[0] : null);
  const robot = name === null ? null : live.robots.get(name);
  const looks = live.state === "live" && live.role !== "nobody";
  const alarms = looks ? wrong(robot ? [robot] : [...live.robots.values()]) : [];
  useEffect(() => {
    const title = name ? `${name}: ${t(`page.${lumen.page || "now"}`)} · Lumen` : "Lumen";
    alarm.show(looks ? alarms : null, title);
    document.querySelector("rest-button[main]")?.toggleAttribute("several", name === null && names.length > 1);
  });
  useLayoutEffect(() => void (byId("skip").textContent = t("skip"))); // in the same frame as the rest of the page
  return html`<div class="who"><p class="name">${name ?? "Lumen"}</p><${Connection} robot=${robot} alarms=${alarms} />
    </div>
    ${name !== null && live.role !== "nobody" && html`<${Links} name=${name} several=${names.length > 1} />`}
    <${Settings} /><${Alarms} alarms=${alarms} name=${name} /><${Stopped} robot=${robot} />`;
}
