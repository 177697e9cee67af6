// @ts-check
// Where the links of a robot are, as they move: what the view of the hall draws, and nothing of how.
/** @import { Form, Pose } from "../types" */
import { parsed } from "../blocks.js";
import { follow as read } from "../follow.js";
import { JOB, get, live } from "../live.js";

const AGAIN = 1000; // [ms]

/**
 * Tell `moved` of each pose, {link: [x, y, z, qw, qx, qy, qz]} in the hall [m], and `failed` why there is none.
 * @param {string} robot
 * @param {(links: Pose) => void} moved
 * @param {(reason: string) => void} failed
 */
export function follow(robot, moved, failed) {
  /** @type {(() => void) | null} */
  let leave = null,
    timer = 0;
  const take = (/** @type {string} */ block) => {
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

/**
 * What the links look like: [{name, shapes: [...]}], and the stage.
 * @param {string} robot
 * @returns {Promise<Form>}
 */
export const shape = (robot) => get("/api/shape", { robot }, JOB);
