// @ts-check
// Rest. The first thing that loads, and it needs nothing else of the page: the button is made here, so that there is
// none which does nothing. Each press is a message of its own and says what became of it, also when nobody answers.
/** @import { Answer, Now, RobotSent, Tell } from "./types" */
(() => {
  /** @type {Record<string, Record<string, string>>} */
  const WORDS = {
    en: {
      rest: "Rest",
      all: "all robots",
      again: "Escape once more: rest",
      dismiss: "Close",
      sending: "Sending …",
      unsent: "NOT SENT. The robot did not get it. Press again, or stop it by hand.",
      sent: "Sent; the robot has not answered yet.",
      unknown: "Sent, but no answer came: look at the robot.",
      failed: "The robot does not rest: {reason}",
      finished: "Rests, after {seconds} s.",
      after_all: "Rests after all: the robot reports it now.",
    },
    id: {
      rest: "Istirahat",
      all: "semua robot",
      again: "Escape sekali lagi: istirahat",
      dismiss: "Tutup",
      sending: "Mengirim …",
      unsent: "TIDAK TERKIRIM. Robot tidak menerimanya. Tekan lagi, atau hentikan dengan tangan.",
      sent: "Terkirim; robot belum menjawab.",
      unknown: "Terkirim, tetapi tidak ada jawaban: periksa robotnya.",
      failed: "Robot tidak beristirahat: {reason}",
      finished: "Beristirahat, setelah {seconds} detik.",
      after_all: "Akhirnya beristirahat: robot melaporkannya sekarang.",
    },
  };
  const LIMIT = 1000,
    SILENT = 12000,
    TWICE = 1500; // [ms]: an answer's first bytes, all of it; two presses of Escape
  const NEW = 5000; // [ms] after a press what a robot says of itself is newer than it
  const AGAIN = 1000; // [ms] between two questions whether a robot rests after all
  const MOVES = 30000; // [ms] after a press a robot that moves does so again, even if this page never saw it at rest
  /** @type {Record<string, string>} */
  const SIGNS = { sending: "…", unsent: "✕", failed: "✕", unknown: "?", sent: "→", finished: "✓", after_all: "✓" };
  const ALARMS = ["unsent", "failed", "unknown"],
    RESTS = ["finished", "after_all"];
  const PRESSED = "lumen.pressed"; // a press whose answer nobody can have read yet
  const FRESH = 10000,
    TOLD = 600000; // for so long the next page sends it again, and reports what became of it [ms]
  const SEEN = 2000; // for which its answer stands on a page until it counts as seen there [ms]
  const root = document.documentElement;

  /** @param {string} key */
  const kept = (key) => {
    try {
      return localStorage.getItem(key);
    } catch {
      return null;
    }
  };
  const language = kept("lumen.language") ?? (navigator.language.startsWith("id") ? "id" : "en");
  root.lang = language in WORDS ? language : "en";
  const theme = kept("lumen.theme");
  if (theme) root.dataset.theme = theme;
  const words = () => WORDS[root.lang] ?? WORDS.en;

  const [, , name, page] = location.pathname.split("/");
  const robot = location.pathname.startsWith("/robot/") ? decodeURIComponent(name ?? "") : "*";
  const forVisitors = page === "subtitles";

  const newId = () =>
    Array.from(crypto.getRandomValues(new Uint8Array(16)), (b) => b.toString(16).padStart(2, "0")).join("");

  /**
   * A press of Rest: its message, when it was [ms since 1970], what was told of it, and whether an answer came.
   * @typedef {{ id: string, robot: string, at: number, told?: Told, answered?: boolean }} Press
   * @typedef {[state: string, answer: Answer]} Told
   */

  /**
   * Keep a press of Rest until it is known what became of it, in this window only; null forgets it.
   * @param {Press | null} press
   */
  function remember(press) {
    try {
      if (press) sessionStorage.setItem(PRESSED, JSON.stringify(press));
      else sessionStorage.removeItem(PRESSED);
    } catch {
      /* a private window */
    }
  }
  /** @returns {Press | null} */
  function remembered() {
    try {
      const press = JSON.parse(sessionStorage.getItem(PRESSED) ?? "null");
      return press && Date.now() - press.at < TOLD ? press : null;
    } catch {
      return null;
    }
  }

  /**
   * Send a command, and report its state: sending, unsent, sent, unknown, then finished or failed, with the answer.
   * @param {Record<string, any>} fields
   * @param {Tell} tell
   */
  async function post(fields, tell) {
    const began = performance.now(),
      passed = () => (performance.now() - began) / 1000;
    tell("sending", {});
    const late = setTimeout(() => tell("unsent", { seconds: passed() }), LIMIT);
    let sent = false,
      silent = 0;
    try {
      const answer = await fetch("/api/commands", {
        method: "POST",
        keepalive: true,
        cache: "no-store",
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify({ id: newId(), ...fields }),
      });
      clearTimeout(late);
      sent = answer.ok && answer.headers.get("Lumen-State") !== "unsent";
      if (sent) tell("sent", { seconds: passed() });
      if (sent && fields.command === "rest") silent = setTimeout(() => tell("unknown", { seconds: passed() }), SILENT);
      const said = await answer.json().catch((error) => {
        if (sent) throw error;
        return {};
      });
      tell(sent ? said.state : "unsent", { reason: "", ...said, seconds: passed(), status: answer.status });
    } catch {
      clearTimeout(late);
      tell(sent ? "unknown" : "unsent", { seconds: passed() });
    } finally {
      clearTimeout(silent);
    }
  }

  /**
   * @template {keyof HTMLElementTagNameMap} Tag
   * @param {Tag} tag
   * @param {Record<string, any>} [properties]
   * @returns {HTMLElementTagNameMap[Tag]}
   */
  const make = (tag, properties = {}) => Object.assign(document.createElement(tag), properties);

  /**
   * @param {Press} sent
   * @param {RobotSent[]} robots
   */
  const meantBy = (sent, robots) => robots.filter((one) => sent.robot === "*" || one.robot === sent.robot);
  /** @param {RobotSent[]} meant */
  const rests = (meant) => meant.length > 0 && meant.every((one) => one.stopped && one.connected);

  class RestButton extends HTMLElement {
    presses = 0;
    verifying = false;
    rested = false; // since the last press, in a report of the robots
    /** @type {Press | undefined} */
    sent;
    /** @type {Told | undefined} */
    told;
    /** @type {RobotSent[] | undefined} */
    robots;
    button = make("button", { type: "button", className: "rest" });
    label = make("span");
    whom = make("span", { className: "whom" });
    said = make("div", { className: "rest-said", hidden: true });
    calm = make("p");
    alarm = make("p");
    sign = make("span", { className: "sign" });
    close = make("button", { type: "button", className: "plain" });

    connectedCallback() {
      if (this.button.parentElement || forVisitors) return;
      this.whom.setAttribute("aria-hidden", "true"); // a description says it: the button's name is Rest
      this.button.append(this.label, this.whom);
      this.button.addEventListener("click", () => this.press());
      this.calm.setAttribute("role", "status");
      this.alarm.setAttribute("role", "alert");
      this.sign.setAttribute("aria-hidden", "true");
      this.close.addEventListener("click", () => {
        this.said.hidden = true;
        this.forget(this.sent);
        this.button.focus();
      });
      this.said.append(this.sign, this.calm, this.alarm, this.close);
      this.replaceChildren(this.button, this.said);
      this.speak();
      const before = this.hasAttribute("main") && remembered();
      if (!before) return;
      if (Date.now() - before.at < FRESH)
        this.press(before); // the same message, which the console accepts once
      else this.recall(before);
    }

    speak() {
      // in the page's language
      if (!this.button.parentElement) return;
      this.label.textContent = words().rest ?? "";
      this.close.textContent = words().dismiss ?? "";
      const whom = this.getAttribute("robot") ?? robot;
      this.whom.textContent = whom === "*" ? words().all : whom;
      this.button.setAttribute("aria-description", this.whom.textContent);
      if (this.told && !this.said.hidden) this.show(...this.told);
    }

    /** @param {Press | null} [again] */
    press(again = null) {
      const press = ++this.presses;
      /** @type {Press} */
      const sent = again ?? { id: newId(), robot: this.getAttribute("robot") ?? robot, at: Date.now() };
      this.sent = sent;
      this.rested = false;
      remember(sent);
      post({ id: sent.id, robot: sent.robot, command: "rest" }, (state, answer) => {
        sent.told = [state, answer];
        if (answer.status) {
          sent.answered = true;
          setTimeout(() => this.forget(sent), SEEN);
        }
        if (remembered()?.id === sent.id) remember(sent);
        // The robot may have been resumed since an earlier press: only the last one tells whether it rests.
        if (press === this.presses) this.show(state, answer);
      });
    }

    /** @param {Press} sent */
    recall(sent) {
      // an older press, not sent again: what the page before reported, if that was more than its being sent
      const [state = "unknown", answer] = sent.told ?? [];
      this.sent = sent;
      this.rested = false;
      sent.answered = true;
      this.show([...ALARMS, ...RESTS].includes(state) ? state : "unknown", answer);
      setTimeout(() => this.forget(sent), SEEN);
    }

    /** @param {Press | undefined} sent */
    forget(sent) {
      // the next page need not tell of it
      if (sent?.answered && remembered()?.id === sent.id) remember(null);
    }

    /**
     * Correct what is shown by what the robots report: one may rest after all, and one that rested may move again.
     * @param {RobotSent[]} [robots]
     */
    heed(robots = this.robots) {
      this.robots = robots;
      const { sent } = this;
      if (!robots || !sent || this.said.hidden) return;
      const passed = Date.now() - sent.at,
        meant = meantBy(sent, robots),
        rest = rests(meant);
      const [told = ""] = this.told ?? [];
      if (ALARMS.includes(told)) {
        if (rest && passed >= NEW) this.verify(sent, passed);
      } else if (RESTS.includes(told)) {
        // A report from before the press may come late: a robot moves again only if it was at rest in a report before.
        if (rest) this.rested = true;
        else if (passed >= (this.rested ? NEW : MOVES) && meant.some((one) => !one.stopped && one.connected))
          this.said.hidden = true;
      }
    }

    /**
     * Correct an alarm if the robots still rest by what they answer now. On a slow machine what this page was told last
     * may be of before the press, however long ago that was.
     * @param {Press} sent
     * @param {number} passed since the press [ms]
     */
    async verify(sent, passed) {
      if (this.verifying) return;
      this.verifying = true;
      /** @type {Now | null} */
      const now = await fetch("/api/now", { cache: "no-store", signal: AbortSignal.timeout(NEW) })
        .then((answer) => answer.json())
        .catch(() => null);
      this.verifying = false;
      if (now?.robots) this.robots = now.robots;
      const meant = meantBy(sent, now?.robots ?? []),
        since = Date.parse(now?.time ?? "") - passed + NEW, // by the console's clock
        alarmed = sent === this.sent && !this.said.hidden && ALARMS.includes(this.told?.[0] ?? "");
      if (alarmed && rests(meant) && meant.every((one) => Date.parse(one.heard ?? "") >= since)) this.show("after_all");
      else setTimeout(() => this.heed(), AGAIN); // of a press that came meanwhile, too
    }

    hint() {
      // after one Escape, for as long as the second counts; it hides nothing that was told
      if (!this.said.hidden) return;
      this.show("again");
      setTimeout(() => {
        if (this.told?.[0] === "again") this.said.hidden = true;
      }, TWICE);
    }

    /**
     * @param {string} state
     * @param {Answer} [answer]
     */
    show(state, answer = {}) {
      this.told = [state, answer];
      const seconds = (answer.seconds ?? 0).toLocaleString(root.lang, {
        minimumFractionDigits: 1,
        maximumFractionDigits: 1,
      });
      const reason = globalThis.lumen.inPageLanguage?.(answer.reason ?? "") ?? answer.reason ?? "";
      const text = (words()[state] ?? state).replace("{seconds}", seconds).replace("{reason}", () => reason);
      const alarming = ALARMS.includes(state);
      this.said.hidden = false;
      this.said.dataset.state = state;
      this.sign.textContent = SIGNS[state] ?? "";
      this.calm.textContent = alarming ? "" : text;
      this.alarm.textContent = alarming ? text + (state === "unsent" && reason ? ` (${reason})` : "") : "";
      if (alarming) setTimeout(() => this.heed(), NEW); // the robots may report nothing new meanwhile
      if (RESTS.includes(state)) this.heed();
    }
  }
  customElements.define("rest-button", RestButton);

  const CLOSES = "dialog[open], .sheet:not([hidden])"; // what a press of Escape closes
  let escaped = -Infinity;
  addEventListener(
    "keydown",
    (event) => {
      if (event.key !== "Escape" || event.repeat || forVisitors) return;
      if (document.querySelector(CLOSES)) {
        escaped = -Infinity;
        return;
      } // it closes that, and asks for no rest
      const main = /** @type {RestButton | null} */ (document.querySelector("rest-button[main]")),
        at = event.timeStamp; // a busy page hears keys late
      const twice = at - escaped < TWICE;
      escaped = twice ? -Infinity : at;
      if (twice && main) main.press();
      else if (twice) post({ robot, command: "rest" }, () => {});
      else main?.hint();
    },
    true,
  );

  globalThis.lumen = { post, robot: robot === "*" ? null : robot, page: robot === "*" ? "" : (page ?? "") };
})();
