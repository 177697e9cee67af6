// @ts-check
// Where something is written, its data and its guards: for authors. Other people see none of it.
/** @import { Data } from "./types" */
import { may } from "./session.js";
import { html, place } from "./ui.js";

/**
 * `behaviors/tour.yaml:205`; nothing for people who write no files.
 * @param {{ file?: string | null, line?: number | null }} props
 */
export const Place = ({ file, line }) =>
  file && may("author") ? html`<span class="place">${place(file, line)}</span>` : null;

/**
 * Values by their names: as JSON for authors; for others those that are texts or numbers, in words.
 * @param {{ values: Data | null | undefined }} props
 */
export function Values({ values }) {
  const all = Object.entries(values ?? {});
  const shown = may("author")
    ? all.map(([name, value]) => [name, JSON.stringify(value)])
    : all.filter(([, value]) => ["string", "number"].includes(typeof value));
  return (
    shown.length > 0 &&
    html`<p class="values">${shown.map(
      ([name, value]) => html`
    <span key=${name}>${name} = <b>${value}</b></span> `,
    )}</p>`
  );
}
