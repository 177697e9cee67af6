// The ways out of the active states: which are open at this moment, and why not.
import { Quote, inPageLanguage } from "../quoted.js";
import { Part, Place, html, t } from "../ui.js";

function Guard({ guard, open }) {
  const values = Object.entries(guard.values ?? {});
  const truth = guard.true ? "true" : open ? "if" : "false"; // open: it is asked when the event comes
  return html`<p class="guard" data-true=${truth}><span class="truth">${t(`guard.${truth}`)}</span>
    <code>${guard.text}</code></p>
    ${values.length > 0 && html`<p class="values">${values.map(([name, value]) => html`<span>${name} = <b>${JSON.stringify(value)}</b></span> `)}</p>`}`;
}

function Way({ way }) {
  return html`<li class="way" data-open=${way.open}>
    <p class="way-head"><span class="badge" data-state=${way.open ? "open" : "closed"}>${t(way.open ? "way.open" : "way.closed")}</span>
      <span><b>${inPageLanguage(way.event) || t("way.always")}</b> → ${way.targets?.length ? way.targets.join(", ") : t("way.stays")}</span></p>
    ${way.why && html`<p class="why-text"><${Quote} text=${way.why} /></p>`}
    ${way.guard && html`<${Guard} guard=${way.guard} open=${way.open} />`}
    <p class="place">${t("way.from", { state: way.source })} <${Place} file=${way.file} line=${way.line} /></p></li>`;
}

export function Ways({ robot }) {
  const ways = robot.ways ?? [];
  const sorted = [...ways.filter((way) => way.open), ...ways.filter((way) => !way.open)];
  return html`<${Part} title=${t("ways")} kind="ways" aside=${html`<span class="count">${t("ways.open", { open: ways.filter((way) => way.open).length, all: ways.length })}</span>`}>
    ${ways.length ? html`<ul class="plain-list bounded" tabindex="0" role="list" aria-label=${t("ways")}>${sorted.map((way, n) => html`<${Way} key=${`${way.source} ${way.event} ${way.line} ${n}`} way=${way} />`)}</ul>`
      : html`<p class="quiet">${t("ways.none")}</p>`}</${Part}>`;
}
