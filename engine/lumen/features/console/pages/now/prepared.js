// @ts-check
// Sentences that operators keep for the robot to say: of the project, so each browser has them.
/** @import { Prepared as Kept, Robot } from "../types" */
import { command } from "../commands.js";
import { get, post } from "../live.js";
import { Quote, reasonOf } from "../quoted.js";
import { html, languageName, t, useEffect, useState } from "../ui.js";

const LIMIT = 15000; // [ms]

/**
 * Keep a sentence, or remove it; return all that are kept.
 * @param {Kept} sentence
 * @param {boolean} keep
 */
async function change(sentence, keep) {
  return (await post("/api/prepared", { ...sentence, keep }, LIMIT)).prepared;
}

/** What is kept: `all`, `keep(sentence)`, `remove(sentence)`, and why the last of these failed. */
export function usePrepared() {
  const [all, set] = useState(/** @type {Kept[]} */ ([])),
    [wrong, complain] = useState("");
  const done = (/** @type {Promise<Kept[]>} */ asked) =>
    asked.then(
      (found) => {
        set(found);
        complain("");
      },
      (error) => complain(reasonOf(error)),
    );
  useEffect(() => {
    done(get("/api/prepared").then((found) => found.prepared));
  }, []);
  return {
    all,
    wrong,
    keep: (/** @type {Kept} */ one) => done(change(one, true)),
    remove: (/** @type {Kept} */ one) => done(change(one, false)),
  };
}

/** @param {{ robot: Robot, one: Kept, remove: (one: Kept) => void }} props */
function Sentence({ robot, one, remove }) {
  const say = () => command(robot.robot, "say", one, `${t("say")} “${one.text.slice(0, 40)}”`);
  return html`<li><button type="button" class="prepared-say" lang=${one.language} onClick=${say}>${one.text}</button>
    ${(robot.languages ?? []).length > 1 && html`<span class="quiet">${languageName(one.language)}</span>`}
    <button type="button" class="plain" aria-label=${t("prepared.remove.one", { text: one.text })}
      onClick=${() => remove(one)}>${t("prepared.remove")}</button></li>`;
}

/**
 * A press says a sentence at once.
 * @param {{ robot: Robot, prepared: ReturnType<typeof usePrepared> }} props
 */
export function Prepared({ robot, prepared }) {
  return html`${
    prepared.all.length > 0 &&
    html`<h3>${t("prepared")}</h3>
      <ul class="plain-list prepared">${prepared.all.map(
        (one) => html`
        <${Sentence} key=${`${one.language} ${one.text}`} robot=${robot} one=${one} remove=${prepared.remove} />`,
      )}</ul>`
  }
    <p class="bad" role="alert"><${Quote} text=${prepared.wrong} /></p>`;
}
