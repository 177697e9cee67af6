// @ts-check
// Find a moment of the day: by its time, or by words that a visitor or the robot said.
/** @import { Entry as Written, Entries, Stretch } from "../types" */
import { JOB, get } from "../live.js";
import { Entry } from "../now/entries.js";
import { Quote, reasonOf } from "../quoted.js";
import { Part, html, t, useState, typed } from "../ui.js";

const TIME = /^\s*([01]?\d|2[0-3])[:.]([0-5]\d)(?:[:.]([0-5]\d))?\s*$/;

/**
 * A time of day, such as 14:03 or 14.03.20, on a date: the moment [ms since 1970], and whether it is a whole minute;
 * null if the text is none.
 * @param {string} date
 * @param {string} text
 */
export function momentOf(date, text) {
  const [found, hour, minute, second] = TIME.exec(text) ?? [];
  const at = () => Date.parse(`${date}T${hour.padStart(2, "0")}:${minute}:${second ?? "00"}`);
  return found ? { at: at(), minute: second === undefined } : null;
}

/**
 * `scrub(at, minute)` looks at a moment [ms since 1970] or, with `minute`, at a whole minute.
 * @typedef {{ scrub: (at: number, minute?: boolean) => void }} Scrubs
 * @param {{ date: string } & Scrubs} props
 */
function GoTo({ date, scrub }) {
  const [text, write] = useState(""),
    [wrong, complain] = useState("");
  const go = (/** @type {SubmitEvent} */ submitted) => {
    submitted.preventDefault();
    const found = momentOf(date, text);
    complain(found ? "" : t("find.time.wrong"));
    if (found) scrub(found.at, found.minute);
  };
  return html`<form class="go-to" onSubmit=${go}>
    <label><span>${t("find.time")}</span><input value=${text} placeholder="14:03" size="8" maxlength="8"
      autocomplete="off" onInput=${typed(write)} /></label>
    <button>${t("find.time.go")}</button><p class="bad" role="alert">${wrong}</p></form>`;
}

/** @param {{ name: string, first: number, last: number, open: (entry: Written) => void }} props */
function Search({ name, first, last, open }) {
  const [text, write] = useState(""),
    [found, show] = useState(/** @type {Entries | null} */ (null)),
    [wrong, complain] = useState("");
  const search = async (/** @type {SubmitEvent} */ submitted) => {
    submitted.preventDefault();
    complain("");
    if (!text.trim()) {
      show(null);
      return;
    }
    try {
      show(await get("/api/search", { robot: name, from: first, to: last, text }, JOB));
    } catch (error) {
      complain(reasonOf(error));
    }
  };
  const told = (/** @type {Entries} */ { entries, more }) =>
    t(more ? "find.more" : "find.count", { n: entries.length });
  return html`<form class="search" role="search" onSubmit=${search}>
      <label class="grow"><span>${t("find.text")}</span><input type="search" value=${text} maxlength="200"
        autocomplete="off" onInput=${typed(write)} /></label>
      <button>${t("find.text.go")}</button></form>
    <p role="status">${found ? told(found) : ""}</p><p class="bad" role="alert"><${Quote} text=${wrong} /></p>
    ${
      found &&
      found.entries.length > 0 &&
      html`<ol class="entry-list bounded found" tabindex="0" aria-label=${t("find")}>
      ${found.entries.map((entry) => html`<${Entry} key=${entry.position} entry=${entry} onOpen=${open} />`)}</ol>`
    }`;
}

/**
 * `open(entry)` looks at an entry; `parts` are the stretches of the day.
 * @param {{ name: string, date: string, parts: Stretch[], open: (entry: Written) => void } & Scrubs} props
 */
export function Find({ name, date, parts, scrub, open }) {
  return html`<${Part} title=${t("find")} kind="find"><${GoTo} date=${date} scrub=${scrub} />
    ${
      parts.length > 0 &&
      html`<${Search} key=${date} name=${name} first=${parts[0].from}
      last=${Math.max(...parts.map((one) => one.to))} open=${open} />`
    }</${Part}>`;
}
