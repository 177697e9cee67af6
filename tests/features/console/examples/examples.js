// @ts-check
// The examples of ui.js, and of the looks that the pages share: each component in each of its states.
import * as ui from "/pages/ui.js";

const { Ask, Badge, Choice, Dialog, Part, Select, Since, Until, Usable, html, useState } = ui;

const THEN = "2026-11-23T14:03:20Z",
  now = () => Date.parse(THEN) + 67000; // a clock that stands: each picture is the same

/** Exports of ui.js that draw nothing by themselves. */
export const DRAW_NOTHING = [
  ..."byId html keep kept redraw render speak ticked typed useEffect useId useLayoutEffect".split(" "),
  ..."useRedraw useRef useSeconds useState".split(" "),
];

/** @param {{ of: string, titled?: boolean }} props */
function Chosen({ of, titled = true }) {
  const [value, choose] = useState("ask"),
    options = [
      ["ask", "ask a person"],
      ["alone", "alone"],
    ];
  return of === "Select"
    ? html`<label><span>Autonomy</span><${Select} value=${value} choose=${choose} options=${options} /></label>`
    : html`<${Choice} legend="Autonomy" name="autonomy-${titled}" titled=${titled} value=${value} choose=${choose}
        options=${options} />`;
}

/** What the functions of texts and numbers return, as rows of a table. */
const WORDS = {
  LANGUAGES: Object.values(ui.LANGUAGES).join(", "),
  clock: `${ui.clock(THEN)}, ${ui.clock(THEN, false)}`,
  fixed: `${ui.fixed(12345)}, ${ui.fixed(0.125, 2)}`,
  fullHour: ui.fullHour(9),
  inLanguage: ui.inLanguage({ en: "Dance", id: "Menari" }),
  language: ui.language(),
  languageName: ui.languageName("id"),
  lineOf: ui.lineOf(/** @type {any} */ ({ text: "says “Hello”", texts: { id: "berkata “Hello”" } })),
  percent: ui.percent(87),
  place: `${ui.place("behaviors/tour.yaml", 205)}, ${ui.place("lumen.yaml", null)}`,
  span: `${ui.span(7)}, ${ui.span(751)}, ${ui.span(11045)}`,
  t: ui.t("fleet.here", { here: 1, robots: 3 }),
};

/**
 * Examples by the export that they show, each by its state.
 * @type {Record<string, Record<string, any>>}
 */
export const EXAMPLES = {
  Part: {
    "with a heading": html`<${Part} title="What the robot says"><p>Its content.</p></${Part}>`,
    "with something beside the heading": html`<${Part} title="Changes" aside=${html`<${Badge} state="open">risk:
      cosmetic</${Badge}>`}><p class="quiet">Nothing was saved.</p></${Part}>`,
  },
  Badge: Object.fromEntries(
    ["open", "well", "warn", "bad", "away", "lost", "stopped", "kind", "closed"].map((state) => [
      state,
      html`<${Badge} state=${state}>${state}</${Badge}>`,
    ]),
  ),
  Select: { closed: html`<${Chosen} of="Select" />` },
  Choice: {
    "with its legend": html`<${Chosen} of="Choice" />`,
    "with a hidden legend": html`<${Chosen} of="Choice" titled=${false} />`,
  },
  Usable: {
    usable: html`<${Usable} when=${true}><button type="button">Say</button></${Usable}>`,
    "not usable": html`<${Usable} when=${false}><button type="button">Say</button></${Usable}>`,
  },
  Since: {
    "for a while": html`<${Since} at=${THEN} now=${now} />`,
    "never: nothing is drawn": html`<span>(<${Since} at=${null} />)</span>`,
  },
  Until: { "in a while": html`<${Until} at=${new Date(now() + 12000).toISOString()} now=${now} />` },
  ...Object.fromEntries(Object.entries(WORDS).map(([name, text]) => [name, { returns: html`<code>${text}</code>` }])),
};

/**
 * Dialogs cover the page, so each is shown alone: by `?dialog=` and its name.
 * @type {Record<string, any>}
 */
export const DIALOGS = {
  Dialog: html`<${Dialog} title="Why did it dance?" onClose=${() => {}}><p>Budi said “dance”.</p></${Dialog}>`,
  Ask: html`<${Ask} title="May NAO move again?" label="Resume" onYes=${() => {}} onClose=${() => {}}>
    <p>Look first: is there room around the robot, and is no visitor too close?</p></${Ask}>`,
};

/** @type {Record<string, Record<string, any>>} */
const LOOKS = {
  Buttons: {
    usual: html`<button type="button">Why?</button>`,
    strong: html`<button type="button" class="strong">Apply</button>`,
    plain: html`<button type="button" class="plain">Close</button>`,
    grey: html`<button type="button" aria-disabled="true">Apply</button><p class="reason">Nothing was saved.</p>`,
    GO: html`<ul class="plain-list"><li class="approval"><div class="actions"><button type="button"
      class="go">GO</button><button type="button">Stay</button></div></li></ul>`,
    Resume: html`<button type="button" class="resume">Resume</button>`,
    "of the behaviour": html`<ul class="declared-list"><li><button type="button" class="declared"><span>Dance</span><kbd
      aria-hidden="true">d</kbd></button></li></ul>`,
    Rest: html`<rest-button robot="NAO"></rest-button>`,
  },
  Notices: {
    usual: html`<p class="notice">Loading …</p>`,
    bad: html`<p class="notice bad"><b>NAO does not answer.</b> Its exhibition has ended or hangs.</p>`,
    "bad, with a button": html`<div class="notice bad"><p><b>14:03:20 The robot fell.</b> Keep visitors away.</p><button
      type="button">Mark as read</button></div>`,
    "the robot rests": html`<div class="stopped"><p><strong>The robot rests.</strong> Stopped by Ani.</p></div>`,
  },
  "What became of a command": Object.fromEntries(
    ["sending", "sent", "finished", "failed", "unsent", "unknown"].map((state) => [
      state,
      html`<div class="told"><p data-state=${state}><span>Say: ${state}</span>
        <button type="button" class="plain">Close</button></p></div>`,
    ]),
  ),
  Texts: {
    quiet: html`<p class="quiet">Nothing yet.</p>`,
    wrong: html`<p class="bad">No role has this PIN.</p>`,
    "a place": html`<p class="place">behaviors/tour.yaml:205</p>`,
  },
  Fields: {
    "a text": html`<form class="cue"><label class="grow"><span>Text</span><input value="Hello" /></label><button
      class="strong">Say</button></form>`,
    "a box": html`<label class="check"><input type="checkbox" checked /> With the saved files</label>`,
  },
};

/** @param {{ title: string, states: Record<string, any> }} props */
const Group = ({ title, states }) => html`<section aria-label=${title}><h2>${title}</h2>
  <div class="examples">${Object.entries(states).map(
    ([state, shown]) => html`<figure class="example" data-of=${title} data-state=${state}>
      <figcaption>${state}</figcaption>${shown}</figure>`,
  )}</div></section>`;

const dialog = DIALOGS[new URLSearchParams(location.search).get("dialog") ?? ""];
ui.render(
  html`<h1>Components of the console's pages</h1>${
    dialog ??
    Object.entries({ ...EXAMPLES, ...LOOKS }).map(
      ([title, states]) => html`<${Group} key=${title} title=${title} states=${states} />`,
    )
  }`,
  ui.byId("main"),
);
