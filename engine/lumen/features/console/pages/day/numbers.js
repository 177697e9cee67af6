// @ts-check
// The day's numbers: each chart is a table whose rows have a bar, so that everybody reads the same.
/** @import { Count, Day, DayNumbers } from "../types" */
import { Part, fixed, fullHour, html, languageName, span, t } from "../ui.js";
import { Said } from "./said.js";
import { Unanswered } from "./unanswered.js";

const MOST = 8;

/** @param {{ title: string, rows: Count[], all?: boolean }} props */
function Chart({ title, rows, all = false }) {
  const shown = all ? rows : rows.slice(0, MOST),
    most = Math.max(1, ...rows.map(([, count]) => count));
  return html`<div class="chart"><table><caption>${title}</caption><thead class="hidden"><tr>
    <th scope="col">${t("day.what")}</th><th scope="col">${t("day.times")}</th></tr></thead>
    <tbody>${shown.map(
      ([name, count]) => html`<tr><th scope="row"><span>${name}</span></th><td>
      <svg aria-hidden="true" viewBox="0 0 100 10" preserveAspectRatio="none">
      <rect width=${(count / most) * 100} height="10" rx="1" /></svg><span>${fixed(count)}</span></td></tr>`,
    )}</tbody>
      </table>
    ${rows.length === 0 && html`<p class="quiet">${t("day.none.numbers")}</p>`}</div>`;
}

/**
 * The numbers of the day that an operator reads first: visits, how long they took, falls.
 * @param {{ numbers: DayNumbers }} props
 */
export function Totals({ numbers }) {
  const length = (/** @type {number | null} */ seconds) => (seconds == null ? t("unknown") : span(seconds));
  const facts = [
    ["day.count", fixed(numbers.visits)],
    ["day.mean", length(numbers.mean_seconds)],
    ["day.longest", length(numbers.longest_seconds)],
    ["day.falls", fixed(numbers.falls)],
  ];
  return html`<dl class="totals" aria-label=${t("day.numbers")}>${facts.map(
    ([label, value]) => html`
    <div><dd>${value}</dd><dt>${t(label, { n: value })}</dt></div>`,
  )}</dl>`;
}

/** @param {{ name: string, day: Day }} props */
export function Numbers({ name, day }) {
  const { numbers } = day;
  const query = new URLSearchParams({ robot: name, date: day.date });
  return html`<${Part} title=${t("day.numbers")} kind="numbers" aside=${html`<a class="button"
    href="/api/day.csv?${query}" download>${t("day.csv")}</a>`}>
    <div class="charts"><${Chart} title=${t("day.hours")} all
      rows=${(numbers.hours ?? []).map(([hour, count]) => [fullHour(hour), count])} />
      <${Chart} title=${t("day.asked")} rows=${numbers.asked ?? []} />
        <${Chart} title=${t("day.missed")} rows=${numbers.missed ?? []} />
      <${Chart} title=${t("day.answers")} rows=${numbers.answers ?? []} />
        <${Chart} title=${t("day.languages")}
        rows=${(numbers.languages ?? []).map(([code, count]) => [languageName(code), count])} /></div>
    <${Unanswered} name=${name} rows=${numbers.unanswered ?? []} />
      <${Said} name=${name} said=${numbers.said ?? []} rows=${numbers.rows ?? {}} /></${Part}>`;
}
