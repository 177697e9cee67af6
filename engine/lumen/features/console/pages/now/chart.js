// @ts-check
// The chart of the behaviour that runs, drawn: the active states, and those that were active before.
/** @import { Chart as Drawn, ChartBox, Robot, State } from "../types" */
import { JOB, get, live } from "../live.js";
import { Quote, reasonOf } from "../quoted.js";
import { Part, html, t, useEffect, useState } from "../ui.js";

const MARGIN = 16; // [px]

/**
 * The paths of all active states of a tree.
 * @param {State[]} states
 * @returns {string[]}
 */
const paths = (states) => states.flatMap((one) => [one.path, ...paths(one.children ?? [])]);

/**
 * The names of the states that this robot entered, as far as the page has seen it.
 * @param {Robot} robot
 */
const entered = (robot) =>
  new Set(live.entries.filter((one) => one.robot === robot.robot).flatMap((one) => one.entered ?? []));

/** @param {{ box: ChartBox, active: boolean, been: boolean }} props */
function Box({ box, active, been }) {
  const [x, y] = box.text,
    radius = box.final ? 4 : 9;
  return html`<g class="chart-state" data-path=${box.path} data-leaf=${box.leaf || null} data-final=${box.final || null}
      data-active=${active || null} data-been=${been || null} data-depth=${Math.min(box.depth, 3)}>
    <rect x=${box.x} y=${box.y} width=${box.width} height=${box.height} rx=${box.leaf ? radius : 12} />
    ${
      box.first &&
      html`<circle cx=${box.x + 9} cy=${box.y - 11} r="4.5" />
      <path d="M${box.x + 9} ${box.y - 7} V${box.y - 0.5}" />`
    }
    <text class="chart-title" x=${x} y=${y}>${box.title}</text>
    ${box.rows.map((row) => html`<text x=${x} y=${row.y}>${row.text}</text>`)}</g>`;
}

/** @param {{ chart: Drawn, robot: Robot }} props */
function Drawing({ chart, robot }) {
  const active = new Set(paths(robot.states ?? [])),
    been = entered(robot);
  const named = chart.boxes.filter((box) => box.leaf && active.has(box.path)).map((box) => box.title);
  const view = [-MARGIN, -MARGIN, chart.width + 2 * MARGIN, chart.height + 2 * MARGIN].join(" ");
  const box = (/** @type {ChartBox} */ one) => html`<${Box} key=${one.path} box=${one} active=${active.has(one.path)}
    been=${been.has(one.name)} />`;
  return html`<div class="chart-scroll" tabindex="0" role="group" aria-label=${t("chart")}>
    <svg class="state-chart" viewBox=${view} role="img" aria-label="${t("chart.active")}: ${named.join(", ")}"
      width=${Math.round(chart.width + 2 * MARGIN)}>
      <defs><marker id="chart-tip" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="7" markerHeight="7" orient="auto">
        <path d="M0 0.8 L10 5 L0 9.2 z" /></marker></defs>
      ${chart.boxes.filter((one) => !one.leaf).map(box)}
      ${chart.lines.map((line) => html`<path class="chart-line" d=${line} marker-end="url(#chart-tip)" />`)}
      ${chart.boxes.filter((one) => one.leaf).map(box)}</svg></div>`;
}

/**
 * Asked for when it is opened, and again when other files run.
 * @param {{ robot: Robot }} props
 */
function Chart({ robot }) {
  const [chart, set] = useState(/** @type {Drawn | null} */ (null)),
    [wrong, complain] = useState("");
  useEffect(() => {
    let gone = false;
    get("/api/chart", { robot: robot.robot }, JOB).then(
      (found) => {
        if (!gone) {
          set(found);
          complain("");
        }
      },
      (error) => {
        if (!gone) complain(reasonOf(error));
      },
    );
    return () => {
      gone = true;
    };
  }, [robot.bundle]);
  return html`${!chart && !wrong && html`<p class="quiet">${t("loading")}</p>`}
    <p class="bad" role="alert"><${Quote} text=${wrong} /></p>
    ${chart && html`<p class="quiet">${t("chart.more")}</p><${Drawing} chart=${chart} robot=${robot} />`}`;
}

/** @param {{ robot: Robot }} props */
export function BehaviorChart({ robot }) {
  const [open, set] = useState(false);
  return html`<${Part} title=${t("chart")} kind="chart-part" aside=${html`
      <button type="button" class="chart-open" aria-expanded=${open} onClick=${() => set(!open)}>
        ${t(open ? "chart.hide" : "chart.show")}</button>`}>
    ${open && html`<${Chart} robot=${robot} />`}</${Part}>`;
}
