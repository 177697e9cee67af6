// Where the links of a robot are, as they move: what the view of the hall draws, and nothing of how.
import { parsed } from "../blocks.js";
import { follow as read } from "../follow.js";
import { JOB, get, live } from "../live.js";

const AGAIN = 1000; // [ms]

/** Tell `moved` of each pose, {link: [x, y, z, qw, qx, qy, qz]} in the hall [m], and `failed` why there is none. */
export function follow(robot, moved, failed) {
  let leave = null,
    timer = 0;
  const take = (block) => {
    const [kind, data] = parsed(block) ?? [];
    if (kind === "pose" && data.robot === robot) moved(data.links);
    if (kind === "trouble") failed(data.reason);
  };
  const open = () => {
    end();
    if (!document.hidden)
      leave = read(`/api/poses?robot=${encodeURIComponent(robot)}`, live.role, take, () => {
        timer = setTimeout(open, AGAIN);
      });
  };
  const end = () => {
    leave?.();
    leave = null;
    clearTimeout(timer);
  };
  document.addEventListener("visibilitychange", open);
  open();
  return () => {
    end();
    document.removeEventListener("visibilitychange", open);
  };
}

/** What the links look like: [{name, shapes: [...]}], and the stage. */
export const shape = (robot) => get("/api/shape", { robot }, JOB);
