// @ts-check
// See: what the robot's camera sees with what the eyes found in it, and the robot in its hall.
import { robotOf } from "../live.js";
import { Quote } from "../quoted.js";
import { Choice, Part, html, kept, keep, t, useEffect, useRedraw, useRef, useState } from "../ui.js";
import { Hall } from "./hall.js";

const WIDTH = 320,
  HEIGHT = 240,
  BOX = 56; // [px]: what places in the image are given in, and about a face
const PATIENCE = 4000,
  NEXT = 200,
  AGAIN = 1000; // [ms] for a first picture, after one, and where there was none

// Pictures are asked for one by one: each takes a connection for a moment, and not one of the browser's six for ever.
/** @param {{ name: string }} props */
function Camera({ name }) {
  const [state, set] = useState("waiting"),
    [number, show] = useState(0),
    timer = useRef(0);
  const next = (/** @type {number} */ after) => {
    clearTimeout(timer.current);
    timer.current = setTimeout(() => {
      if (!document.hidden) show((n) => n + 1);
    }, after);
  };
  const got = (/** @type {string} */ what, /** @type {number} */ after) => {
    if (what) set(what);
    next(after);
  };
  useEffect(() => {
    const look = () => next(0),
      late = setTimeout(() => set((now) => (now === "waiting" ? "gone" : now)), PATIENCE);
    document.addEventListener("visibilitychange", look);
    return () => {
      document.removeEventListener("visibilitychange", look);
      clearTimeout(late);
      clearTimeout(timer.current);
    };
  }, []);
  const faces = robotOf(name)?.seen?.faces ?? [];
  const named = faces.map((face) => `${face.name || t("see.face")} (${face.x}, ${face.y})`);
  return html`<${Part} title=${t("see.camera")} kind="camera"><div class="picture">
      <img src="/camera/${encodeURIComponent(name)}?still=${number}" alt=${t("see.alt", { name })} width=${WIDTH}
        height=${HEIGHT} class=${state === "seen" ? "" : "unseen"}
        onLoad=${() => got("seen", NEXT)} onError=${() => got(state === "seen" ? "gone" : "", AGAIN)} />
      <svg viewBox="0 0 ${WIDTH} ${HEIGHT}" aria-hidden="true">${faces.map(
        (face) => html`<g><rect x=${face.x - BOX / 2} y=${face.y - BOX / 2} width=${BOX} height=${BOX} rx="4" />
        <text x=${face.x - BOX / 2} y=${face.y - BOX / 2 - 5}>${face.name || t("see.face")}</text></g>`,
      )}</svg></div>
    ${state === "gone" && html`<p class="quiet" role="status">${t("see.none")}</p>`}
    <h3>${t("see.found")}</h3>
      <p>${named.length ? named.join(" · ") : html`<span class="quiet">${t("see.found.none")}</span>`}</p></${Part}>`;
}

/** @param {{ name: string }} props */
export default function SeePage({ name }) {
  useRedraw();
  const [view, set] = useState(kept("lumen.see") ?? "camera");
  const choose = (/** @type {string} */ one) => {
    keep("lumen.see", one);
    set(one);
  };
  return html`<div class="page-head"><h1>${t("page.see")}</h1><${Choice} legend=${t("page.see")}
      name="view" titled=${false} value=${view} choose=${choose}
      options=${["camera", "hall"].map((one) => [one, t(`see.${one}`)])} /></div>
    ${
      view === "camera"
        ? html`<${Camera} name=${name} />`
        : html`<${Hall} name=${name}
      instead=${(
        /** @type {string} */ why,
        /** @type {string} */ reason,
      ) => html`<p class="notice">${t(why)} ${reason && html`(<${Quote} text=${reason} />)`}</p>
      <${Camera} name=${name} />`} />`
    }`;
}
