// @ts-check
// The project's own skills and modules: what each is for, who performs it, how it is, and a button to begin a skill.
/** @import { ArgumentSchema, OwnModule, Robot, Skill as Own, SkillState, Skills } from "../types" */
import { command } from "../commands.js";
import { JOB, get, isHere } from "../live.js";
import { Place } from "../places.js";
import { Quote, reasonOf } from "../quoted.js";
import { may } from "../session.js";
import { Badge, Part, Select, Since, Usable, html, inLanguage, t, ticked, typed, useEffect, useState } from "../ui.js";

/**
 * The content of a field: a text, or whether its box is ticked.
 * @typedef {string | boolean} Filled
 */

/** @type {Record<string, string>} */
const STATES = { running: "warn", ready: "open", idle: "kind", paused: "bad", unknown: "kind" };
/** @type {Record<string, string>} */
const MODULES = { here: "open", lost: "bad", awaited: "warn" };
const EASY = ["string", "number", "integer", "boolean"];

/**
 * The states of the skills, as the exhibition and the other processes report them; null if none performs skills.
 * @param {Robot} robot
 * @returns {Record<string, SkillState> | null}
 */
function statesOf(robot) {
  const here = (robot.processes ?? []).filter((one) => one.state === "here");
  const told = [robot.skill_states, ...here.map((one) => one.skills)].filter((one) => Object.keys(one ?? {}).length);
  return told.length ? Object.assign({}, ...told) : null;
}

/** @param {ArgumentSchema} schema */
const kindOf = ({ type = "", enum: values }) => (values ? "enum" : EASY.includes(type) ? type : "json");

/**
 * A value as its schema wants it; undefined for an empty field. Raises SyntaxError for text that is no JSON.
 * @param {ArgumentSchema} schema
 * @param {Filled | undefined} text
 * @returns {unknown}
 */
function valueOf(schema, text) {
  const kind = kindOf(schema);
  if (kind === "boolean") return Boolean(text);
  if (text === "" || text === undefined) return undefined;
  if (kind === "enum") return schema.enum?.find((one) => `${one}` === text);
  if (kind === "json") return JSON.parse(`${text}`);
  return kind === "string" ? text : Number(text);
}

/**
 * What a field contains at first: its default, or the first of a few values.
 * @param {ArgumentSchema} schema
 * @returns {Filled}
 */
const first = (schema) => {
  if (schema.default === undefined) return kindOf(schema) === "enum" ? `${schema.enum?.[0]}` : "";
  if (kindOf(schema) === "boolean") return Boolean(schema.default);
  return kindOf(schema) === "json" ? JSON.stringify(schema.default) : `${schema.default}`;
};

/**
 * @typedef {{ name: string, value: Filled, required: boolean, write: (value: Filled) => void }} Fields
 * @param {{ schema: ArgumentSchema } & Fields} props
 */
function Field({ name, schema, value, required, write }) {
  const kind = kindOf(schema),
    label = inLanguage(schema.description) || name;
  if (kind === "boolean") {
    return html`<label class="check"><input type="checkbox" name=${name} checked=${value}
      onChange=${ticked(write)} /> ${label}</label>`;
  }
  if (kind === "enum") {
    return html`<label><span>${label}</span><${Select} name=${name} value=${value} choose=${write}
      options=${schema.enum?.map((one) => [`${one}`, `${one}`])} /></label>`;
  }
  const number = kind === "number" || kind === "integer";
  return html`<label class="grow"><span>${label}</span><input name=${name} type=${number ? "number" : "text"}
    step=${kind === "integer" ? 1 : "any"} min=${schema.minimum} max=${schema.maximum} required=${required}
    placeholder=${schema.format === "duration" ? "3s" : null} value=${value} autocomplete="off"
    class=${kind === "json" ? "code" : null} onInput=${typed(write)} /></label>`;
}

/**
 * The arguments of a skill, and the button that begins it, whatever the behaviour is doing.
 * @param {{ robot: Robot, skill: Own }} props
 */
