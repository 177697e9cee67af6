// What the server sends to the pages, and what they share: types for authors of pages, which are not installed.
// Times are ISO 8601 in UTC unless a unit is named. Keys that a page must not count on are optional:
// a robot that has not answered yet has few of them, and so has each robot for a person without a role.

export type Role = "nobody" | "show" | "operator" | "author";

/** Where something is written; both are null if that is unknown. */
export interface Place {
  file: string | null;
  line: number | null;
}

/** Values by their names, as the behaviour or a message has them. */
export type Data = Record<string, any>;

/** A text, or one for each language, as YAML has it. */
export type Texts = string | Record<string, string>;

/** An active state, with those that are active inside it. */
export interface State extends Place {
  path: string;
  name: string;
  since: string;
  children: State[];
}

/** A transition out of an active state, and whether it could be taken now; if not, `why`. */
export interface Way extends Place {
  source: string;
  event: string;
  targets: string[];
  due: string | null;
  open: boolean;
  guard: Guard | null;
  why: string;
}

/** A condition; `true` is null if it depends on the event. */
export interface Guard {
  text: string;
  true: boolean | null;
  values: Data;
}

/** A button that the behaviour declares. */
export interface Button {
  label: Texts;
  event: string;
  data: Data | null;
  confirm: "hold" | "ask" | null;
  key: string | null;
  state: string;
  enabled: boolean;
  reason: string;
}

/** An event that waits for a person's GO, and what the robot `would` do. */
export interface Approval extends Place {
  id: string;
  event: string;
  data: Data | null;
  source: string;
  targets: string[];
  since: string;
  until: string | null;
  else: string;
  would: Deed[];
}

/** A command of a robot, in words: its verb, and its fields. */
export interface Deed {
  verb: string;
  [field: string]: any;
}

export interface Saying {
  text: string;
  language: string;
  since: string;
}

/** A motion under way; `progress` is from 0 to 1, null if its length is unknown. */
export interface Motion {
  verb: string;
  name: string;
  since: string;
  progress: number | null;
}

/** A process of the exhibition, and the parts that run in it. */
export interface Process {
  parts: string[];
  since: string;
  state: string;
  host: string;
  process: any;
  heard: string;
  word?: string;
  /** The states of the skills that it performs. */
  skills?: Record<string, SkillState>;
}

/** The state of a skill; `crashes` counts the times that its program crashed or was killed. */
export interface SkillState {
  state: string;
  since: string;
  crashes: number;
  trouble: string;
}

/** A module of the project's own; `reason` is why it was lost. `restarts` is missing if another machine runs it. */
export interface OwnModule {
  module: string;
  state: string;
  since: string;
  reason: string | null;
  restarts?: number;
}

/** The readings of a robot: a number for each joint or side, or one without a name. */
export type Reading = number | Record<string, unknown>;
export interface Senses {
  battery?: { percentage?: number; [more: string]: unknown };
  sonar?: { leftSensor?: number | null; rightSensor?: number | null; [more: string]: unknown };
  temperatures?: Reading;
}

/** A face that the camera sees now: its place in the image [px of 320 x 240]; no `name` if it is unknown. */
export interface Face {
  x: number;
  y: number;
  name: string;
}

export interface LastReload {
  at: string;
  verdict: string;
  bundle: string;
  text: string;
}

/** A robot in `/api/now` and in each event `now`. */
export interface RobotSent {
  robot: string;
  connected: boolean;
  /** When it answered last; null if it never did. */
  heard: string | null;
  stopped?: boolean;
  stopped_by?: string | null;
  saying?: Saying | null;
  language?: string;
  languages?: string[];
  /** How far its exhibition's clock is ahead of the console's [s]. */
  ahead?: number;
  /** The time of its exhibition. */
  time?: string;
  since?: string;
  position?: number;
  configuration?: string[];
  states?: State[];
  motion?: Motion | null;
  visitor?: string | null;
  visitor_said?: { text: string; at: string } | null;
  ways?: Way[];
  buttons?: Button[];
  waiting?: Approval[];
  autonomy?: "ask" | "alone";
  model?: "on" | "off" | null;
  timers?: { event: string; due: string }[];
  queues?: { events: number; commands: number };
  motions?: string[];
  postures?: string[];
  events?: string[];
  /** [%] */
  battery?: number | null;
  ears?: { because: string; [more: string]: unknown } | null;
  realtime?: number;
  /** The hash of the files that run. */
  bundle?: string;
  last_reload?: LastReload | null;
  modules?: OwnModule[];
  skill_states?: Record<string, SkillState>;
  senses?: Senses;
  processes?: Process[];
  files?: Partial<Files>;
  seen?: { faces: Face[] };
}

