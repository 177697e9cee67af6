// @ts-check
// Keep as a test: a visit becomes a story of the project, in which the visitor has another name.
/** @import { Stretch } from "../types" */
import { post } from "../live.js";
import { Quote, reasonOf } from "../quoted.js";
import { Dialog, html, t, useState, typed } from "../ui.js";

/**
 * A visit that was kept: the file of the story, and a remark if it plays otherwise than it was.
 * @typedef {{ file: string, remark?: string }} Kept
 */

/** @param {{ name: string, visit: Stretch, onClose: () => void, kept: (one: Kept) => void }} props */
function KeepDialog({ name, visit, onClose, kept }) {
  const [other, write] = useState(""),
    [wrong, complain] = useState(""),
    [busy, wait] = useState(false);
  const save = async (/** @type {SubmitEvent} */ submitted) => {
    submitted.preventDefault();
    complain("");
    wait(true);
    try {
      const visitor = visit.visitor ?? "";
      kept(await post("/api/stories", { robot: name, position: visit.from, visitor, name: other }));
      onClose();
    } catch (error) {
      complain(reasonOf(error));
    }
    wait(false);
  };
  const button = html`<button form="keep-story" class="strong" disabled=${busy}>${t("day.passage.save")}</button>`;
  return html`<${Dialog} title=${t("story.keep")} onClose=${onClose} actions=${button}>
    <p>${t("story.more")}</p><form id="keep-story" class="fields" onSubmit=${save}>
      ${
        visit.visitor &&
        html`<label>${t("story.name", { name: visit.visitor })}<input autofocus required maxlength="60"
        autocomplete="off" value=${other} onInput=${typed(write)} /></label>`
      }
      <p role="status">${busy ? t("loading") : ""}</p>
      <p class="bad" role="alert"><${Quote} text=${wrong} /></p></form></${Dialog}>`;
}

/**
 * A button for a visit that is over, and what became of it.
 * @param {{ name: string, visit: Stretch }} props
 */
export function KeepStory({ name, visit }) {
  const [open, setOpen] = useState(false),
    [found, tell] = useState(/** @type {Kept | null} */ (null));
  return html`<div class="keep-story"><button type="button" onClick=${() => setOpen(true)}>${t("story.keep")}</button>
    <p role="status">${
      found &&
      html`${t("day.passage.saved", { file: found.file })}
      ${found.remark && html` <span>${t("story.differs")} <${Quote} text=${found.remark} named=${false} /></span>`}`
    }</p>
    ${open && html`<${KeepDialog} name=${name} visit=${visit} kept=${tell} onClose=${() => setOpen(false)} />`}</div>`;
}
