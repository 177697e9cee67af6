// @ts-check
// The ways out of the active states: sentences about what people can cause; for an author every transition.
/** @import { Guard as Condition, Robot, Way as Out } from "../types" */
import { Place, Values } from "../places.js";
import { Quote, inPageLanguage } from "../quoted.js";
import { may } from "../session.js";
import { Badge, Part, html, t } from "../ui.js";
import { next } from "./next.js";

/** @param {{ guard: Condition, open: boolean }} props */
function Guard({ guard, open }) {
  const truth = guard.true ? "true" : open ? "if" : "false"; // open: it is asked when the event comes
  return html`<p class="guard" data-true=${truth}><span class="truth">${t(`guard.${truth}`)}</span>
    <code>${guard.text}</code></p><${Values} values=${guard.values} />`;
}

/** @param {{ way: Out }} props */
function Way({ way }) {
  const again = way.guard && way.why.includes(way.guard.text); // the reason is the guard, which is below
  return html`<li class="way" data-open=${way.open}>
    <p class="way-head">
      <${Badge} state=${way.open ? "open" : "closed"}>${t(way.open ? "way.open" : "way.closed")}</${Badge}>
      <span><b>${inPageLanguage(way.event) || t("way.always")}</b>${" → "}
        ${way.targets?.length ? way.targets.join(", ") : t("way.stays")}</span></p>
    ${way.why && !again && html`<p class="why-text"><${Quote} text=${way.why} /></p>`}
    ${way.guard && html`<${Guard} guard=${way.guard} open=${way.open} />`}
    <p class="place">${t("way.from", { state: way.source })} <${Place} file=${way.file} line=${way.line} /></p></li>`;
}

/** @param {{ ways: Out[] }} props */
function AllWays({ ways }) {
  const sorted = [...ways.filter((way) => way.open), ...ways.filter((way) => !way.open)];
  const count = t("ways.open", { open: ways.filter((way) => way.open).length, all: ways.length });
  return html`<details class="all-ways"><summary>${t("ways.all")} (${count})</summary>
    <ul class="plain-list bounded" tabindex="0" role="list" aria-label=${t("ways.all")}>${sorted.map(
      (way, n) => html`
      <${Way} key=${`${way.source} ${way.event} ${way.line} ${n}`} way=${way} />`,
    )}</ul></details>`;
}

/** @param {{ robot: Robot }} props */
export function Ways({ robot }) {
  const ways = robot.ways ?? [],
    sentences = next(robot);
  return html`<${Part} title=${t("ways")} kind="ways">
    ${
      sentences.length
        ? html`<ul class="plain-list next">${sentences.map(
            ([who, then]) => html`
        <li key=${who}><b>${who}</b>: ${then}</li>`,
          )}</ul>`
        : html`<p class="quiet">${t("next.none")}</p>`
    }
    ${may("author") && ways.length > 0 && html`<${AllWays} ways=${ways} />`}</${Part}>`;
}