/** A robot as the pages know it; see `robotOf` in live.js. */
export interface Robot extends RobotSent {
  skew: number;
  now: () => number;
}

/** `/api/now` */
export interface Now {
  robots: RobotSent[];
  role: Role;
  name: string;
  time: string;
  /** Why the console is not connected to the bus; empty if it is. */
  bus: string;
  fleet: boolean;
}

/** An entry of a robot's journal, with its line of text and its kind. */
export interface Entry {
  robot: string;
  position: number;
  /** Seconds of the exhibition's run [s]. */
  at: number;
  at_time: string;
  text: string;
  texts?: Record<string, string>;
  kind: string;
  heard?: string;
  timer?: string;
  goto?: string;
  jump?: string;
  data?: Data | null;
  cause?: any[] | null;
  entered?: string[];
  exited?: string[];
  commands?: Data[];
  said?: Data;
  [more: string]: any;
}

/** An outcome of a command, as the console answers; see commands.py. */
export interface CommandSent {
  robot: string;
  command: string;
  by: string;
  id: string;
  state: string;
  seconds: number;
  reason: string;
  [more: string]: any;
}

/** An event of `/api/events`: its kind, and its data. */
export type LiveEvent = ["entry", Entry] | ["now", RobotSent] | ["command", CommandSent];

/** The answer to a command of this page, so far as it has come. */
export interface Answer {
  seconds?: number;
  reason?: string;
  status?: number;
  answer?: Data | null;
}

/** Called with the state of a command (`sending`, `sent`, `finished` …) each time that it changes. */
export type Tell = (state: string, answer: Answer) => void;

/** `/api/day`: positions are those of the journal. */
export interface Day {
  date: string;
  dates: string[];
  visits: Visit[];
  between: Stretch[];
  marks: { position: number; at: string; text: string; by: string }[];
  numbers: DayNumbers;
}

/** A part of a day: a visit, which has a number, or what happened between two. */
export interface Stretch {
  from: number;
  to: number;
  began: string;
  ended: string;
  n?: number;
  /** Of a visit: how long it took [s]. */
  seconds?: number;
  visitor?: string | null;
  language?: string | null;
  asked?: number;
  missed?: number;
}
export interface Visit extends Stretch {
  n: number;
  seconds: number;
}

/** A text and how often it came. */
export type Count = [string, number];

export interface DayNumbers {
  visits: number;
  mean_seconds: number | null;
  longest_seconds: number | null;
  falls: number;
  hours: [number, number][];
  unanswered: Unanswered[];
  said: Heard[];
  /** The rows of `hears` of each state, by `BEHAVIOR STATE`. */
  rows: Record<string, string[]>;
  asked: Count[];
  missed: Count[];
  answers: Count[];
  languages: Count[];
}
export interface Unanswered {
  text: string;
  language: string;
  count: number;
}

/** What visitors said: the states that heard it, `[behavior, state]`, and the row that matched, if any. */
export interface Heard {
  text: string;
  language: string;
  states: [string, string][];
  row: string;
  count: number;
}

/** `/api/entries` and `/api/search` */
export interface Entries {
  entries: Entry[];
  more?: boolean;
}

/** A link of the chain of `/api/why`. */
export interface Link extends Place {
  kind: string;
  text: string;
  at: string;
  values: Data | null;
}

/** `/api/skills` */
export interface Skills {
  skills: Skill[];
}

/** A skill from its manifest; only its name is known if its files are on another machine, and `kind` is empty. */
export interface Skill {
  name: string;
  file?: string;
  description: Texts;
  /** How it is performed: `python`, `command` or `module`, with its `target`. */
  kind: string;
  target?: string;
  arguments: Record<string, ArgumentSchema>;
  required: string[];
}

/** The JSON Schema of an argument, with the keys that the page uses. */
export interface ArgumentSchema {
  type?: string;
  enum?: unknown[];
  default?: unknown;
  description?: Texts;
  minimum?: number;
  maximum?: number;
  format?: string;
  [more: string]: unknown;
}

/** GET `/api/sentence`: what the robot said, and the places of the text in the files, the most probable first. */
export interface FoundSentence {
  text: string;
  language: string;
  source: "operator" | "model" | "file" | "nowhere";
  places: SentencePlace[];
}

/** A text in a file; `texts` are by language, by the empty name if the text is for every language. */
export interface SentencePlace {
  file: string;
  line: number;
  /** The path of the text in its file, and its number among its alternatives. */
  around: (string | number)[];
  alternative: number | null;
  texts: Record<string, string>;
  /** A hash of the file. */
  version: string;
  editable: boolean;
}

