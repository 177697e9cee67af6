// @ts-check
// What visitors said, and which row of `hears` took it; an author says which one should have, and it becomes a saying.
/** @import { Heard } from "../types" */
import { post } from "../live.js";
import { Quote, reasonOf } from "../quoted.js";
import { may } from "../session.js";
import { Select, fixed, html, languageName, t, useEffect, useRef, useState, typed } from "../ui.js";

/**
 * The rows that could have taken a sentence, as the values of a choice.
 * @param {Heard} one
 * @param {Record<string, string[]>} rows
 */
const choices = (one, rows) =>
  one.states.flatMap(([behavior, state]) =>
    (rows[`${behavior} ${state}`] ?? []).map((row) => ({ behavior, state, row })),
  );

/** @param {{ name: string, one: Heard, rows: Record<string, string[]>, saved: (file: string) => void }} props */
function Row({ name, one, rows, saved }) {
  const could = choices(one, rows),
    several = one.states.length > 1;
  const options = could.map(({ state, row }, n) => [`${n}`, several ? `${row} (${state})` : row]);
  const [open, setOpen] = useState(false),
    [text, setText] = useState(one.text),
    [chosen, choose] = useState(""),
    [busy, wait] = useState(false),
    [wrong, complain] = useState("");
  const field = useRef(/** @type {HTMLSelectElement | null} */ (null));
  const states = one.states.map(([, state]) => state).join(", ");
  const about = [states, one.row || t("day.said.none"), languageName(one.language), `${fixed(one.count)}×`];
  useEffect(() => field.current?.focus(), [open]);
  const save = async (/** @type {SubmitEvent} */ submitted) => {
    submitted.preventDefault();
    wait(true);
    complain("");
    try {
      const body = { robot: name, ...could[Number(chosen)], language: one.language, text };
      saved((await post("/api/sayings", body)).file);
      return;
    } catch (error) {
      complain(reasonOf(error));
    }
    wait(false);
  };
  return html`<li><span>${one.text}</span> <span
    class="quiet">${about.join(" · ")}</span>
    ${
      may("author") &&
      html`<button type="button" aria-expanded=${open}
      onClick=${() => setOpen(!open)}>${t("day.said.should")}</button>`
    }
    ${
      open &&
      html`<form class="cue" onSubmit=${save}><label><span>${t("day.said.row")}</span>
        <${Select} field=${field} value=${chosen} choose=${choose} required options=${[["", ""], ...options]} /></label>
      <label class="grow"><span>${t("day.said.text")} (${languageName(one.language)})</span>
        <input value=${text} onInput=${typed(setText)} maxlength="1000" required autocomplete="off" />
        </label>
      <button class="strong" disabled=${busy}>${t("day.passage.save")}</button></form>`
    }
    <p class="bad" role="alert"><${Quote} text=${wrong} /></p></li>`;
}

/** @param {{ name: string, said: Heard[], rows: Record<string, string[]> }} props */
export function Said({ name, said, rows }) {
  const [files, tell] = useState(/** @type {Record<string, string>} */ ({})),
    key = (/** @type {Heard} */ one) => JSON.stringify([one.language, one.text, one.states]);
  const left = said.filter((one) => !files[key(one)]),
    file = Object.values(files).at(-1);
  return (
    (said.length > 0 || file) &&
    html`<section class="said"><h3>${t("day.said")}</h3>
    ${
      left.length > 0 &&
      html`<ul class="plain-list bounded" tabindex="0"
      aria-label=${t("day.said")}>${left.map(
        (one) => html`<${Row} key=${key(one) + one.row} name=${name} one=${one}
      rows=${rows} saved=${(/** @type {string} */ path) => tell((before) => ({ ...before, [key(one)]: path }))} />`,
      )}</ul>`
    }
    <p role="status">${file ? t("day.passage.saved", { file }) : ""}</p></section>`
  );
}
