// What visitors asked and nobody could answer; each becomes a passage of knowledge/ with one edit.
import { may } from "../session.js";
import { fixed, html, t, useEffect, useRef, useState } from "../ui.js";

function Row({ name, one }) {
  const [open, setOpen] = useState(false), [answer, setAnswer] = useState(""), [busy, wait] = useState(false), [file, tell] = useState(""), [wrong, complain] = useState("");
  const field = useRef(null);
  useEffect(() => field.current?.focus(), [open]);
  const save = async (submitted) => {
    submitted.preventDefault();
    wait(true), complain("");
    try {
      const body = JSON.stringify({ robot: name, question: one.text, language: one.language, answer });
      const sent = await fetch("/api/passages", { method: "POST", headers: { "Content-Type": "application/json" }, body, signal: AbortSignal.timeout(15000) });
      const said = await sent.json().catch(() => ({}));
      sent.ok ? tell(said.file) : complain(said.reason ?? `${sent.status}`);
    } catch (error) { complain(error.message); }
    wait(false);
  };
  return html`<li><span>${one.text}</span> <span class="quiet">${one.language} · ${fixed(one.count)}×</span>
    ${file ? html`<span role="status">${t("day.passage.saved", { file })}</span>` : may("author") && html`<button type="button" aria-expanded=${open} onClick=${() => setOpen(!open)}>${t("day.passage")}</button>`}
    ${open && !file && html`<form class="cue" onSubmit=${save}><label class="grow"><span>${t("day.passage.answer")} (${one.language})</span>
      <input ref=${field} value=${answer} onInput=${(e) => setAnswer(e.target.value)} maxlength="1000" required autocomplete="off" /></label><button class="strong" disabled=${busy}>${t("day.passage.save")}</button></form>`}
    <p class="bad" role="alert">${wrong}</p></li>`;
}

export function Unanswered({ name, rows }) {
  return html`<section class="unanswered"><h3>${t("day.unanswered")}</h3>${rows.length === 0 ? html`<p class="quiet">${t("day.none.numbers")}</p>`
    : html`<ul class="plain-list">${rows.map((one) => html`<${Row} key=${`${one.language} ${one.text}`} name=${name} one=${one} />`)}</ul>`}</section>`;
}
