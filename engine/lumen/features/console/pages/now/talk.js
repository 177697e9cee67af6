// @ts-check
// The conversation: its last lines, what the robot says and does now, and a text for it to say.
/** @import { Entry, Robot } from "../types" */
/** @import { Sentence } from "../sentence.js" */
import { command } from "../commands.js";
import { isHere, live } from "../live.js";
import { inPageLanguage } from "../quoted.js";
import { SentenceDialog, sentencesOf } from "../sentence.js";
import { may } from "../session.js";
import {
  Part,
  Select,
  Since,
  Usable,
  clock,
  html,
  languageName,
  percent,
  t,
  useEffect,
  useRef,
  useState,
  typed,
} from "../ui.js";
import { Prepared, usePrepared } from "./prepared.js";

const LINES = 10;

/**
 * A line of the conversation: of the visitor, with how sure the ears were (0 to 1), or of the `robot`.
 * @typedef {{ robot?: boolean, sure?: number | null, language?: string, sentence?: Sentence }} Speech
 * @typedef {{ key: string, at: string, text: string } & Speech} Spoken
 */

/**
 * The lines that an entry of the journal is in the conversation: what the visitor said, then what the robot says.
 * @param {Entry} entry
 * @returns {Spoken[]}
 */
function linesOf(entry) {
  const { position, at_time: at, data, heard, commands = [] } = entry;
  const speech = heard && typeof data?.result === "string";
  const words = speech ? [{ at, text: data.result, sure: data.confidence ?? null }] : [];
  const languages = new Map(commands.map((one) => [one.Start?.id, one.Start?.command?.Say?.language]));
  const said = sentencesOf(entry).map((sentence) => ({
    at,
    robot: true,
    text: sentence.text,
    language: languages.get(sentence.id),
    sentence,
  }));
  return [...words, ...said].map((line, n) => ({ ...line, key: `${position} ${n}` }));
}

/**
 * The last lines: who spoke, when, and how sure the ears were. The list has one height, so nothing below it moves.
 * @param {{ robot: Robot }} props
 */
export function Lines({ robot }) {
  const list = useRef(/** @type {HTMLOListElement | null} */ (null)),
    [edited, edit] = useState(/** @type {Sentence | null} */ (null)),
    mine = live.told.filter((one) => one.robot === robot.robot);
  const lines = mine.flatMap(linesOf).slice(-LINES),
    last = lines.at(-1)?.key;
  useEffect(() => {
    list.current?.scrollTo({ top: list.current.scrollHeight });
  }, [last]);
  const above = () => list.current?.classList.toggle("more-above", list.current.scrollTop > 0);
  return html`<${Part} title=${t("talk")} kind="lines-of-talk">
    <ol class="talk-lines" ref=${list} tabindex="0" aria-label=${t("talk")} onScroll=${above}>${lines.map(
      (line) => html`
      <li key=${line.key}><time datetime=${line.at}>${clock(line.at)}</time>
        ${" "}<b>${t(line.robot ? "talk.robot" : "talk.visitor")}</b> <span
          lang=${line.language ?? null}>${line.text}</span>
        ${
          line.sure != null &&
          html` <span
          class="quiet">${t("talk.sure", { percent: percent(line.sure * 100) })}</span>`
        }
        ${
          line.sentence &&
          may("author") &&
          html` <button type="button" class="plain edit-sentence" disabled=${!isHere(robot)} title=${t("sentence.edit")}
          aria-label=${t("sentence.of", { text: line.text })} onClick=${() => edit(line.sentence ?? null)}>✎</button>`
        }
      </li>`,
    )}</ol>
    ${
      edited && html`<${SentenceDialog} name=${robot.robot} sentence=${edited} onClose=${() => edit(null)} />`
    }</${Part}>`;
}

/** @param {{ robot: Robot }} props */
function SayForm({ robot }) {
  const languages = robot.languages?.length ? robot.languages : [robot.language ?? "en"];
  const [text, set] = useState(""),
    [chosen, choose] = useState(/** @type {string | null} */ (null));
  const spoken = chosen ?? robot.language ?? languages[0] ?? "en";
  const prepared = usePrepared();
  const keep = () => text.trim() && prepared.keep({ text: text.trim(), language: spoken });
  const say = (/** @type {SubmitEvent} */ event) => {
    event.preventDefault();
    if (!text.trim()) return;
    // The text stays until the bus has it: one that was not sent is sent again, not typed again.
    const sent = (/** @type {string} */ state) => state === "sent" && set((now) => (now === text ? "" : now));
    command(
      robot.robot,
      "say",
      { text: text.trim(), language: spoken },
      `${t("say")} “${text.trim().slice(0, 40)}”`,
      sent,
    );
  };
  return html`<form class="say" onSubmit=${say}><label class="grow"><span>${t("say.text")}</span>
      <input value=${text} maxlength="500" lang=${spoken} onInput=${typed(set)} autocomplete="off" />
        </label>
    ${
      languages.length > 1 &&
      html`<label><span>${t("language")}</span><${Select} value=${spoken} choose=${choose}
        options=${languages.map((one) => [one, languageName(one)])} /></label>`
    }
    <button class="strong">${t("say")}</button>
    <button type="button" class="keep-sentence" onClick=${keep}>${t("prepared.keep")}</button></form>
    <${Prepared} robot=${robot} prepared=${prepared} />`;
}

/** @param {{ robot: Robot }} props */
export function Talk({ robot }) {
  const { saying, visitor_said: heard, motion, now } = robot;
  return html`<${Part} title=${t("talk.now")} kind="talk"
      aside=${html`<p class="visitor"><span>${t("visitor")}: <b>${robot.visitor || t("nobody.here")}</b></span>
        <span>${t("language")}: <b>${robot.language ? languageName(robot.language) : ""}</b></span></p>`}>
    <p class="bubble robot" data-quiet=${!saying}><span class="speaker">${t("robot.says")} ${
      saying &&
      html`<${Since}
      at=${saying.since} now=${now} />`
    }</span>
      <span lang=${saying?.language}>${saying ? saying.text : t("says.nothing")}</span></p>
    <p class="bubble visitor-said" data-quiet=${!heard}><span
      class="speaker">${t("visitor.said")} ${heard && html`<${Since} at=${heard.at} now=${now} />`}</span>
      <span>${heard ? heard.text : t("heard.nothing")}</span></p>
    <div class="doing">${
      motion
        ? html`<p><b>${inPageLanguage(motion.verb)}</b> ${motion.name} <${Since} at=${motion.since} now=${now} /></p>
      ${
        motion.progress != null &&
        html`<progress max="1" value=${motion.progress}
        aria-label="${inPageLanguage(motion.verb)} ${motion.name}">${percent(motion.progress * 100)}</progress>`
      }`
        : html`<p class="quiet">${t("moves.nothing")}</p>`
    }</div>
    ${may("operator") && html`<${Usable} when=${isHere(robot)}><${SayForm} robot=${robot} /></${Usable}>`}</${Part}>`;
}