/** POST `/api/sentence`: a new wording that was checked, and `written` or not; `faulty` if lint found an error. */
export interface Reworded {
  file: string;
  line: number;
  version: string;
  written: boolean;
  faulty: boolean;
  findings: Diagnostic[];
  changes: { language: string; was: string; now: string }[];
  /** The files of stories that have the former text. */
  stories: string[];
}

/** `/api/fork`: what was, and what would have been. */
export interface Forked {
  was: Entry[];
  would: Entry[];
  trouble?: string;
  reason?: string;
}

/** `/api/chart`; lengths are in px. */
export interface Chart {
  behavior: string;
  width: number;
  height: number;
  boxes: ChartBox[];
  lines: string[];
}
export interface ChartBox {
  path: string;
  name: string;
  title: string;
  rows: { text: string; y: number }[];
  depth: number;
  leaf: boolean;
  final: boolean;
  first: boolean;
  x: number;
  y: number;
  width: number;
  height: number;
  text: [number, number];
}

export interface Diagnostic {
  file: string;
  line: number;
  column: number;
  code: string;
  severity: "error" | "warning" | "info";
  message: string;
  hint: string;
  [more: string]: unknown;
}

/** What a reload came to; see `ReloadReport.to_json`. */
export interface Report {
  verdict: string;
  reason?: string;
  hint?: string;
  risk?: string;
  changes?: string[];
  details?: Change[];
  restart?: string[];
  diagnostics?: Diagnostic[];
  lines?: string[];
  notes?: string[];
  [more: string]: unknown;
}
export interface Change extends Place {
  was?: string;
  now?: string;
  [more: string]: unknown;
}

/** `/api/files`: the status of saved files, the last report, and the last visits with these files. */
export interface Files extends Report {
  mode: string;
  staged: string[] | null;
  waiting: string;
  trial?: boolean;
  last: Report | null;
  replay?: Replay | null;
}
export interface Replay {
  visits: number;
  steps: number;
  same: number;
  differ: { visit: number; at: string; was: string; is: string; [more: string]: unknown }[];
  [more: string]: unknown;
}

/** `/api/prepared` */
export interface Prepared {
  text: string;
  language: string;
}

/** `/api/fleet` */
export interface Fleet {
  houses: House[];
  robots: FleetRobot[];
  rollout: Rollout | null;
  centre?: { overruled?: string; [more: string]: unknown };
  trouble?: string;
  [more: string]: unknown;
}
export interface House {
  name: string;
  robots: number;
  here: number;
  [more: string]: unknown;
}
export interface FleetRobot {
  name: string;
  house: string;
  bundle: string;
  state: string;
  here: boolean;
  pinned: boolean;
  trouble: string;
  [more: string]: unknown;
}
export interface Rollout {
  bundle: string;
  state: string;
  reason: string;
  step: number;
  steps: { to: string; most: number; done: boolean; [more: string]: unknown }[];
  assigned: string[];
  watched: number;
  pause: number;
  "abort-if"?: string;
  [more: string]: unknown;
}

/** `/api/shape`: the links of a robot with their shapes [m], and the stage. */
export interface Form {
  robot: string;
  links: { name: string; shapes: Shape[] }[];
  stage: { x: [number, number]; y: [number, number] } | null;
}
export interface Shape {
  kind: string;
  position: number[];
  rotation: number[];
  size: number[];
  colour: number[];
  vertices: number[][];
  faces: number[][];
}

/** x, y, z [m] and the rotation w, i, j, k of each link. */
export type Pose = Record<string, number[]>;

/** `<rest-button>`: made by rest.js, or by the browser alone if that did not load. */
export interface RestButton extends HTMLElement {
  presses: number;
  speak(): void;
  heed(robots?: RobotSent[]): void;
  press(again?: unknown): void;
  hint(): void;
}

declare global {
  /** What rest.js gives the modules of the page. */
  var lumen: {
    /** Send a command under a new id, or its own. */
    post(fields: Data, tell: Tell): Promise<void>;
    /** The robot in the address; null for all. */
    robot: string | null;
    /** The page in the address: empty for Now, or for the wall. */
    page: string;
    inPageLanguage?: (text: string) => string;
  };
  interface HTMLElementTagNameMap {
    "rest-button": RestButton;
  }
}

/** What a module has as its global object if it runs as a shared worker. */
export interface SharedWorkerScope {
  onconnect: (event: MessageEvent) => void;
}
