// @ts-check
// The day: a time line to go along, visit by visit, with what happened, its why, its numbers, and what would have been.
/** @import { Day, Entry as Written, Entries, Stretch, Visit } from "../types" */
/** @import { Sentence } from "../sentence.js" */
import { command } from "../commands.js";
import { JOB, get, listen, live } from "../live.js";
import { Entry, Why, question } from "../now/entries.js";
import { Quote, reasonOf } from "../quoted.js";
import { EditButtons, SentenceDialog } from "../sentence.js";
import { may } from "../session.js";
import {
  Part,
  Select,
  clock,
  html,
  languageName,
  lineOf,
  span,
  t,
  useEffect,
  useRedraw,
  useRef,
  useState,
} from "../ui.js";
import { Find } from "./find.js";
import { Fork, speechOf } from "./fork.js";
import { Line, bounds, stretches } from "./line.js";
import { Numbers, Totals } from "./numbers.js";
import { KeepStory } from "./story.js";

const AROUND = 40; // entries that are shown around a moment
const MINUTE = 60000; // [ms]
const SOON = 500,
  AGAIN = 15000; // [ms] after what happened last, and between two looks at the day: a look is dear

/** @param {{ day: Day, visit: Stretch | null, choose: (visit: Visit) => void }} props */
function Visits({ day, visit, choose }) {
  return html`<${Part} title=${t("day.visits")} kind="visits">
    ${
      day.visits.length
        ? html`<ol class="visit-list bounded" reversed tabindex="0" aria-label=${t("day.visits")}>${[...day.visits]
            .reverse()
            .map(
              (one) => html`<li key=${one.from}>
      <button type="button" aria-current=${one.from === visit?.from ? "true" : null} onClick=${() => choose(one)}>
        <b>${t("day.visit", { n: one.n })}</b> <time datetime=${one.began}>${clock(one.began, false)}</time>
        <span>${span(one.seconds ?? 0)}</span><span class="grow">${one.visitor ?? ""}</span>
          <span class="quiet">${one.language ? languageName(one.language) : ""}</span></button></li>`,
            )}</ol>`
        : html`<p class="quiet">${t("day.none")}</p>`
    }</${Part}>`;
}

/**
 * Those of a visit's entries that are nearest to a moment, in their order.
 * @param {Written[]} entries
 * @param {number} moment
 */
function nearest(entries, moment) {
  const shown = entries.filter((entry) => entry.text);
  const middle = shown.findLastIndex((entry) => Date.parse(entry.at_time) <= moment) + 1;
  return shown.slice(Math.max(0, middle - AROUND / 2), Math.max(0, middle - AROUND / 2) + AROUND);
}

/**
 * The entries around a moment [ms since 1970]: a person chooses one, asks why, or wants to change what was said.
 * @typedef {(entry: Written) => void} Act
 * @typedef {{ visit: Stretch | null, moment: number, chosen: Written | null }} Looked
 * @param {{ name: string, choose: Act, change: Act } & Looked} props
 */
function Around({ name, visit, moment, chosen, choose, change }) {
  const [entries, set] = useState(/** @type {Written[] | null} */ (null)),
    [failed, fail] = useState(""),
    [why, ask] = useState(/** @type {Written | null} */ (null)),
    [edited, edit] = useState(/** @type {Sentence | null} */ (null)),
    of = useRef(/** @type {number | null} */ (null));
  useEffect(() => {
    const from = visit?.from ?? -1;
    if (of.current !== from) set(null); // of another visit; one that goes on keeps what is shown
    of.current = from;
    fail("");
    let gone = false;
    if (visit)
      get("/api/entries", { robot: name, from: visit.from, to: visit.to }).then(
        (/** @type {Entries} */ found) => {
          if (!gone) set(found.entries);
        },
        (error) => {
          if (!gone) fail(reasonOf(error));
        },
      );
    return () => {
      gone = true;
    };
  }, [visit?.from, visit?.to]);
  const shown = entries ? nearest(entries, moment) : [];
  const at = t("day.at", { time: clock(new Date(moment).toISOString()) });
  const now = shown.filter((entry) => Date.parse(entry.at_time) <= moment).at(-1);
  return html`<${Part} title=${t("day.entries")} kind="entries"
    aside=${html`<b>${visit && !visit.n ? `${t("day.between")}, ` : ""}${at}</b>`}>
    ${may("author") && visit?.n && html`<${KeepStory} key=${visit.from} name=${name} visit=${visit} />`}
    ${
      failed &&
      html`<p class="bad" role="alert"><${Quote} text=${failed} />
      </p>`
    }${visit && !entries && !failed && html`<p class="quiet">${t("loading")}</p>`}
    <ol class="entry-list bounded" tabindex="0" aria-label=${t("day.entries")}>${shown.map(
      (entry) => html`<${Entry} key=${entry.position} entry=${entry}
      current=${entry.position === (chosen ?? now)?.position} onOpen=${choose} />`,
    )}</ol>
    ${
      chosen &&
      html`<div class="chosen"><p><time datetime=${chosen.at_time}>${clock(chosen.at_time)}</time> ${lineOf(chosen)}</p>
      <button type="button" onClick=${() => ask(chosen)}>${t("why")}</button>
      ${
        may("author") &&
        speechOf(chosen) &&
        html`
        <button type="button" class="what-if" onClick=${() => change(chosen)}>${t("fork.if")}</button>`
      } <${EditButtons} entry=${chosen} edit=${edit} /></div>`
    }
    ${
      why &&
      html`<${Why} robot=${name} what=${question(why)} at=${why.at_time} text=${lineOf(why)}
      onClose=${() => ask(null)} />`
    }
    ${edited && html`<${SentenceDialog} name=${name} sentence=${edited} onClose=${() => edit(null)} />`}</${Part}>`;
}

