// @ts-check
// Subtitles: what the robot says, for a screen beside it, in the visitor's language; it has no controls.
/** @import { Saying } from "../types" */
import { live, robotOf } from "../live.js";
import { html, t, useEffect, useRedraw, useState } from "../ui.js";

const STAYS = 4000; // [ms] that a sentence stays after it was said

/** @param {{ name: string }} props */
export default function Subtitles({ name }) {
  useRedraw();
  const robot = robotOf(name),
    said = robot?.saying ?? null;
  const [shown, show] = useState(/** @type {Saying | null} */ (null));
  useEffect(() => {
    if (said) {
      show(said);
      return undefined;
    }
    const timer = setTimeout(() => show(null), STAYS);
    return () => clearTimeout(timer);
  }, [said?.text, said?.since]);
  const spoken = robot?.language ?? "en";
  useEffect(() => {
    if (["en", "id"].includes(spoken)) document.documentElement.lang = spoken;
  }, [spoken]);
  const away = live.state !== "live" || !robot || robot.connected === false;
  const text = shown?.text ?? "";
  return html`<div class="subtitles"><h1 class="hidden">${t("page.subtitles")}</h1>
    <p class="subtitle ${text.length > 120 ? "long" : ""}" lang=${shown?.language || spoken}
      aria-live="polite">${text}</p>
    <p class="subtitle-away" role="status">${away ? t("subtitles.away") : ""}</p></div>`;
}
