// @ts-check
// The day from left to right: hours, visits, marks, and the moment that is looked at.
/** @import { Day, Stretch } from "../types" */
/** @import { Times } from "./zoom.js" */
import { clock, html, span, t, typed } from "../ui.js";
import { ZoomButtons, ticks, useZoom } from "./zoom.js";

const HOUR = 3600e3,
  STEP = 1000,
  WIDE = 1000,
  HIGH = 84; // [ms], [ms], of the picture

/**
 * What a day consists of, in its order: visits, and what happened between them.
 * @param {Day} day
 * @returns {Stretch[]}
 */
export const stretches = (day) =>
  /** @type {Stretch[]} */ ([...day.visits, ...(day.between ?? [])]).sort((one, other) => one.from - other.from);

/**
 * From the full hour before the first of what happened to the one after the last [ms since 1970].
 * @param {Day} day
 * @returns {Times}
 */
export function bounds(day) {
  const times = stretches(day)
    .flatMap((one) => [one.began, one.ended])
    .concat(day.marks?.map((one) => one.at) ?? [])
    .filter(Boolean)
    .map((one) => Date.parse(one));
  if (!times.length) return [Date.now() - HOUR, Date.now()];
  return [Math.floor(Math.min(...times) / HOUR) * HOUR, Math.ceil((Math.max(...times) + 1) / HOUR) * HOUR];
}

/**
 * What happens at the moment: a visit, or something between visits.
 * @param {Stretch} visit
 */
const around = (visit) =>
  visit.n ? `${t("day.visit", { n: visit.n })}, ${span(visit.seconds ?? 0)}` : t("day.between");

/**
 * A time below the line, in the middle of its mark; at an end of the line, inside the line.
 * @param {{ at: number, part: number, seconds: boolean }} props
 */
function Tick({ at, part, seconds }) {
  const edge = part < 0.02 ? "first" : part > 0.98 ? "last" : null;
  // Set by a script: the page allows no style in its markup.
  const put = (/** @type {HTMLElement | null} */ item) => item && (item.style.left = `${part * 100}%`);
  return html`<li class=${edge} ref=${put}>${clock(new Date(at).toISOString(), seconds)}</li>`;
}

/**
 * `scrub(at)` looks at a moment [ms since 1970], `look(part)` at a visit or at what was between two.
 * @typedef {{ scrub: (at: number) => void, look: (part: Stretch) => void }} Looks
 * @param {{ day: Day, bounds: Times, visit: Stretch | null, moment: number } & Looks} props
 */
export function Line({ day, bounds: whole, visit, moment, scrub, look }) {
  const view = useZoom(whole, moment),
    [begin, end] = view.shown,
    x = (/** @type {number} */ at) => ((at - begin) / (end - begin)) * WIDE;
  const { times: hours, seconds } = ticks(view.shown);
  const iso = (/** @type {number} */ at) => new Date(at).toISOString();
  return html`<section class="part line" aria-label=${t("day.scrub")}>
    <svg viewBox="0 0 ${WIDE} ${HIGH}" preserveAspectRatio="none" aria-hidden="true" ...${view.handlers}
      onClick=${(/** @type {MouseEvent} */ e) => view.wasDrag() || scrub(view.timeAt(e))}>
      <rect class="road" x="0" y="22" width=${WIDE} height="40" rx="6" />
      ${hours.map((at) => html`<line class="hour" x1=${x(at)} x2=${x(at)} y1="14" y2="70" />`)}
      ${day.between?.map(
        (
          one,
        ) => html`<rect class="between ${one.from === visit?.from ? "now" : ""}" x=${x(Date.parse(one.began))} y="38"
          rx="2" height="8"
        width=${Math.max(3, x(Date.parse(one.ended)) - x(Date.parse(one.began)))} />`,
      )}
      ${day.visits.map(
        (
          one,
        ) => html`<rect class="bar ${one.from === visit?.from ? "now" : ""}" x=${x(Date.parse(one.began))} y="26" rx="3"
          height="32"
        width=${Math.max(3, x(Date.parse(one.ended ?? iso(end))) - x(Date.parse(one.began)))} onClick=${(
          /** @type {MouseEvent} */ e,
        ) => {
          e.stopPropagation();
          if (!view.wasDrag()) look(one);
        }} />`,
      )}
      ${day.marks?.map((one) => html`<path class="flag" d="M${x(Date.parse(one.at))} 12 v52 m0 -52 l14 7 l-14 7 z" />`)}
      <line class="moment" x1=${x(moment)} x2=${x(moment)} y1="6" y2="78" /></svg>
    <ol class="hours" aria-hidden="true">${hours.map(
      (at) => html`<${Tick} at=${at} part=${x(at) / WIDE} seconds=${seconds} />`,
    )}</ol>
    <label><span class="hidden">${t("day.scrub")}</span><input type="range" min=${begin} max=${end} step=${STEP}
      value=${moment}
      aria-valuetext="${clock(iso(moment))}${visit ? `, ${around(visit)}` : ""}"
      onKeyDown=${(/** @type {KeyboardEvent} */ e) => view.typed(e, scrub, STEP)}
      onInput=${typed((text) => scrub(Number(text)))} /></label>
    <${ZoomButtons} view=${view} bounds=${whole} />
    ${
      day.marks?.length > 0 &&
      html`<ul class="marks">${day.marks.map(
        (one) => html`<li>
      <button type="button" class="plain"
      onClick=${() => scrub(Date.parse(one.at))}>⚑ ${clock(one.at)} ${one.text ?? ""}</button></li>`,
      )}</ul>`
    }
  </section>`;
}