/** @param {{ name: string }} props */
export default function DayPage({ name }) {
  useRedraw();
  const [date, pick] = useState(""),
    [day, set] = useState(/** @type {Day | null} */ (null)),
    [failed, fail] = useState("");
  const [visit, choose] = useState(/** @type {Stretch | null} */ (null)),
    [moment, move] = useState(Date.now()),
    [chosen, mark] = useState(/** @type {Written | null} */ (null)),
    [asked, change] = useState(0);
  const instead = () => change((before) => before + 1); // each time, the form begins anew
  const look = (/** @type {Stretch} */ one) => {
    choose(one);
    move(Date.parse(one.began));
    mark(null);
  };
  useEffect(() => {
    let gone = false;
    fail("");
    get("/api/day", { robot: name, date }, JOB).then(
      (/** @type {Day} */ found) => {
        if (gone) return;
        set(found);
        mark(null);
        const last = found.visits.at(-1) ?? stretches(found).at(-1);
        if (last) look(last);
        else choose(null);
      },
      (error) => {
        if (!gone) fail(reasonOf(error));
      },
    );
    return () => {
      gone = true;
    };
  }, [date]);
  useEffect(() => {
    // what happens counts at once, where the day that is shown is the one that goes on
    let timer = 0,
      looked = 0,
      gone = false;
    const again = () =>
      get("/api/day", { robot: name }, JOB).then(
        (/** @type {Day} */ found) => {
          looked = Date.now();
          if (!gone) set((shown) => (shown?.date === found.date ? found : shown));
        },
        () => {},
      ); // the console is away: what is shown stays
    const leave = date
      ? () => {}
      : listen((kind, body) => {
          // What comes before the page is live was before.
          if (kind !== "entry" || body.robot !== name || !body.text || live.state !== "live") return;
          clearTimeout(timer);
          timer = setTimeout(again, Math.max(SOON, looked + AGAIN - Date.now()));
        });
    return () => {
      gone = true;
      clearTimeout(timer);
      leave();
    };
  }, [date]);
  /**
   * Look at a moment; with `minute`, at the visit that begins within a minute of it, if none goes on then.
   * @param {number} at
   * @param {boolean} [minute]
   */
  const scrub = (at, minute = false) => {
    const inside = parts.filter((one) => Date.parse(one.began) <= at).at(-1) ?? parts[0];
    const visited = inside?.n && !(Date.parse(inside.ended) < at);
    const begins = (/** @type {Stretch} */ one) =>
      one.n && Date.parse(one.began) > at && Date.parse(one.began) < at + MINUTE;
    const next = minute && !visited && parts.find(begins);
    if (next) {
      look(next);
      return;
    }
    move(at);
    mark(null);
    if (inside && inside.from !== visit?.from) choose(inside);
  };
  const parts = day ? stretches(day) : [];
  const open = (/** @type {Written} */ entry) => {
    choose(parts.filter((one) => one.from <= entry.position).at(-1) ?? parts[0]);
    mark(entry);
    move(Date.parse(entry.at_time));
  };
  const shown = parts.find((one) => one.from === visit?.from) ?? visit; // as it is by now
  if (failed)
    return html`<h1 class="hidden">${t("day")}</h1><p class="notice bad" role="alert"><${Quote} text=${failed} /></p>`;
  if (!day) return html`<p class="notice">${t("loading")}</p>`;
  return html`<div class="page-head"><h1>${t("page.day")}</h1>
      <label><span>${t("day.date")}</span><${Select} class="date" value=${day.date} choose=${pick}
        options=${[...new Set([...day.dates, day.date])].sort().map((one) => [one, one])} /></label>
      ${
        may("show") &&
        html`<button type="button"
        onClick=${() => command(name, "mark")}>${t("day.mark")}</button>`
      }</div>
    <${Totals} numbers=${day.numbers} />
    <${Line} key=${day.date} day=${day} bounds=${bounds(day)} visit=${shown} moment=${moment} scrub=${scrub}
      look=${look} />
    <${Find} name=${name} date=${day.date} parts=${parts} scrub=${scrub} open=${open} />
    <div class="day"><${Visits} day=${day} visit=${shown} choose=${look} />
      <${Around} name=${name} visit=${shown} moment=${moment} chosen=${chosen} change=${instead} choose=${(
        /** @type {Written} */ entry,
      ) => {
        mark(entry);
        change(0);
        move(Date.parse(entry.at_time));
      }} />
      ${
        may("author") &&
        html`<${Fork} key=${`${asked && chosen?.position} ${asked}`} name=${name} entry=${chosen}
        asked=${asked > 0} />`
      }</div>
    <${Numbers} name=${name} day=${day} />`;
}
