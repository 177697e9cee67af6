// @ts-check
// The robot in its hall, drawn from poses; where there is no WebGL, or nothing to draw, the camera stands in.
import { Quote } from "../quoted.js";
import { Part, html, t, useEffect, useRef, useState } from "../ui.js";
import { follow, shape } from "./poses.js";

/** @param {{ name: string, instead: (why: string, reason: string) => any }} props */
export function Hall({ name, instead }) {
  const canvas = useRef(/** @type {(HTMLCanvasElement & { scene?: unknown }) | null} */ (null)),
    [failed, fail] = useState(""),
    [moved, move] = useState(0),
    [trouble, say] = useState("");
  useEffect(() => {
    const there = canvas.current;
    if (!there) return undefined;
    let end = () => {},
      over = false;
    (async () => {
      if (!document.createElement("canvas").getContext("webgl2")) return fail("see.nogl");
      const [{ Scene }, form] = await Promise.all([import("./scene.js"), shape(name)]);
      if (over) return undefined;
      const scene = new Scene(there, form);
      there.scene = scene; // tests ask it what is drawn
      const stop = follow(
        name,
        (links) => {
          scene.pose(links);
          move((n) => n + 1);
          say("");
        },
        say,
      );
      end = () => {
        stop();
        scene.close();
      };
      return undefined;
    })().catch((error) => {
      say(error.status ? error.message : "");
      fail("see.noshape");
    });
    return () => {
      over = true;
      end();
    };
  }, [name, failed]);
  if (failed) return instead(failed, trouble);
  return html`<${Part} title=${t("see.hall")} kind="hall"><div class="picture">
    <canvas ref=${canvas} role="img" aria-label=${t("see.alt.hall", { name })} data-poses=${moved}></canvas></div>
    ${trouble && html`<p class="notice" role="status"><${Quote} text=${trouble} /></p>`}
    ${moved === 0 && html`<p class="quiet" role="status">${t("see.waiting")}</p>`}</${Part}>`;
}
