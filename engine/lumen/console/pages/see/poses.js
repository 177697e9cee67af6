// Where the links of a robot are, as they move: what the view of the hall draws, and nothing of how.
import { get } from "../live.js";

const AGAIN = 1000; // [ms]

/** Tell `moved` of each pose, {link: [x, y, z, qw, qx, qy, qz]} in the hall [m], until what is returned is called. */
export function follow(robot, moved) {
  let stream = null, timer = 0, over = false;
  const open = () => {
    if (over || document.hidden) return;
    stream = new EventSource(`/api/poses?robot=${encodeURIComponent(robot)}`);
    stream.addEventListener("pose", (event) => { const { robot: of, links } = JSON.parse(event.data); if (of === robot) moved(links); });
    stream.addEventListener("error", () => { stream.close(); clearTimeout(timer); timer = setTimeout(open, AGAIN); });
  };
  const seen = () => { stream?.close(); clearTimeout(timer); open(); };
  document.addEventListener("visibilitychange", seen);
  open();
  return () => { over = true; stream?.close(); clearTimeout(timer); document.removeEventListener("visibilitychange", seen); };
}

/** What the links look like: [{name, shapes: [...]}], and the stage. */
export const shape = (robot) => get("/api/shape", { robot });
