// @ts-check
// The part of the day that the time line shows: by the wheel, by two fingers, by keys of the slider, or by buttons.
import { clock, html, t, useEffect, useRef, useState } from "../ui.js";

const LEAST = 30e3,
  TIMES = 2,
  DRAG = 6,
  SCROLLING = 400; // [ms], factor of a step, [px] until a press is a drag, [ms] in which a page still scrolls
/** @typedef {[from: number, to: number]} Times [ms since 1970] */
const EACH = [5, 10, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10800, 14400].map((seconds) => seconds * 1000);
const WIDEST = EACH[EACH.length - 1];
let scrolled = 0;
addEventListener("scroll", () => (scrolled = Date.now()), { passive: true });

/**
 * A window of this length inside the day, which begins at `from` or as near to it as the day allows.
 * @param {Times} day
 * @param {number} from
 * @param {number} length
 * @returns {Times}
 */
function within([begin, end], from, length) {
  const long = Math.min(Math.max(length, Math.min(LEAST, end - begin)), end - begin);
  const first = Math.min(Math.max(from, begin), end - long);
  return [first, first + long];
}

/**
 * The times at which the line has a mark: at most a dozen, at full seconds, minutes or hours of the day.
 * @param {Times} window
 * @returns {{ times: number[], seconds: boolean }}
 */
export function ticks([from, to]) {
  const each = EACH.find((one) => (to - from) / one <= 12) ?? Math.ceil((to - from) / 12 / WIDEST) * WIDEST;
  const day = new Date(from).setHours(0, 0, 0, 0),
    found = /** @type {number[]} */ ([]);
  for (let at = day + Math.ceil((from - day) / each) * each; at <= to; at += each) found.push(at);
  return { times: found, seconds: each < 60e3 };
}

/**
 * The window of the time line and what changes it. It follows `moment`; `zoom(times, around)` keeps the time `around`
 * where it is, `handlers` are those of the picture.
 * @param {Times} bounds
 * @param {number} moment
 */
export function useZoom(bounds, moment) {
  const [chosen, set] = useState(/** @type {Times | null} */ (null)),
    fingers = useRef(/** @type {Map<number, { x: number, from: number }>} */ (new Map())),
    dragged = useRef(false);
  const shown = chosen ? within(bounds, chosen[0], chosen[1] - chosen[0]) : bounds;
  const [from, to] = shown,
    length = to - from,
    whole = length >= bounds[1] - bounds[0];
  const show = (/** @type {number} */ first, /** @type {number} */ long) => {
    const next = within(bounds, first, long);
    set(next[1] - next[0] >= bounds[1] - bounds[0] ? null : next);
  };
  const middle = from <= moment && moment <= to ? moment : from + length / 2;
  const zoom = (/** @type {number} */ times, around = middle) => {
    const long = Math.min(Math.max(length / times, LEAST), bounds[1] - bounds[0]);
    show(around - ((around - from) / length) * long, long);
  };
  useEffect(() => {
    if (chosen && (moment < from || moment > to)) show(moment - length / 2, length);
  }, [moment]);
  const boxOf = (/** @type {MouseEvent} */ event) =>
    /** @type {Element} */ (event.currentTarget).getBoundingClientRect();
  const timeAt = (/** @type {MouseEvent} */ event, x = event.clientX) => {
    const box = boxOf(event);
    return from + ((x - box.left) / box.width) * length;
  };
  const wheel = (/** @type {WheelEvent} */ event) => {
    const sideways = event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY);
    const by = sideways ? event.deltaX || event.deltaY : event.deltaY;
    // A page that is being scrolled goes on; at its end the whole day leaves the wheel to the page, too.
    if (!by || (!event.ctrlKey && Date.now() - scrolled < SCROLLING) || (whole && (sideways || by > 0))) return;
    event.preventDefault();
    if (sideways) show(from + (Math.sign(by) * length) / 8, length);
    else zoom(TIMES ** -Math.max(-1, Math.min(1, by / 100)), timeAt(event));
  };
  const move = (/** @type {PointerEvent} */ event) => {
    const before = fingers.current.get(event.pointerId);
    if (!before) return;
    const others = [...fingers.current].filter(([id]) => id !== event.pointerId).map(([, one]) => one);
    const { width } = boxOf(event);
    if (others.length) {
      const [other] = others,
        apart = Math.abs(before.x - other.x),
        now = Math.abs(event.clientX - other.x);
      dragged.current = true;
      if (apart > 1 && now > 1) zoom(now / apart, timeAt(event, other.x));
    } else if (!whole && (dragged.current || Math.abs(event.clientX - before.from) > DRAG)) {
      dragged.current = true;
      show(from - ((event.clientX - before.x) / width) * length, length);
    }
    fingers.current.set(event.pointerId, { ...before, x: event.clientX });
  };
  const press = (/** @type {PointerEvent} */ event) => {
    if (!fingers.current.size) dragged.current = false;
    fingers.current.set(event.pointerId, { x: event.clientX, from: event.clientX });
  };
  const release = (/** @type {PointerEvent} */ event) => fingers.current.delete(event.pointerId);
  const handlers = {
    onWheel: wheel,
    onPointerDown: press,
    onPointerMove: move,
    onPointerUp: release,
    onPointerCancel: release,
    onPointerLeave: release,
  };
  /**
   * The keys of the slider: + and − and 0, and an arrow at the end of the window, which moves it.
   * @param {KeyboardEvent} event
   * @param {(at: number) => void} scrub
   * @param {number} step
   */
  const typed = (event, scrub, step) => {
    /** @type {Record<string, number>} */
    const steps = { ArrowLeft: -step, ArrowDown: -step, ArrowRight: step, ArrowUp: step };
    const by = steps[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (by && !whole && (moment + by < from || moment + by > to)) {
      scrub(Math.min(Math.max(moment + by, bounds[0]), bounds[1]));
    } else if (event.key === "+" || event.key === "=") zoom(TIMES);
    else if (event.key === "-") zoom(1 / TIMES);
    else if (event.key === "0") set(null);
    else return;
    event.preventDefault();
  };
  return { shown, whole, zoom, timeAt, handlers, typed, reset: () => set(null), wasDrag: () => dragged.current };
}

/**
 * The buttons of the zoom, and the part of the day that is shown.
 * @param {{ view: ReturnType<typeof useZoom>, bounds: Times }} props
 */
export function ZoomButtons({ view, bounds }) {
  const [from, to] = view.shown,
    time = (/** @type {number} */ at) => clock(new Date(at).toISOString(), to - from < 600e3);
  const closest = to - from <= Math.min(LEAST, bounds[1] - bounds[0]);
  const button = (
    /** @type {string} */ name,
    /** @type {boolean} */ off,
    /** @type {() => void} */ press,
  ) => html`<button type="button" class="zoom-${name}"
    aria-disabled=${off ? "true" : null} onClick=${() => off || press()}>${t(`zoom.${name}`)}</button>`;
  return html`<div class="zoom" role="group" aria-label=${t("zoom")}>
    ${button("in", closest, () => view.zoom(TIMES))}${button("out", view.whole, () => view.zoom(1 / TIMES))}
    ${button("reset", view.whole, view.reset)}
    <p class="quiet" role="status">${
      view.whole ? t("zoom.whole") : t("zoom.part", { from: time(from), to: time(to) })
    }</p>
    </div>`;
}
