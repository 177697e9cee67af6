// @ts-check
// Fork from here: what would have been, with another event or with the saved files; beside what was.
/** @import { Data, Entry, Forked } from "../types" */
/** @import { Filled } from "./instead.js" */
import { post } from "../live.js";
import { Quote, reasonOf } from "../quoted.js";
import { Badge, Part, clock, html, lineOf, t, ticked, useEffect, useRef, useState } from "../ui.js";
import { Instead, blank, eventOf } from "./instead.js";

/**
 * @param {Data} body
 * @returns {Promise<Forked>}
 */
async function ask(body) {
  const said = await post("/api/fork", body);
  if (said.reason) throw new Error(said.reason);
  return said;
}

/** @param {{ title: string, entries: Entry[], other: Entry[], from: Entry }} props */
function Column({ title, entries, other, from }) {
  const when = (/** @type {Entry} */ one) =>
    new Date(Date.parse(from.at_time) + 1000 * (one.at - from.at)).toISOString();
  const there = new Set(other.map((entry) => entry.text));
  return html`<div><h3>${title}</h3><ol>${entries
    .filter((entry) => entry.text)
    .map(
      (entry) => html`<li class=${there.has(entry.text) ? "" : "differs"}>
    <time>${clock(when(entry))}</time> ${
      there.has(entry.text) ? "" : html`<${Badge} state="warn">≠</${Badge}> `
    }${lineOf(entry)}</li>`,
    )}</ol></div>`;
}

/**
 * What a visitor said by an entry, as `{result, language}`; null if it is no speech.
 * @param {Entry | null} entry
 */
export const speechOf = (entry) => (entry?.heard && typeof entry.data?.result === "string" ? entry.data : null);

/**
 * `asked`: a person wants other words than those of the entry, so their field has the focus.
 * @param {{ name: string, entry: Entry | null, asked?: boolean }} props
 */
export function Fork({ name, entry, asked = false }) {
  const speech = asked ? speechOf(entry) : null,
    box = useRef(/** @type {HTMLFormElement | null} */ (null));
  const [form, set] = useState(() => blank(speech?.result, speech?.language)),
    [saved, setSaved] = useState(false);
  const [found, show] = useState(/** @type {(Forked & { from: Entry }) | null} */ (null)),
    [wrong, tell] = useState(""),
    [busy, wait] = useState(false);
  useEffect(() => {
    /** @type {HTMLInputElement | null | undefined} */
    const words = box.current?.querySelector("input.words");
    if (speech) words?.select();
  }, []);
  const write = (/** @type {Partial<Filled>} */ changes) => set((now) => ({ ...now, ...changes }));
  const go = async (/** @type {SubmitEvent} */ submitted) => {
    submitted.preventDefault();
    if (!entry) return;
    tell("");
    wait(true);
    show(null);
    const body = { robot: name, position: entry.position, event: eventOf(form), bundle: saved ? "saved" : null };
    try {
      show({ ...(await ask(body)), from: entry });
    } catch (error) {
      tell(reasonOf(error));
    }
    wait(false);
  };
  const same =
    found && found.was.length === found.would.length && found.was.every((one, n) => one.text === found.would[n].text);
  return html`<${Part} title=${t("fork")} kind="fork"><p class="quiet">${entry ? t("fork.more") : t("fork.choose")}</p>
    ${
      entry &&
      html`<form class="cue" ref=${box} onSubmit=${go}>
      <p class="grow"><b>${clock(entry.at_time)}</b> ${lineOf(entry)}</p>
      <${Instead} name=${name} form=${form} write=${write} />
      <label class="check"><input type="checkbox" checked=${saved} onChange=${ticked(setSaved)} />
        ${" "}${t("fork.files")}</label>
      <button class="strong" disabled=${busy}>${t("fork.go")}</button></form>`
    }
    <div role="status">${busy ? t("loading") : same ? t("fork.same") : ""} <${Quote} text=${found?.trouble ?? ""} />
      </div>
    <p class="bad" role="alert"><${Quote} text=${wrong} /></p>
    ${
      found &&
      html`<div class="beside" tabindex="0" role="group" aria-label=${t("fork")}>
      <${Column} title=${t("fork.was")} entries=${found.was} other=${found.would} from=${found.from} />
      <${Column} title=${t("fork.would")} entries=${found.would} other=${found.was} from=${found.from} /></div>`
    }
    </${Part}>`;
}
