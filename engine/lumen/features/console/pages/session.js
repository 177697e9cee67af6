// @ts-check
// Who is here: nobody, show, operator or author, and as what of these the page is shown.
/** @import { Role } from "./types" */
import { connect, live } from "./live.js";
import { Quote, reasonOf } from "./quoted.js";
import { Dialog, html, keep, kept, redraw, t, useRedraw, useState, typed } from "./ui.js";

/** @type {Role[]} */
export const ROLES = ["nobody", "show", "operator", "author"];
let asking = false;

/** As what the page is shown: what was chosen, never above the role; an author begins as operator. */
export function mode() {
  const role = live.role ?? "nobody",
    chosen = /** @type {Role} */ (kept("lumen.mode") ?? "operator");
  return ROLES[Math.min(ROLES.indexOf(role), Math.max(1, ROLES.indexOf(chosen)))];
}
/** @param {Role} role */
export const may = (role) => ROLES.indexOf(mode()) >= ROLES.indexOf(role);
/**
 * Whether the person has this role, as whatever the page is shown: what is wrong in files concerns authors in any mode.
 * @param {Role} role
 */
export const holds = (role) => ROLES.indexOf(live.role ?? "nobody") >= ROLES.indexOf(role);
/** @param {string} as */
export function show(as) {
  keep("lumen.mode", as);
  redraw();
}
export function askPin() {
  asking = true;
  redraw();
}

export async function leave() {
  await fetch("/api/session", { method: "DELETE", headers: { "Content-Type": "application/json" } }).catch(() => {});
  connect();
}

export function SignIn() {
  useRedraw();
  const [wrong, setWrong] = useState(""),
    [pin, setPin] = useState(""),
    [name, setName] = useState("");
  if (!asking) return null;
  const close = () => {
    asking = false;
    setPin("");
    setWrong("");
    redraw();
  };
  const enter = async (/** @type {SubmitEvent} */ event) => {
    event.preventDefault();
    try {
      const answer = await fetch("/api/session", {
        method: "POST",
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify({ pin, name }),
        signal: AbortSignal.timeout(20000),
      });
      const said = await answer.json().catch(() => ({}));
      if (answer.ok) {
        close();
        connect();
      } else setWrong(said.reason ?? said.detail ?? `${answer.status}`);
    } catch (error) {
      setWrong(reasonOf(error));
    }
  };
  return html`<${Dialog} title=${t("sign.in")} onClose=${close} actions=${html`<button form="pin"
    class="strong">${t("sign.in")}</button>`}>
    <form id="pin" class="fields" onSubmit=${enter}>
      <label>${t("pin")}<input type="password" inputmode="numeric" autocomplete="current-password" required autofocus
        aria-describedby="pin-wrong" value=${pin} onInput=${typed(setPin)} /></label>
      <label>${t("your.name")}<input autocomplete="name" maxlength="60" value=${name}
        onInput=${typed(setName)} /></label>
      <p id="pin-wrong" class="bad" role="alert"><${Quote} text=${wrong} /></p></form></${Dialog}>`;
}
