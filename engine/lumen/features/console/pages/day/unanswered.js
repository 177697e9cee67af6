// What visitors asked and nobody could answer; each becomes a passage of knowledge/ with one edit.
import { Quote, reasonOf } from "../quoted.js";
import { may } from "../session.js";
import { fixed, html, languageName, t, useEffect, useRef, useState } from "../ui.js";

function Row({ name, one, saved }) {
  const [open, setOpen] = useState(false), [answer, setAnswer] = useState(""), [busy, wait] = useState(false), [wrong, complain] = useState("");
  const field = useRef(null);
  useEffect(() => field.current?.focus(), [open]);
  const save = async (submitted) => {
    submitted.preventDefault();
    wait(true), complain("");
    try {
      const body = JSON.stringify({ robot: name, question: one.text, language: one.language, answer });
      const sent = await fetch("/api/passages", { method: "POST", headers: { "Content-Type": "application/json" }, body, signal: AbortSignal.timeout(15000) });
      const said = await sent.json().catch(() => ({}));
      if (sent.ok) return saved(said.file);
      complain(said.reason ?? `${sent.status}`);
    } catch (error) { complain(reasonOf(error)); }
    wait(false);
  };
  return html`<li><span>${one.text}</span> <span class="quiet">${languageName(one.language)} · ${fixed(one.count)}×</span>
    ${may("author") && html`<button type="button" aria-expanded=${open} onClick=${() => setOpen(!open)}>${t("day.passage")}</button>`}
    ${open && html`<form class="cue" onSubmit=${save}><label class="grow"><span>${t("day.passage.answer")} (${languageName(one.language)})</span>
      <input ref=${field} value=${answer} onInput=${(e) => setAnswer(e.target.value)} maxlength="1000" required autocomplete="off" /></label><button class="strong" disabled=${busy}>${t("day.passage.save")}</button></form>`}
    <p class="bad" role="alert"><${Quote} text=${wrong} /></p></li>`;
}

export function Unanswered({ name, rows }) {
  const [files, tell] = useState({}), key = (one) => `${one.language} ${one.text}`;
  const left = rows.filter((one) => !files[key(one)]), file = Object.values(files).at(-1);
  return html`<section class="unanswered"><h3>${t("day.unanswered")}</h3>${left.length === 0 ? html`<p class="quiet">${t("day.none.numbers")}</p>`
    : html`<ul class="plain-list">${left.map((one) => html`<${Row} key=${key(one)} name=${name} one=${one} saved=${(file) => tell((before) => ({ ...before, [key(one)]: file }))} />`)}</ul>`}
    <p role="status">${file ? t("day.passage.saved", { file }) : ""}</p></section>`;
}
