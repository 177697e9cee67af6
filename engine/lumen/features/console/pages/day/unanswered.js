// @ts-check
// What visitors asked and nobody could answer; each becomes a passage of knowledge/, in the languages of the project.
/** @import { Unanswered as Question } from "../types" */
import { post, robotOf } from "../live.js";
import { Quote, reasonOf } from "../quoted.js";
import { may } from "../session.js";
import { fixed, html, languageName, t, useEffect, useRef, useState, typed } from "../ui.js";

const LIMIT = 15000; // [ms]

/**
 * A question and its answer, as far as they are typed.
 * @typedef {{ question?: string, answer?: string }} Texts
 */

/**
 * The question and the answer in one language; the visitor asked in `own`, so there is a question in that one.
 * @param {{ code: string, own: boolean, texts: Texts, write: (texts: Texts) => void, first?: any }} props
 */
function Pair({ code, own, texts, write, first = null }) {
  const name = languageName(code),
    field = (/** @type {"question" | "answer"} */ what, /** @type {any} */ ref) => html`<label class="grow">
    <span>${t(`day.passage.${what}`)} (${name})</span><input ref=${ref} lang=${code} value=${texts[what] ?? ""}
      maxlength="1000"
      required=${own || Boolean(texts.question || texts.answer)} autocomplete="off"
      onInput=${typed((text) => write({ ...texts, [what]: text }))} /></label>`;
  return html`${!own && field("question", null)}${field("answer", first)}`;
}

/** @param {{ name: string, one: Question, saved: (file: string) => void }} props */
function Row({ name, one, saved }) {
  const [open, setOpen] = useState(false),
    [busy, wait] = useState(false),
    [wrong, complain] = useState("");
  const [texts, write] = useState(/** @type {Record<string, Texts>} */ ({ [one.language]: { question: one.text } })),
    field = useRef(/** @type {HTMLInputElement | null} */ (null));
  useEffect(() => field.current?.focus(), [open]);
  const languages = [one.language, ...(robotOf(name)?.languages ?? []).filter((code) => code !== one.language)];
  const save = async (/** @type {SubmitEvent} */ submitted) => {
    submitted.preventDefault();
    wait(true);
    complain("");
    const { [one.language]: own, ...others } = texts;
    const also = Object.fromEntries(Object.entries(others).filter(([, pair]) => pair.question || pair.answer));
    try {
      const body = { robot: name, ...own, language: one.language, also };
      saved((await post("/api/passages", body, LIMIT)).file);
      return;
    } catch (error) {
      complain(reasonOf(error));
    }
    wait(false);
  };
  return html`<li><span>${one.text}</span> <span
    class="quiet">${languageName(one.language)} · ${fixed(one.count)}×</span>
    ${
      may("author") &&
      html`<button type="button" aria-expanded=${open}
      onClick=${() => setOpen(!open)}>${t("day.passage")}</button>`
    }
    ${
      open &&
      html`<form class="cue" onSubmit=${save}>${languages.map(
        (code, n) => html`
        <${Pair} key=${code} code=${code} own=${n === 0} texts=${texts[code] ?? {}}
          write=${(/** @type {Texts} */ pair) => write({ ...texts, [code]: pair })} first=${n === 0 ? field : null} />`,
      )}
      ${languages.length > 1 && html`<p class="quiet">${t("day.passage.more")}</p>`}
      <button class="strong" disabled=${busy}>${t("day.passage.save")}</button></form>`
    }
    <p class="bad" role="alert"><${Quote} text=${wrong} /></p></li>`;
}

/** @param {{ name: string, rows: Question[] }} props */
export function Unanswered({ name, rows }) {
  const [files, tell] = useState(/** @type {Record<string, string>} */ ({})),
    key = (/** @type {Question} */ one) => `${one.language} ${one.text}`;
  const left = rows.filter((one) => !files[key(one)]),
    file = Object.values(files).at(-1);
  return html`<section class="unanswered"><h3>${t("day.unanswered")}</h3>${
    left.length === 0
      ? html`<p class="quiet">${t("day.none.numbers")}</p>`
      : html`<ul class="plain-list">${left.map(
          (one) => html`<${Row} key=${key(one)} name=${name} one=${one}
        saved=${(/** @type {string} */ path) => tell((before) => ({ ...before, [key(one)]: path }))} />`,
        )}</ul>`
  }
    <p role="status">${file ? t("day.passage.saved", { file }) : ""}</p></section>`;
}
