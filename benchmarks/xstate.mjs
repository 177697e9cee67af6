// XState's events per second of CPU time, as JSON: the machines of statechart.py through its pure transition function,
// which makes an actor's scope for each call; through the machine's own transition with one scope for all of them, the
// fastest way there is and no public one; and through an actor. Medians of 7 runs of about 0.25 s each, after one to
// warm up.
//
//     node xstate.mjs 15 150 1500

import { readFileSync } from "node:fs";
import { assign, createActor, createMachine, initialTransition, transition } from "xstate";

const RUNS = 7, SECONDS = 0.25;
const turn = (target) => ({
  target,
  guard: ({ context }) => context.n < 1_000_000_000,
  actions: assign({ n: ({ context }) => context.n + 1 }),
});

function ring(size) {
  const states = {};
  for (let i = 0; i < size; i++) states[`s${i}`] = { on: { go: turn(`s${(i + 1) % size}`) } };
  return createMachine({ context: { n: 0 }, initial: "s0", states });
}

function regions() {
  const left = { initial: "a", states: { a: { on: { go: turn("b") } }, b: { on: { go: turn("a") } } } };
  const right = { initial: "a", states: { a: { on: { go: "b" } }, b: { on: { go: "a" } } } };
  const both = { type: "parallel", states: { left, right } };
  return createMachine({ context: { n: 0 }, initial: "both", states: { both } });
}

const go = { type: "go" };

function pure(machine, count) {
  let [snapshot] = initialTransition(machine);
  for (let i = 0; i < count; i++) [snapshot] = transition(machine, snapshot, go);
  return snapshot.context.n;
}

function scoped(machine, count) {
  const scope = createActor(machine)._actorScope;
  let snapshot = machine.getInitialSnapshot(scope);
  for (let i = 0; i < count; i++) snapshot = machine.transition(snapshot, go, scope);
  return snapshot.context.n;
}

function actor(machine, count) {
  const running = createActor(machine).start();
  for (let i = 0; i < count; i++) running.send(go);
  return running.getSnapshot().context.n;
}

function time(work, machine, count) {
  const start = process.cpuUsage();
  const done = work(machine, count);
  const { user, system } = process.cpuUsage(start);
  if (done !== count) throw new Error(`${count} events made ${done} assignments`);
  return (user + system) / 1e6;
}

function rate(work, machine) {
  let count = 100, spent;
  while ((spent = time(work, machine, count)) < SECONDS / 5) count *= 4;
  count = Math.max(count, Math.trunc((count * SECONDS) / spent));
  const runs = Array.from({ length: RUNS }, () => time(work, machine, count)).sort((a, b) => a - b);
  return count / runs[(RUNS - 1) / 2];
}

const sizes = process.argv.slice(2).map(Number);
const result = { node: process.versions.node, version: JSON.parse(readFileSync("node_modules/xstate/package.json")).version };
for (const [name, work] of Object.entries({ pure, scoped, actor })) {
  result[name] = {};
  for (const size of sizes) result[name][`${size.toLocaleString("en-US")} states`] = rate(work, ring(size));
  result[name].regions = rate(work, regions());
}
console.log(JSON.stringify(result));
