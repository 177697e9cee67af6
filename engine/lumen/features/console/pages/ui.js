// @ts-check
// What all pages build with: elements from data (text is never markup), texts, and state that lives as long as the
// page.
/** @import { Texts, Entry } from "./types" */
import { html, render, useEffect, useLayoutEffect, useRef, useState } from "./vendor/htm-preact.js";
import en from "./texts/en.js";
import indonesian from "./texts/id.js";

export { html, render, useEffect, useLayoutEffect, useRef, useState };

/** @type {Record<string, Record<string, string>>} */
const TEXTS = { en, id: indonesian };
/** @type {Set<(value: {}) => void>} */
const redraws = new Set();

export const language = () => document.documentElement.lang;
/** @type {Record<string, string>} */
export const LANGUAGES = { en: "English", id: "Bahasa Indonesia" };

/**
 * The text of that name in the page's language; {name} is filled in, and {count|robot|robots} by whether the count
 * is 1.
 * @param {string} name
 * @param {Record<string, any>} [values]
 */
export function t(name, values = {}) {
  const text = TEXTS[language()]?.[name] ?? TEXTS.en[name] ?? name;
  return text.replace(/\{(\w+)(?:\|([^|}]*)\|([^}]*))?\}/g, (all, key, one, many) =>
    one === undefined ? (values[key] ?? all) : `${values[key]}` === "1" ? one : many,
  );
}

/**
 * A map of texts by language, as YAML writes them: the page's, else the first.
 * @param {Texts | null | undefined} texts
 */
export const inLanguage = (texts) =>
  (typeof texts === "object" && texts ? (texts[language()] ?? Object.values(texts)[0]) : texts) ?? "";

/**
 * The line about an entry of the journal, in the page's language where there is one.
 * @param {Entry} entry
 */
export const lineOf = (entry) => entry.texts?.[language()] ?? entry.text;

/**
 * Keep a setting in this browser; null forgets it.
 * @param {string} key
 * @param {string | null} value
 */
export function keep(key, value) {
  try {
    if (value === null) localStorage.removeItem(key);
    else localStorage.setItem(key, value);
  } catch {
    /* a private window */
  }
}
/** @param {string} key */
export function kept(key) {
  try {
    return localStorage.getItem(key);
  } catch {
    return null;
  }
}

/** @param {string} code */
export function speak(code) {
  document.documentElement.lang = code;
  keep("lumen.language", code);
  for (const button of document.querySelectorAll("rest-button")) button.speak();
  draw(); // not in the next frame: what draws itself until then would be in another language than the rest
}

const draw = () => redraws.forEach((one) => one({}));

/** Draw everything anew, once in the next frame, whoever asks. A hidden page draws nothing and needs nothing drawn. */
let asked = false;
export function redraw() {
  if (asked) return;
  asked = true;
  requestAnimationFrame(() => {
    asked = false;
    draw();
  });
}
export function useRedraw() {
  const [, set] = useState({});
  // In the same task as the drawing: what is told between the two would be drawn with the next news only.
  useLayoutEffect(() => {
    redraws.add(set);
    return () => redraws.delete(set);
  }, []);
}

/** @param {number} digits */
const number = (digits) => ({ minimumFractionDigits: digits, maximumFractionDigits: digits });
/** @param {number | string} value */
export const fixed = (value, digits = 0) => Number(value).toLocaleString(language(), number(digits));
/** @param {number} value */
export const percent = (value) => `${fixed(value)}%`;

/**
 * What people call a language: `en` is English, or Inggris.
 * @param {string} code
 */
export function languageName(code) {
  try {
    return new Intl.DisplayNames([language()], { type: "language" }).of(code) ?? code;
  } catch {
    return code;
  }
}

/**
 * A full hour: 09:00, or 09.00.
 * @param {number} hour
 */
export const fullHour = (hour) => `${String(hour).padStart(2, "0")}${language() === "id" ? "." : ":"}00`;

/**
 * 14:03:20 where the console is looked at.
 * @param {string | null | undefined} iso
 */
export const clock = (iso, seconds = true) =>
  iso
    ? new Date(iso).toLocaleTimeString(language() === "id" ? "id-ID" : "en-GB", {
        hour: "2-digit",
        minute: "2-digit",
        ...(seconds ? { second: "2-digit" } : {}),
      })
    : "";

/**
 * 0:07, 12:31 or 3:04:05 of seconds.
 * @param {number} seconds
 */
export function span(seconds) {
  const whole = Math.max(0, Math.floor(seconds)),
    pad = (/** @type {number} */ n) => String(n).padStart(2, "0");
  const [h, m, s] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
  return h ? `${h}:${pad(m)}:${pad(s)}` : `${m}:${pad(s)}`;
}

/** Redraws each half second; used by what counts. `now` returns the time of the clock of `at` [ms since 1970]. */
export function useSeconds() {
  const [, set] = useState(0);
  useEffect(() => {
    const timer = setInterval(() => set((n) => n + 1), 500);
    return () => clearInterval(timer);
  }, []);
}
/** @param {{ at: string | null | undefined, now?: () => number }} props */
export function Since({ at, now = Date.now }) {
  useSeconds();
  return at ? html`<time datetime=${at}>${span((now() - Date.parse(at)) / 1000)}</time>` : null;
}
/** @param {{ at: string, now?: () => number }} props */
export function Until({ at, now = Date.now }) {
  useSeconds();
  return html`<time datetime=${at}>${span((Date.parse(at) - now()) / 1000 + 0.5)}</time>`;
}

