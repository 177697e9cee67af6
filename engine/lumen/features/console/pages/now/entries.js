// @ts-check
// The latest of what happened; each opens its why.
/** @import { Entry as Written, Link as Cause, Robot } from "../types" */
import { JOB, get, live } from "../live.js";
import { Place, Values } from "../places.js";
import { InEnglish, Quote, reasonOf, translated } from "../quoted.js";
import { may } from "../session.js";
import { Badge, Dialog, Part, clock, html, lineOf, t, useEffect, useState } from "../ui.js";
import en from "../texts/en.js";
import { isTrouble } from "./troubles.js";

const SHOWN = 80;

/**
 * The text of a link without a guard and without data: for people who write no files.
 * @param {string} text
 */
function plainly(text) {
  const heard = /^heard \{"result": "((?:[^"\\]|\\.)*)"/.exec(text);
  if (heard) return `heard “${heard[1].replaceAll('\\"', '"')}”`;
  return text.replace(/, as (?!soon as possible)[^]*$/, "").replace(/ \{[^]*\}$/, "");
}

/**
 * What of a chain a person is shown: an author all of it, others no messages of the bus, guards or data.
 * @param {Cause[]} chain
 */
const shownOf = (chain) =>
  may("author")
    ? chain
    : chain
        .filter((link) => link.kind !== "message")
        .map((link) => ({ ...link, text: plainly(link.text), values: null }));

/** @param {{ link: Cause }} props */
function Link({ link }) {
  return html`<li class="link"><p><${Badge} state="kind">${t(`kind.${link.kind}`)}</${Badge}>
      ${" "}<${Quote} text=${link.text} named=${false} /></p>
    <p class="place">${clock(link.at)} <${Place} file=${link.file} line=${link.line} /></p>
    <${Values} values=${link.values} /></li>`;
}

/**
 * Why something was done: asked of the robot when it opens.
 * @param {{ robot: string, what: string, at: string, text: string, onClose: () => void }} props
 */
export function Why({ robot, what, at, text, onClose }) {
  const [found, set] = useState(/** @type {{ chain: Cause[] } | null} */ (null)),
    [failed, fail] = useState("");
  const then = new Date(Date.parse(at) + 1).toISOString(); // what happened within that millisecond is meant, too
  useEffect(() => {
    get("/api/why", { robot, what, at: then }, JOB).then(
      (one) => (one.chain ? set(one) : fail(one.reason ?? en["why.none"])),
      (error) => fail(reasonOf(error)),
    );
  }, []);
  const chain = found ? shownOf(found.chain) : [];
  return html`<${Dialog} title=${t("why.of", { text })} onClose=${onClose}>
    ${
      failed &&
      html`<p class="bad" role="alert"><${Quote} text=${failed} />
      </p>`
    }${!found && !failed && html`<p>${t("loading")}</p>`}
    ${
      found &&
      html`${chain.some((link) => translated(link.text) === null) && html`<${InEnglish} />`}
      <ol class="chain" tabindex="0" aria-label=${t("why.of", { text })}>${chain.map(
        (link, n) => html`
        <${Link} key=${n} link=${link} />`,
      )}</ol>`
    }</${Dialog}>`;
}

/**
 * What `lumen why` is asked about for an entry: what it said, else what it did, else the state it entered.
 * @param {Written} entry
 * @returns {string}
 */
export function question(entry) {
  const begun = (entry.commands ?? []).map((one) => one.Start).filter(Boolean);
  return (begun.find((one) => one.command?.Say) ?? begun[0])?.id ?? entry.entered?.at(-1) ?? "";
}

/** @param {{ entry: Written, onOpen: (entry: Written) => void, current?: boolean }} props */
export function Entry({ entry, onOpen, current = false }) {
  return html`<li class="entry" data-kind=${entry.kind} data-trouble=${isTrouble(entry) || null}>
    <button type="button" aria-current=${current ? "true" : null} onClick=${() => onOpen(entry)}>
    <span class="entry-when"><time datetime=${entry.at_time}>${clock(entry.at_time)}</time> <span
      class="entry-kind">${t(`kind.${entry.kind}`)}</span></span><span class="entry-text">${lineOf(entry)}</span>
      </button></li>`;
}

/** @param {{ robot: Robot }} props */
export function Entries({ robot }) {
  const [opened, open] = useState(/** @type {Written | null} */ (null));
  const mine = live.told
    .filter((entry) => entry.robot === robot.robot)
    .slice(-SHOWN)
    .reverse();
  return html`<${Part} title=${t("entries")} kind="entries">
    ${
      mine.length
        ? html`<ol class="entry-list bounded" reversed tabindex="0"
          aria-label=${t("entries")}>${mine.map(
            (entry) => html`<${Entry} key=${entry.position} entry=${entry}
          onOpen=${open} />`,
          )}</ol>`
        : html`<p class="quiet">${t("entries.none")}</p>`
    }
    ${
      opened &&
      html`<${Why} robot=${robot.robot} what=${question(opened)} at=${opened.at_time} text=${lineOf(opened)}
      onClose=${() => open(null)} />`
    }</${Part}>`;
}
