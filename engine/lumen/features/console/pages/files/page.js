// @ts-check
// Files: what was saved, what is wrong in it, what it changes, and what it would have changed in the last visits.
/** @import { Change as Changed, Diagnostic, Files, Replay as Replayed, Report } from "../types" */
import { command } from "../commands.js";
import { JOB, get, listen, robotOf } from "../live.js";
import { InEnglish, Quote, reasonOf } from "../quoted.js";
import { holds, may } from "../session.js";
import { Ask, Badge, Part, clock, fixed, html, place, t, useEffect, useRedraw, useState } from "../ui.js";

/** @type {Record<string, string>} */
const LEVELS = { error: "bad", warning: "warn", info: "kind" };

/** @param {{ findings: Diagnostic[] }} props */
function Findings({ findings }) {
  return html`<${Part} title=${t("files.findings")} kind="findings">${
    findings.length === 0
      ? html`<p class="quiet">${t("files.findings.none")}</p>`
      : html`<${InEnglish} /><ul class="plain-list">${findings.map(
          (one) => html`<li class="finding">
      <p><${Badge} state=${LEVELS[one.severity] ?? "kind"}>${t(`severity.${one.severity}`)}</${Badge}> <span
        class="place">${place(one.file, one.line)}${one.column ? `:${one.column}` : ""}</span></p>
      <p lang="en"><b>${one.message}</b></p>${one.hint && html`<p lang="en">${one.hint}</p>`}<p
        class="place">${one.code}</p></li>`,
        )}</ul>`
  }</${Part}>`;
}

/**
 * What two texts begin and end with alike, and what differs between.
 * @typedef {[begin: string, middle: string, end: string]} Cut
 * @param {string} was
 * @param {string} now
 * @returns {[was: Cut, now: Cut]}
 */
function differing(was, now) {
  let begin = 0,
    end = 0;
  while (begin < Math.min(was.length, now.length) && was[begin] === now[begin]) begin++;
  while (end < Math.min(was.length, now.length) - begin && was.at(-1 - end) === now.at(-1 - end)) end++;
  /**
   * @param {string} text
   * @returns {Cut}
   */
  const cut = (text) => [text.slice(0, begin), text.slice(begin, text.length - end), text.slice(text.length - end)];
  return [cut(was), cut(now)];
}

/**
 * A change: what it is, where, and of a text all of it before and now, with what differs marked.
 * @param {{ change: string, detail?: Changed }} props
 */
function Change({ change, detail }) {
  const [was, now] = differing(detail?.was ?? "", detail?.now ?? "");
  return html`<li><p>${change}</p>${detail && html`<p class="place">${place(detail.file, detail.line)}</p>`}
    ${detail?.was && html`<p>− ${was[0]}<del>${was[1]}</del>${was[2]}</p>`}
    ${detail?.now && html`<p>+ ${now[0]}<ins>${now[1]}</ins>${now[2]}</p>`}</li>`;
}

/**
 * The text for a report without changes: files with errors, or that nobody watches, were not compared with those that
 * run.
 * @param {Partial<Report>} report
 * @param {string | undefined} mode
 */
const noChanges = (report, mode) => (mode === "off" || report.verdict === "refused" ? "files.unread" : "files.nothing");

/** @param {{ report: Partial<Report>, mode?: string }} props */
function Changes({ report, mode }) {
  const { changes = [], restart = [] } = report;
  return html`<${Part} title=${t("files.diff")} kind="changes" aside=${
    report.risk &&
    html`<${Badge} state=${report.risk === "cosmetic" ? "open" : "warn"}
    >${t("files.risk", { risk: t(`risk.${report.risk}`) })}</${Badge}>`
  }>
    ${
      changes.length
        ? html`<${InEnglish} /><ul class="diff" lang="en">${changes.map(
            (change, n) => html`
        <${Change} change=${change} detail=${report.details?.[n]} />`,
          )}</ul>`
        : html`<p class="quiet">${t(noChanges(report, mode))}</p>`
    }
    ${
      restart.length > 0 &&
      html`<ul class="diff"
      lang="en">${restart.map((line) => html`<li>${line}</li>`)}</ul>`
    }</${Part}>`;
}

/** @param {{ replay?: Replayed | null }} props */
function Replay({ replay }) {
  if (!replay) return null;
  return html`<${Part} title=${t("files.replay")} kind="replay">
    <p>${t("files.visits", { visits: fixed(replay.visits), steps: fixed(replay.steps), same: fixed(replay.same) })}</p>
    <ul class="plain-list">${(replay.differ ?? []).map(
      (one) => html`<li class="finding"><p><b>${t("day.visit", { n: one.visit })}</b> <span
        class="quiet">${clock(one.at)}</span></p>
      <dl class="differ"><dt>${t("files.was")}</dt><dd><${Quote} text=${one.was} named=${false} /></dd>
        <dt>${t("files.here")}</dt><dd><${Quote} text=${one.is} named=${false} /></dd></dl></li>`,
    )}</ul></${Part}>`;
}