/**
 * An element of shell.html.
 * @param {string} id
 */
export const byId = (id) => /** @type {HTMLElement} */ (document.getElementById(id));

let ids = 0;
export const useId = () => useRef(`e${++ids}`).current;

/**
 * A handler for a field: `use` gets the text that was typed or chosen.
 * @param {(text: string) => void} use
 */
export const typed =
  (use) =>
  (/** @type {Event} */ { target }) =>
    use(/** @type {HTMLInputElement | HTMLSelectElement} */ (target).value);

/**
 * A handler for a box: `use` gets whether it is ticked now.
 * @param {(on: boolean) => void} use
 */
export const ticked =
  (use) =>
  (/** @type {Event} */ { target }) =>
    use(/** @type {HTMLInputElement} */ (target).checked);

/**
 * A part of the page with a heading of its own.
 * @param {{ title: string, kind?: string, aside?: any, children?: any }} props
 */
export function Part({ title, kind = "", aside = null, children }) {
  const heading = useId();
  return html`<section class="part ${kind}" aria-labelledby=${heading}>
    <div class="part-head"><h2 id=${heading}>${title}</h2>${aside}</div>${children}</section>`;
}

/**
 * Controls that can be used only `when` that is so; else they are grey.
 * @param {{ when: boolean, children?: any }} props
 */
export const Usable = ({ when, children }) => html`<fieldset class="bare" disabled=${!when}>${children}</fieldset>`;

/**
 * A word about how something is: `open` or `well` is good, `warn` and `bad` are not, `kind` says only what it is.
 * @param {{ state?: string, children?: any }} props
 */
export const Badge = ({ state, children }) => html`<span class="badge" data-state=${state}>${children}</span>`;

/**
 * A list from which one is chosen: `options` are values, each with its text, and with the language of the text if that
 * is not the page's. Other attributes are those of `select`.
 * @typedef {[value: string, text: string, language?: string][]} Options
 * @typedef {{ value: string, options: Options, choose: (value: string) => void, field?: any }} Choosing
 * @param {Choosing & Record<string, any>} props
 */
export const Select = ({ value, options, choose, field = null, ...more }) => html`<select ...${more} ref=${field}
  value=${value} onChange=${typed(choose)}>${options.map(
    ([one, text, lang]) => html`<option value=${one} lang=${lang} selected=${one === value}>${text}</option>`,
  )}</select>`;

/**
 * A few options beside each other; `titled` if the legend is seen, which a screen reader reads in any case.
 * @param {{ legend: string, name: string, titled?: boolean } & Choosing} props
 */
export const Choice = ({ legend, name, titled = true, value, options, choose }) => html`<fieldset class="choice">
  <legend class=${titled ? "" : "hidden"}>${legend}</legend>${options.map(
    ([one, text]) => html`<label><input type="radio" name=${name} value=${one} checked=${one === value}
      onChange=${() => choose(one)} /><span>${text}</span></label>`,
  )}</fieldset>`;

/**
 * A dialog that is open as long as it is drawn; Escape and the button close it. Not modal: Rest stays in reach above
 * it.
 * @param {{ title: string, onClose: () => void, children?: any, actions?: any }} props
 */
export function Dialog({ title, onClose, children, actions = null }) {
  const box = useRef(/** @type {HTMLDialogElement | null} */ (null)),
    heading = useId();
  // In the same frame as the dialog: keys reach it, and Escape closes it, as soon as it is seen.
  useLayoutEffect(() => {
    const before = document.activeElement,
      field = /** @type {HTMLElement | null | undefined} */ (box.current?.querySelector("[autofocus]"));
    (field ?? box.current)?.focus();
    return () => {
      if (before instanceof HTMLElement) before.focus();
    };
  }, []);
  useLayoutEffect(() => {
    const pressed = (/** @type {KeyboardEvent} */ event) => {
      if (event.key === "Escape" && !event.repeat) onClose();
    };
    addEventListener("keydown", pressed);
    return () => removeEventListener("keydown", pressed);
  });
  return html`<div class="scrim" onClick=${onClose}></div>
    <dialog open ref=${box} tabindex="-1" aria-labelledby=${heading}><h2 id=${heading}>${title}</h2>${children}
      <div class="actions">${actions}<button type="button"
        onClick=${onClose}>${t(actions ? "cancel" : "close")}</button></div></dialog>`;
}

/**
 * A question before something is done: the button `label` does it, another one closes the question.
 * @param {{ title: string, label: string, onYes: () => void, onClose: () => void, children?: any }} props
 */
export function Ask({ title, label, onYes, onClose, children }) {
  const yes = () => {
    onClose();
    onYes();
  };
  const button = html`<button type="button" class="strong" onClick=${yes}>${label}</button>`;
  return html`<${Dialog} title=${title} onClose=${onClose} actions=${button}>${children}</${Dialog}>`;
}

/**
 * `behaviors/tour.yaml:205`, short enough to stand beside something.
 * @param {string | null | undefined} file
 * @param {number | null | undefined} line
 */
export const place = (file, line) => (file ? `${file}${line ? `:${line}` : ""}` : "");
