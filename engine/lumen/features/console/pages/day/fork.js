// Fork from here: what would have been, with another event or with the saved files; beside what was.
import { robotOf } from "../live.js";
import en from "../texts/en.js";
import { Quote, reasonOf } from "../quoted.js";
import { Part, clock, html, lineOf, t, useState } from "../ui.js";

async function ask(body) {
  const answer = await fetch("/api/fork", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body), signal: AbortSignal.timeout(60000) });
  const said = await answer.json().catch(() => ({}));
  if (!answer.ok || said.reason) throw new Error(said.reason ?? `${answer.status}`);
  return said;
}

function Column({ title, entries, other, from }) {
  const when = (one) => new Date(Date.parse(from.at_time) + 1000 * (one.at - from.at)).toISOString();
  const there = new Set(other.map((entry) => entry.text));
  return html`<div><h3>${title}</h3><ol>${entries.filter((entry) => entry.text).map((entry) => html`<li class=${there.has(entry.text) ? "" : "differs"}>
    <time>${clock(when(entry))}</time> ${there.has(entry.text) ? "" : html`<span class="badge" data-state="warn">≠</span> `}${lineOf(entry)}</li>`)}</ol></div>`;
}

export function Fork({ name, entry }) {
  const [event, setEvent] = useState(""), [data, setData] = useState(""), [saved, setSaved] = useState(false);
  const [found, show] = useState(null), [wrong, tell] = useState(""), [busy, wait] = useState(false);
  const go = async (submitted) => {
    submitted.preventDefault();
    let body = null;
    try { body = event ? { name: event, data: JSON.parse(data || "{}") } : null; } catch { return tell(en["cue.data.wrong"]); }
    tell(""), wait(true), show(null);
    try { show({ ...(await ask({ robot: name, position: entry.position, event: body, bundle: saved ? "saved" : null })), from: entry }); } catch (error) { tell(reasonOf(error)); }
    wait(false);
  };
  const same = found && found.was.length === found.would.length && found.was.every((one, n) => one.text === found.would[n].text);
  return html`<${Part} title=${t("fork")} kind="fork"><p class="quiet">${entry ? t("fork.more") : t("fork.choose")}</p>
    ${entry && html`<form class="cue" onSubmit=${go}><p class="grow"><b>${clock(entry.at_time)}</b> ${lineOf(entry)}</p>
      <label class="grow"><span>${t("fork.event")}</span><input list="fork-events" value=${event} onInput=${(e) => setEvent(e.target.value)} autocomplete="off" /></label>
      <datalist id="fork-events">${(robotOf(name)?.events ?? []).map((one) => html`<option value=${one} />`)}</datalist>
      <label class="grow"><span>${t("cue.data")}</span><input class="code" value=${data} placeholder='{"result": "dance"}' onInput=${(e) => setData(e.target.value)} autocomplete="off" spellcheck=${false} /></label>
      <label class="check"><input type="checkbox" checked=${saved} onChange=${(e) => setSaved(e.target.checked)} /> ${t("fork.files")}</label>
      <button class="strong" disabled=${busy}>${t("fork.go")}</button></form>`}
    <div role="status">${busy ? t("loading") : same ? t("fork.same") : ""} <${Quote} text=${found?.trouble ?? ""} /></div><p class="bad" role="alert"><${Quote} text=${wrong} /></p>
    ${found && html`<div class="beside" tabindex="0" role="group" aria-label=${t("fork")}><${Column} title=${t("fork.was")} entries=${found.was} other=${found.would} from=${found.from} />
      <${Column} title=${t("fork.would")} entries=${found.would} other=${found.was} from=${found.from} /></div>`}</${Part}>`;
}
