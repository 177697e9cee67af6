// @ts-check
// Edit this sentence: where something that the robot said is written, and a new wording of it in all languages.
/** @import { Data, Entry, FoundSentence, Reworded, SentencePlace } from "./types" */
import { JOB, get, post } from "./live.js";
import { InEnglish, Quote, reasonOf } from "./quoted.js";
import { may } from "./session.js";
import { Badge, Dialog, Select, html, languageName, place, t, typed, useEffect, useRef, useState } from "./ui.js";

/**
 * A sentence of the robot: the position of its entry in the journal, and the id of its command, empty for a sentence
 * that an operator typed.
 * @typedef {{ position: number, id: string, text: string }} Sentence
 */

/**
 * What was saved, with the texts before it and what named the place.
 * @typedef {Reworded & { before: Record<string, string>, body: Data }} Written
 */

const LEVELS = { error: "bad", warning: "warn", info: "kind" };
const TYPED = /^says “([^]*)”, /; // the note of the console about a sentence that an operator typed

/**
 * @param {Data} body
 * @returns {Promise<Reworded>}
 */
const reworded = (body) => post("/api/sentence", body);

/**
 * The sentences of an entry of the journal, each with the id of its command; that of an operator has none.
 * @param {Entry} entry
 * @returns {Sentence[]}
 */
export function sentencesOf(entry) {
  const begun = (entry.commands ?? []).map((one) => one.Start).filter((one) => one?.command?.Say);
  const said = begun.map((one) => ({ position: entry.position, id: one.id, text: one.command.Say.text }));
  const note = entry.kind === "person" && TYPED.exec(entry.text);
  return note ? [{ position: entry.position, id: "", text: note[1] }] : said;
}

/**
 * What of a text differs from before: as before, and as it will be.
 * @param {{ was: string, now: string }} props
 */
function Change({ was, now }) {
  return html`<p>− <del>${was}</del></p><p>+ <ins>${now}</ins></p>`;
}

/** @param {{ check: Reworded }} props */
function Check({ check }) {
  return html`<div class="diff check">
    ${check.changes.map(
      (one) => html`<div key=${one.language}><p class="quiet">${one.language ? languageName(one.language) : ""}</p>
      <${Change} ...${one} /></div>`,
    )}
    ${check.changes.length === 0 && html`<p>${t("sentence.same")}</p>`}
    ${check.findings.length > 0 && html`<${InEnglish} />`}
    ${check.findings.map(
      (one) => html`<p><${Badge} state=${LEVELS[one.severity]}>${t(`severity.${one.severity}`)}</${Badge}>
      ${" "}<span class="place">${place(one.file, one.line)}</span> <span lang="en">${one.message}</span></p>`,
    )}
    ${check.changes.length > 0 && check.findings.length === 0 && html`<p>${t("files.findings.none")}</p>`}
    ${
      check.stories.length > 0 &&
      html`<p>${t("sentence.stories")} <span class="place">${check.stories.join(", ")}</span></p>`
    }
  </div>`;
}

/**
 * The texts of one place, by language: checked first, then saved; what was saved can be undone.
 * @param {{ name: string, at: SentencePlace, saved: (written: Written) => void }} props
 */
function Wording({ name, at, saved }) {
  const [texts, write] = useState(at.texts),
    [check, show] = useState(/** @type {Reworded | null} */ (null)),
    [wrong, complain] = useState(""),
    [busy, wait] = useState(false),
    first = useRef(/** @type {HTMLTextAreaElement | null} */ (null));
  useEffect(() => first.current?.focus(), []);
  const body = { robot: name, file: at.file, around: at.around, alternative: at.alternative, version: at.version };
  const send = async (/** @type {SubmitEvent} */ submitted) => {
    submitted.preventDefault();
    wait(true);
    complain("");
    try {
      const checked = await reworded({ ...body, texts, write: check !== null });
      if (checked.written) {
        saved({ ...checked, before: at.texts, body });
        return;
      }
      show(checked);
    } catch (error) {
      complain(reasonOf(error));
    }
    wait(false);
  };
  const ready = check && !check.faulty && check.changes.length > 0;
  const change = (/** @type {string} */ code, /** @type {string} */ text) => {
    write({ ...texts, [code]: text });
    show(null);
  };
  return html`<form class="fields sentence" onSubmit=${send}>
    ${Object.entries(texts).map(
      ([code, text], n) => html`<label key=${code}>${code ? languageName(code) : t("sentence.text")}
      <textarea ref=${n === 0 ? first : null} rows="2" maxlength="1000" lang=${code || null} value=${text}
        onInput=${typed((now) => change(code, now))}></textarea></label>`,
    )}
    <p class="quiet">${t("sentence.holes")}</p>
    ${check && html`<${Check} check=${check} />`}
    <p role="status">${busy ? t("loading") : ""}</p>
    <p class="bad" role="alert"><${Quote} text=${wrong} /></p>
    <button class="strong" disabled=${busy || (check !== null && !ready)}>
      ${t(ready ? "day.passage.save" : "sentence.check")}</button></form>`;
}

