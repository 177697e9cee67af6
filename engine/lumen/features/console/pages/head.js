// What stands above each page: which robot, whether the page is live, where one may go, and how it is shown.
import { command } from "./commands.js";
import { live } from "./live.js";
import { lostBody, waitsForResume } from "./now/troubles.js";
import { inPageLanguage } from "./quoted.js";
import { ROLES, askPin, leave, may, mode, show } from "./session.js";
import { Dialog, LANGUAGES, Since, html, keep, kept, language, redraw, speak, t, useEffect, useRedraw, useState } from "./ui.js";

const PAGES = ["", "day", "files", "see"];

function Connection({ robot }) {
  const state = live.state !== "live" ? live.state : robot?.connected === false ? "robot-away" : robot && lostBody(robot) ? "robot-lost" : "live";
  return html`<p class="connection" data-state=${state} role="status"><span class="dot" aria-hidden="true"></span>${t(`connection.${state}`)}
    ${state === "live" || state === "robot-lost" ? null : html`<span aria-hidden="true"> <${Since} at=${new Date(live.since).toISOString()} skew=${0} /></span>`}</p>`;
}

function Resume({ robot }) {
  const [asking, ask] = useState(false);
  const waits = robot && waitsForResume(robot), by = inPageLanguage(robot?.stopped_by ?? "?");
  if (!robot?.stopped && !waits) return null;
  const go = () => { ask(false); command(robot.robot, "resume"); };
  return html`<div class="stopped"><p role="status"><strong>${t(waits ? "waits" : "stopped")}</strong> ${t(waits ? "waits.more" : "stopped.by", { by })}</p>
    ${may("operator") && html`<button type="button" class="resume" onClick=${() => ask(true)}>${t("resume")}</button>`}
    ${asking && html`<${Dialog} title=${t("resume.ask", { name: robot.robot })} onClose=${() => ask(false)}
      actions=${html`<button type="button" class="strong" onClick=${go}>${t("resume")}</button>`}>
      ${!waits && html`<p>${t("resume.by", { by })}</p>`}<p>${t("resume.room")}</p></${Dialog}>`}</div>`;
}

function Theme() {
  const now = kept("lumen.theme") ?? "auto";
  const set = (theme) => {
    if (theme === "auto") delete document.documentElement.dataset.theme; else document.documentElement.dataset.theme = theme;
    keep("lumen.theme", theme === "auto" ? null : theme);
    redraw();
  };
  return html`<label>${t("theme")}<select value=${now} onChange=${(e) => set(e.target.value)}>
    ${["auto", "light", "dark"].map((theme) => html`<option value=${theme} selected=${theme === now}>${t(`theme.${theme}`)}</option>`)}</select></label>`;
}

function Settings() {
  const [open, set] = useState(false);
  const modes = ROLES.slice(1, ROLES.indexOf(live.role ?? "nobody") + 1);
  return html`<div class="settings"><button type="button" class="plain" aria-expanded=${open} aria-controls="settings" onClick=${() => set(!open)}>
      <span aria-hidden="true">☰</span> <span class="word">${t("settings")}</span></button>
    <div id="settings" hidden=${!open} class="sheet">
      ${modes.length > 1 && html`<label>${t("mode")}<select value=${mode()} onChange=${(e) => show(e.target.value)}>
        ${modes.map((one) => html`<option value=${one} selected=${one === mode()}>${t(`mode.${one}`)}</option>`)}</select></label>`}
      <label>${t("language")}<select value=${language()} onChange=${(e) => speak(e.target.value)}>
        ${Object.entries(LANGUAGES).map(([code, name]) => html`<option value=${code} lang=${code} selected=${code === language()}>${name}</option>`)}</select></label>
      <${Theme} />
      ${live.role === "nobody" ? html`<button type="button" onClick=${askPin}>${t("sign.in")}</button>`
        : html`<button type="button" onClick=${askPin}>${t("sign.other")}</button><button type="button" onClick=${leave}>${t("sign.out")}</button>`}
    </div></div>`;
}

function Links({ name, several }) {
  const base = `/robot/${encodeURIComponent(name)}`;
  return html`<nav aria-label=${t("pages")}><ul>
    ${several && html`<li><a href="/">${t("page.wall")}</a></li>`}
    ${PAGES.map((page) => html`<li><a href=${page ? `${base}/${page}` : base}
      aria-current=${page === lumen.page ? "page" : null}>${t(`page.${page || "now"}`)}</a></li>`)}
    ${live.fleet && html`<li><a href="/fleet">${t("page.fleet")}</a></li>`}
    <li><a href="${base}/subtitles" target="_blank">${t("page.subtitles")}</a></li></ul></nav>`;
}

export function Head() {
  useRedraw();
  const names = [...live.robots.keys()], name = lumen.robot ?? (names.length === 1 ? names[0] : null);
  const robot = name === null ? null : live.robots.get(name);
  useEffect(() => {
    document.title = name ? `${name}: ${t(`page.${lumen.page || "now"}`)} · Lumen` : "Lumen";
    document.getElementById("skip").textContent = t("skip");
    document.querySelector("rest-button[main]").toggleAttribute("several", name === null && names.length > 1);
  });
  return html`<div class="who"><p class="name">${name ?? "Lumen"}</p><${Connection} robot=${robot} /></div>
    ${name !== null && live.role !== "nobody" && html`<${Links} name=${name} several=${names.length > 1} />`}
    <${Settings} /><${Resume} robot=${robot} />`;
}
