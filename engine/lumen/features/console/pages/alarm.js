// @ts-check
// An alarm where a person looks elsewhere: in the window's title and icon, and as a sound if the person wants one.
import { kept, t } from "./ui.js";

const TONES = [880, 660, 880],
  TONE = 0.18; // [Hz], [s] each
const HEARD = "lumen.alarms"; // those that this window has sounded for, on this page or the one before

/** @param {string[]} now */
function heard(now) {
  try {
    const before = new Set((sessionStorage.getItem(HEARD) ?? "").split("\n"));
    sessionStorage.setItem(HEARD, [...now].join("\n"));
    return now.every((one) => before.has(one));
  } catch {
    return false; /* a private window */
  }
}

function sound() {
  const player = new AudioContext();
  TONES.forEach((pitch, n) => {
    const tone = player.createOscillator(),
      volume = player.createGain();
    tone.frequency.value = pitch;
    volume.gain.value = 0.2;
    tone.connect(volume).connect(player.destination);
    tone.start(n * TONE);
    tone.stop((n + 1) * TONE);
    if (n === TONES.length - 1) tone.onended = () => player.close();
  });
}

/**
 * Show alarms, `[robot, kind, when]` each, before the title; a new one is heard. While they are not known: null.
 * @param {[robot: string, kind: string, when: string][] | null} alarms
 * @param {string} title
 */
function show(alarms, title) {
  const unheard = alarms !== null && !heard(alarms.map((one) => one.join(" ")));
  if (unheard && kept("lumen.sound") === "on") sound();
  const [first] = alarms ?? [];
  document.title = first ? `⚠ ${first[0]}: ${t(`alarm.${first[1]}`)} · ${title}` : title;
  const icon = document.querySelector("link[rel=icon]"),
    wanted = `/pages/look/icon${first ? "-alarm" : ""}.svg`;
  if (icon && icon.getAttribute("href") !== wanted) icon.setAttribute("href", wanted);
}

export const alarm = { show, sound };
