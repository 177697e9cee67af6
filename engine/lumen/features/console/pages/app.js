// @ts-check
// The pages: which one the address means, and what stands above each.
import { Told } from "./commands.js";
import { Head } from "./head.js";
import { connect, live } from "./live.js";
import { NowPage } from "./now/page.js";
import { SignIn, askPin } from "./session.js";
import { byId, html, render, t, useEffect, useRedraw, useState } from "./ui.js";
import { Wall } from "./wall.js";

// Loaded when they are looked at: what comes first is Rest and what happens now.
/** @type {Record<string, () => Promise<{ default: (props: { name: string }) => any }>>} */
const LATER = {
  day: () => import("./day/page.js"),
  files: () => import("./files/page.js"),
  fleet: () => import("./fleet/page.js"),
  see: () => import("./see/page.js"),
  subtitles: () => import("./see/subtitles.js"),
};

const FLEET = location.pathname === "/fleet"; // many houses: of no robot here
if (FLEET) lumen.page = "fleet";

/** @param {{ page: string, name?: string }} props */
function Later({ page, name }) {
  const [Page, set] = useState(/** @type {Function | null} */ (null)),
    [failed, fail] = useState(false);
  useEffect(() => {
    LATER[page]().then(
      (found) => set(() => found.default),
      () => fail(true),
    );
  }, []);
  if (failed) return html`<p class="notice">${t("page.failed")}</p>`;
  return Page ? html`<${Page} name=${name} />` : html`<p class="notice">${t("loading")}</p>`;
}

function Main() {
  useRedraw();
  if (live.role === null) return html`<p class="notice">${t(live.state === "away" ? "server.away" : "loading")}</p>`;
  if (lumen.page === "subtitles") return html`<${Later} page="subtitles" name=${lumen.robot} />`;
  if (live.role === "nobody") {
    return html`<div class="notice"><h1>${t("locked")}</h1><p>${t("locked.more")}</p>
      <button type="button" class="strong" onClick=${askPin}>${t("sign.in")}</button></div>`;
  }
  if (FLEET) return html`<${Later} page="fleet" />`;
  const names = [...live.robots.keys()],
    name = lumen.robot ?? (names.length === 1 ? names[0] : null);
  const here = [...live.robots.values()].some((robot) => robot.connected !== false);
  if (live.fleet && !lumen.robot && !here) return html`<${Later} page="fleet" />`; // a centre has no robot of its own
  if (!names.length) return html`<p class="notice">${t("no.robots")}</p>`;
  if (name === null) return html`<${Wall} />`;
  if (!live.robots.has(name)) return html`<p class="notice">${t("no.robot", { name })}</p>`;
  return lumen.page in LATER ? html`<${Later} page=${lumen.page} name=${name} />` : html`<${NowPage} name=${name} />`;
}

byId("skip").textContent = t("skip");
document.body.dataset.page = lumen.page || (lumen.robot ? "now" : "home");
if (lumen.page !== "subtitles") {
  render(html`<${Head} />`, byId("head"));
  render(html`<${Told} /><${SignIn} />`, byId("told"));
}
render(html`<${Main} />`, byId("main"));
connect();
