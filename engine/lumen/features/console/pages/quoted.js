// @ts-check
// Sentences of the console and the engine, which send English: in the page's language if their phrase is known, else
// marked as English.
import en from "./texts/en.js";
import indonesian from "./texts/phrases_id.js";
import { html, language, t } from "./ui.js";

const PLACE = /\{(\d)([#_]?)\}/g;
/** @type {Record<string, string>} */
const KINDS = { "": "(.*?)", "#": "([\\d.,]+)", _: "(\\S+)" };
const SENTENCES = new Map(
  Object.entries(en)
    .filter(([, text]) => text.split(" ").length > 3)
    .map(([key, text]) => [text, key]),
);
/** @param {string} text */
const literal = (text) => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");

/** @param {string} english */
function pattern(english) {
  const between = english.split(/\{\d[#_]?\}/).map(literal),
    kinds = [...english.matchAll(PLACE)].map(([, , kind]) => KINDS[kind]);
  return new RegExp(`^${between.map((text, n) => text + (kinds[n] ?? "")).join("")}$`, "s");
}
/** @type {Record<string, [RegExp, string][]>} */
const PHRASES = { id: indonesian.map(([english, other]) => [pattern(english), other]) };

/**
 * A sentence that came in English, in the page's language; null if its phrase is not known.
 * @param {string} text
 * @returns {string | null}
 */
export function translated(text) {
  if (language() === "en") return text;
  const key = SENTENCES.get(text);
  if (key !== undefined) return t(key);
  for (const [phrase, other] of PHRASES[language()] ?? []) {
    const found = phrase.exec(text);
    if (found) return other.replace(/\{(\d)\}/g, (_, n) => inPageLanguage(found[Number(n) + 1]));
  }
  return null;
}

/**
 * The same; the English where its phrase is not known.
 * @param {string} text
 */
export const inPageLanguage = (text) => (typeof text === "string" ? (translated(text) ?? text) : text);
globalThis.lumen.inPageLanguage = inPageLanguage; // for rest.js, which needs nothing else of the page

/**
 * A sentence of the console or the engine; English is marked as such, and `named` as English for people, too.
 * @param {{ text: string | null | undefined, named?: boolean }} props
 */
export function Quote({ text, named = true }) {
  const other = text ? translated(`${text}`) : "";
  if (other !== null) return other;
  return html`<span lang="en">${text}</span>${named && html` <span class="quiet">(${t("quoted")})</span>`}`;
}

/** A line above several quotes that stay English; nothing on an English page. */
export const InEnglish = () => (language() === "en" ? null : html`<p class="quiet">${t("quoted.part")}</p>`);

/**
 * Why a request failed, as a sentence in English: what the console says, else that it does not answer.
 * @param {any} error
 * @returns {string}
 */
export const reasonOf = (error) =>
  error instanceof TypeError || error.name === "TimeoutError" ? en["server.away"] : error.message;