const ASKED = new Set(["apply", "rollback"]); // what is asked once more before it is done

/**
 * A button of saved files: what it does is written below it, or why it can't be used now.
 * @typedef {{ strong?: boolean, grey?: string | null }} Shown
 * @param {{ name: string, verb: string, label: string, ask: (verb: string) => void } & Shown} props
 */
function Action({ name, verb, label, strong = false, grey = null, ask }) {
  const press = () => grey === null && (ASKED.has(verb) ? ask(verb) : command(name, verb));
  return html`<li><button type="button" class=${strong ? "strong" : ""} data-verb=${verb}
      aria-disabled=${grey === null ? null : "true"} onClick=${press}>${t(label)}</button>
    <p class="reason">${grey ?? t(`${label}.does`)}</p></li>`;
}

/** @param {{ name: string, files: Partial<Files> }} props */
function Actions({ name, files }) {
  const [asking, ask] = useState(/** @type {string | null} */ (null));
  const waits = Boolean(files.staged?.length || files.waiting);
  const nothing = waits ? null : t(files.mode === "off" ? "files.grey.off" : "files.grey.nothing");
  const keeps = Boolean(files.trial) && !waits; // newer files that wait are what Apply means
  const action = (
    /** @type {string} */ verb,
    /** @type {string} */ label,
    /** @type {Shown} */ more = {},
  ) => html`<${Action} name=${name} verb=${verb} label=${label} ask=${ask}
    ...${more} />`;
  return html`<ul class="file-actions">
      ${action("dry-run", "files.look")}${action("reload", "files.read")}
      ${action("apply", keeps ? "files.keep" : "files.apply", { strong: true, grey: keeps ? null : nothing })}
      ${action("try", "files.try", { grey: nothing })}${action("refuse", "files.refuse", { grey: nothing })}
      ${action("rollback", "files.back")}</ul>
    ${
      asking &&
      html`<${Ask} title=${t(asking === "rollback" ? "files.back.ask" : keeps ? "files.keep.ask" : "files.apply.ask")}
        label=${t(asking === "rollback" ? "files.back" : keeps ? "files.keep" : "files.apply")}
      onClose=${() => ask(null)} onYes=${() => command(name, asking)}>
      <p><${Quote} text=${files.waiting || files.reason || ""} /></p></${Ask}>`
    }`;
}

/** @param {{ name: string }} props */
export default function FilesPage({ name }) {
  useRedraw();
  const [files, set] = useState(/** @type {Partial<Files> | null} */ (null)),
    [failed, fail] = useState("");
  const known = JSON.stringify([robotOf(name)?.files, robotOf(name)?.last_reload]);
  const look = () =>
    get("/api/files", { robot: name }, JOB).then(
      (found) => {
        set(found);
        fail("");
      },
      (error) => fail(reasonOf(error)),
    );
  useEffect(() => {
    look();
  }, [known]);
  useEffect(
    () =>
      listen((...[kind]) => {
        if (kind === "command") look();
      }),
    [],
  );
  if (!files && !failed) return html`<p class="notice">${t("loading")}</p>`;
  if (!files)
    return html`<h1>${t("page.files")}</h1><p class="notice bad" role="alert"><${Quote} text=${failed} /></p>`;
  const report = files.last ?? files,
    verdict = files.last?.verdict ?? "applied"; // nothing was saved: what runs is active
  const lines = [...(files.last?.lines ?? []), ...(files.last?.notes ?? [])];
  return html`<h1>${t("page.files")}</h1>
    <${Part} title=${t("files.saved")} kind="saved"><p><${Badge}
      state=${verdict === "refused" ? "bad" : verdict === "waiting" || verdict === "staged" ? "warn" : "open"}
      >${t(`verdict.${verdict}`)}</${Badge}>
        ${" "}${
          holds("author") &&
          html`<${Quote} text=${files.last?.reason ?? ""} /> <${Quote}
          text=${report.hint ?? ""} />`
        } ${verdict === "refused" && t("files.goes.on")}</p>
      ${
        holds("author") &&
        lines.length > 0 &&
        html`<${InEnglish} />
        <ul class="lines" lang="en">${lines.map((line) => html`<li>${line}</li>`)}</ul>`
      }
      ${
        may("author")
          ? html`<p class="quiet"><${Quote} text=${files.reason ?? ""} /></p>
        <${Actions} name=${name} files=${files} />`
          : !holds("author") && html`<p class="quiet">${t("files.authors")}</p>`
      }</${Part}>
    <div class="files">${
      holds("author") &&
      html`
      <${Findings} findings=${report.diagnostics ?? files.diagnostics ?? []} />`
    }
      ${
        (holds("author") || !report.changes?.length) &&
        html`<${Changes} report=${report}
        mode=${files.mode} />`
      }<${Replay} replay=${files.replay} /></div>`;
}
