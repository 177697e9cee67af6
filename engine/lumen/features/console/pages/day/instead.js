// @ts-check
// What happens instead, for a fork: nothing else, other words of the visitor, or an event with its values.
import { robotOf } from "../live.js";
import { Select, html, languageName, t, typed } from "../ui.js";

/**
 * What is filled in: `kind` is `same`, `says` or `event`; the others belong to `says` or `event`.
 * @typedef {{ name: string, value: string }} Value
 * @typedef {{ kind: string, words: string, language: string, event: string, values: Value[] }} Filled
 * @typedef {(changes: Partial<Filled>) => void} Write
 */

/**
 * Of a form that nobody has filled in; `says` is what the visitor said then.
 * @param {string | null} [says]
 * @param {string} [language]
 * @returns {Filled}
 */
export const blank = (says = null, language = "") => ({
  kind: says === null ? "same" : "says",
  words: says ?? "",
  language,
  event: "",
  values: [{ name: "", value: "" }],
});

/**
 * A value as it is typed: a number, true or false, else a text.
 * @param {string} text
 */
function valueIn(text) {
  const trimmed = text.trim();
  if (/^-?\d+(\.\d+)?$/.test(trimmed)) return Number(trimmed);
  return trimmed === "true" || (trimmed === "false" ? false : trimmed);
}

/**
 * The event that a filled in form means, as `POST /api/fork` reads it; null for the same as then.
 * @param {Filled} form
 */
export function eventOf({ kind, words, language, event, values }) {
  if (kind === "says") return { name: "heard", data: { result: words.trim(), ...(language ? { language } : {}) } };
  if (kind === "same" || !event.trim()) return null;
  const named = values.filter((one) => one.name.trim()).map((one) => [one.name.trim(), valueIn(one.value)]);
  return { name: event.trim(), data: Object.fromEntries(named) };
}

/** @param {{ languages: string[], form: Filled, write: Write }} props */
function Words({ languages, form, write }) {
  const spoken = form.language || languages[0];
  return html`<label class="grow"><span>${t("fork.words")}</span>
      <input class="words" value=${form.words} maxlength="500" required autocomplete="off" lang=${spoken}
        onInput=${typed((text) => write({ words: text, language: spoken }))} /></label>
    ${
      languages.length > 1 &&
      html`<label><span>${t("language")}</span>
      <${Select} value=${spoken} choose=${(/** @type {string} */ one) => write({ language: one })}
        options=${languages.map((one) => [one, languageName(one)])} /></label>`
    }`;
}

/** @param {{ values: Value[], write: Write }} props */
function Values({ values, write }) {
  const change = (/** @type {number} */ at, /** @type {Partial<Value>} */ more) =>
    write({ values: values.map((one, n) => (n === at ? { ...one, ...more } : one)) });
  return html`<ul class="plain-list event-values">${values.map(
    (one, n) => html`<li key=${n}>
      <label><span>${t("fork.value.name")}</span><input class="value-name" value=${one.name} autocomplete="off"
        spellcheck=${false} onInput=${typed((text) => change(n, { name: text }))} /></label>
      <label><span>${t("fork.value")}</span><input class="value" value=${one.value} autocomplete="off"
        onInput=${typed((text) => change(n, { value: text }))} /></label></li>`,
  )}</ul>
    <button type="button" onClick=${() => write({ values: [...values, { name: "", value: "" }] })}>
      ${t("fork.value.add")}</button>`;
}

/** @param {{ events: string[], form: Filled, write: Write }} props */
function Other({ events, form, write }) {
  return html`<label class="grow"><span>${t("fork.name")}</span><input list="fork-events" value=${form.event} required
      autocomplete="off" spellcheck=${false} onInput=${typed((text) => write({ event: text }))} /></label>
    <datalist id="fork-events">${events.map((one) => html`<option value=${one} />`)}</datalist>
    <${Values} values=${form.values} write=${write} />`;
}

/**
 * `form` is as `blank` makes it; `write(changes)` changes some of it.
 * @param {{ name: string, form: Filled, write: Write }} props
 */
export function Instead({ name, form, write }) {
  const robot = robotOf(name),
    languages = robot?.languages?.length ? robot.languages : [robot?.language ?? "en"];
  return html`<label><span>${t("fork.instead")}</span>
      <${Select} class="instead" value=${form.kind} choose=${(/** @type {string} */ kind) => write({ kind })}
        options=${["same", "says", "event"].map((one) => [one, t(`fork.${one}`)])} /></label>
    ${form.kind === "says" && html`<${Words} languages=${languages} form=${form} write=${write} />`}
    ${form.kind === "event" && html`<${Other} events=${robot?.events ?? []} form=${form} write=${write} />`}`;
}