function Begin({ robot, skill }) {
  const names = Object.keys(skill.arguments);
  const [values, set] = useState(() => Object.fromEntries(names.map((name) => [name, first(skill.arguments[name])]))),
    [wrong, complain] = useState("");
  const send = (/** @type {SubmitEvent} */ submitted) => {
    submitted.preventDefault();
    try {
      const given = names.map((name) => [name, valueOf(skill.arguments[name], values[name])]);
      const body = {
        name: skill.name,
        arguments: Object.fromEntries(given.filter(([, value]) => value !== undefined)),
      };
      complain("");
      command(robot.robot, "skill", body, `${t("command.skill")} ${skill.name}`);
    } catch {
      complain(t("skill.json"));
    }
  };
  return html`<form class="cue begin-skill" onSubmit=${send}>${names.map(
    (name) => html`<${Field} key=${name} name=${name} schema=${skill.arguments[name]} value=${values[name]}
    required=${skill.required.includes(name)}
    write=${(/** @type {Filled} */ value) => set((now) => ({ ...now, [name]: value }))} />`,
  )}<button>${t("skill.begin")}</button><p class="bad" role="alert">${wrong}</p></form>`;
}

/** @param {{ robot: Robot, skill: Own, told: SkillState | undefined }} props */
function Skill({ robot, skill, told }) {
  const state = told?.state ?? "unknown",
    author = may("author");
  return html`<li data-skill=${skill.name}><p><b>${skill.name}</b> <${Badge}
      state=${STATES[state] ?? "kind"}>${t(`skill.${state}`)}</${Badge}> ${
        told && state === "running" && html`<${Since} at=${told.since} now=${robot.now} />`
      }</p>
    <p>${inLanguage(skill.description)}</p>
    ${
      author &&
      skill.kind &&
      html`<p class="quiet">${t(`skill.by.${skill.kind}`)} <span class="place">${skill.target}</span> <${Place}
      file=${skill.file} /></p>`
    }
    ${told && told.crashes > 0 && html`<p class="quiet">${t("skill.crashes", { n: told.crashes })}</p>`}
    ${told?.trouble && html`<p class="bad">${t("skill.trouble")} <${Quote} text=${told.trouble} named=${false} /></p>`}
    ${
      may("operator") &&
      skill.kind && // its arguments are known
      html`<details><summary>${t("skill.try")}</summary><${Usable} when=${isHere(robot)}><${Begin} robot=${robot}
      skill=${skill} /></${Usable}></details>`
    }</li>`;
}

/** @param {{ robot: Robot, module: OwnModule }} props */
function Module({ robot, module: one }) {
  const { restarts: n = 0 } = one;
  return html`<li data-module=${one.module}><p><b>${one.module}</b> <${Badge}
      state=${MODULES[one.state] ?? "kind"}>${t(`module.${one.state}`)}</${Badge}> <${Since} at=${one.since}
      now=${robot.now} /></p>
    ${n > 0 && html`<p class="quiet">${t("module.restarts", { n })}</p>`}
    ${one.reason && html`<p class="bad"><${Quote} text=${one.reason} named=${false} /></p>`}</li>`;
}

/**
 * Nothing for a project without skills and modules of its own.
 * @param {{ robot: Robot }} props
 */
export function OwnParts({ robot }) {
  const [found, set] = useState(/** @type {Own[] | null} */ (null)),
    [failed, fail] = useState("");
  useEffect(() => {
    get("/api/skills", { robot: robot.robot }, JOB).then(
      (/** @type {Skills} */ answer) => {
        set(answer.skills);
        fail("");
      },
      (error) => fail(reasonOf(error)),
    );
  }, [robot.robot, robot.bundle]);
  const states = statesOf(robot),
    modules = robot.modules ?? [];
  /** @returns {Own} */
  const bare = (/** @type {string} */ name) => ({ name, description: "", kind: "", arguments: {}, required: [] });
  const skills = found ?? Object.keys(states ?? {}).map(bare); // of another machine, only their names are known
  if (!skills.length && !modules.length) return null;
  return html`<${Part} title=${t("own.parts")} kind="own-parts">
    ${skills.length > 0 && !states && html`<p class="quiet">${t("skill.nobody")}</p>`}
    ${failed && html`<p class="quiet"><${Quote} text=${failed} /></p>`}
    <ul class="plain-list own-list">${skills.map(
      (skill) => html`<${Skill} key=${skill.name} robot=${robot} skill=${skill} told=${states?.[skill.name]} />`,
    )}</ul>
    ${
      modules.length > 0 &&
      html`<h3>${t("modules.own")}</h3><ul class="plain-list own-list">${modules.map(
        (one) => html`<${Module} key=${one.module} robot=${robot} module=${one} />`,
      )}</ul>`
    }</${Part}>`;
}