/**
 * What was saved, with a way back: the old texts are written again.
 * @param {{ name: string, was: Written, undone: (written: Reworded) => void }} props
 */
function Saved({ name, was, undone }) {
  const [wrong, complain] = useState(""),
    [busy, wait] = useState(false);
  const undo = async () => {
    wait(true);
    complain("");
    const changed = was.changes.filter((one) => one.was).map((one) => [one.language, was.before[one.language]]);
    try {
      undone(await reworded({ ...was.body, version: was.version, texts: Object.fromEntries(changed), write: true }));
    } catch (error) {
      complain(reasonOf(error));
    }
    wait(false);
  };
  const back = was.changes.every((one) => one.was); // a text that was added is taken out in the file
  return html`<p role="status">${t("day.passage.saved", { file: place(was.file, was.line) })}</p>
    <p>${t("sentence.active")} <a href="/robot/${encodeURIComponent(name)}/files">${t("page.files")}</a></p>
    <p class="bad" role="alert"><${Quote} text=${wrong} /></p>
    ${
      back && html`<button type="button" class="undo" disabled=${busy} onClick=${undo}>${t("sentence.undo")}</button>`
    }`;
}

/** @type {Record<string, string>} */
const NOWHERE = { operator: "sentence.operator", model: "sentence.model", nowhere: "sentence.nowhere" };

/** @param {{ name: string, found: FoundSentence }} props */
function Places({ name, found }) {
  const [chosen, choose] = useState(0),
    [was, save] = useState(/** @type {Written | null} */ (null)),
    [undone, undo] = useState(false);
  const at = found.places[chosen];
  if (!at) return html`<p>${t(NOWHERE[found.source] ?? "sentence.nowhere")}</p>`;
  if (undone) return html`<p role="status">${t("sentence.undone")}</p>`;
  if (was) return html`<${Saved} name=${name} was=${was} undone=${() => undo(true)} />`;
  return html`${
    found.places.length > 1 &&
    html`<label class="fields">${t("sentence.several")}
    <${Select} value=${`${chosen}`} choose=${(/** @type {string} */ one) => choose(Number(one))}
      options=${found.places.map((one, n) => [`${n}`, place(one.file, one.line)])} /></label>`
  }
    <p>${t(at.file.startsWith("knowledge/") ? "sentence.passage" : "sentence.at")} <b
      class="place">${place(at.file, at.line)}</b></p>
    ${
      at.editable
        ? html`<${Wording} key=${chosen} name=${name} at=${at} saved=${save} />`
        : html`<p>${t("sentence.markdown")}</p>`
    }`;
}

/** @param {{ name: string, sentence: Sentence, onClose: () => void }} props */
export function SentenceDialog({ name, sentence, onClose }) {
  const [found, set] = useState(/** @type {FoundSentence | null} */ (null)),
    [failed, fail] = useState("");
  useEffect(() => {
    get("/api/sentence", { robot: name, position: sentence.position, id: sentence.id }, JOB).then(set, (error) =>
      fail(reasonOf(error)),
    );
  }, []);
  return html`<${Dialog} title=${t("sentence.of", { text: sentence.text })} onClose=${onClose}>
    ${failed && html`<p class="bad" role="alert"><${Quote} text=${failed} /></p>`}
    ${!found && !failed && html`<p role="status">${t("loading")}</p>`}
    ${found && html`<${Places} name=${name} found=${found} />`}</${Dialog}>`;
}

/**
 * A button for each sentence of an entry, for authors; `edit(sentence)` opens its dialog.
 * @param {{ entry: Entry, edit: (sentence: Sentence) => void }} props
 */
export function EditButtons({ entry, edit }) {
  const sentences = may("author") ? sentencesOf(entry) : [];
  return sentences.map(
    (one) => html`<button type="button" class="edit-sentence" key=${one.id} onClick=${() => edit(one)}>
    ${sentences.length > 1 ? t("sentence.of", { text: one.text }) : t("sentence.edit")}</button>`,
  );
}
