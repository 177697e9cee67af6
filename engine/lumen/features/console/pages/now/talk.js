// The conversation: what the robot says and does, what the visitor said, and a text for it to say.
import { command } from "../commands.js";
import { isHere } from "../live.js";
import { inPageLanguage } from "../quoted.js";
import { may } from "../session.js";
import { Part, Since, Usable, html, languageName, percent, t, useState } from "../ui.js";

function SayForm({ robot }) {
  const languages = robot.languages?.length ? robot.languages : [robot.language ?? "en"];
  const [text, set] = useState(""), [chosen, choose] = useState(null);
  const spoken = chosen ?? robot.language ?? languages[0];
  const say = (event) => {
    event.preventDefault();
    if (!text.trim()) return;
    // The text stays until the bus has it: one that was not sent is sent again, not typed again.
    const sent = (state) => state === "sent" && set((now) => (now === text ? "" : now));
    command(robot.robot, "say", { text: text.trim(), language: spoken }, `${t("say")} “${text.trim().slice(0, 40)}”`, sent);
  };
  return html`<form class="say" onSubmit=${say}><label class="grow"><span>${t("say.text")}</span>
      <input value=${text} maxlength="500" lang=${spoken} onInput=${(e) => set(e.target.value)} autocomplete="off" /></label>
    ${languages.length > 1 && html`<label><span>${t("language")}</span><select value=${spoken} onChange=${(e) => choose(e.target.value)}>
      ${languages.map((one) => html`<option value=${one} selected=${one === spoken}>${languageName(one)}</option>`)}</select></label>`}
    <button class="strong">${t("say")}</button></form>`;
}

export function Talk({ robot }) {
  const { saying, visitor_said: heard, motion, now } = robot;
  return html`<${Part} title=${t("talk")} kind="talk"
      aside=${html`<p class="visitor"><span>${t("visitor")}: <b>${robot.visitor || t("nobody.here")}</b></span><span>${t("language")}: <b>${robot.language ? languageName(robot.language) : ""}</b></span></p>`}>
    <p class="bubble robot" data-quiet=${!saying}><span class="speaker">${t("robot.says")} ${saying && html`<${Since} at=${saying.since} now=${now} />`}</span>
      <span lang=${saying?.language}>${saying ? saying.text : t("says.nothing")}</span></p>
    <p class="bubble visitor-said" data-quiet=${!heard}><span class="speaker">${t("visitor.said")} ${heard && html`<${Since} at=${heard.at} now=${now} />`}</span>
      <span>${heard ? heard.text : t("heard.nothing")}</span></p>
    <div class="doing">${motion ? html`<p><b>${inPageLanguage(motion.verb)}</b> ${motion.name} <${Since} at=${motion.since} now=${now} /></p>
      ${motion.progress != null && html`<progress max="1" value=${motion.progress} aria-label="${inPageLanguage(motion.verb)} ${motion.name}">${percent(motion.progress * 100)}</progress>`}`
      : html`<p class="quiet">${t("moves.nothing")}</p>`}</div>
    ${may("operator") && html`<${Usable} when=${isHere(robot)}><${SayForm} robot=${robot} /></${Usable}>`}</${Part}>`;
}
