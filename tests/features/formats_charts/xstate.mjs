// What XState makes of machines that `lumen export xstate` wrote: a list of {config, events} comes in as JSON, and for
// each the active states (their paths) at first and after each event go out, with the context. `tick` lets the next
// timer end. Guards and assignments are run as JavaScript: the tests write only such that mean the same in both.

import { readFileSync } from "node:fs";

const { SimulatedClock, assign, createActor, fromCallback, raise, setup } = await import(process.argv[2]);
const value = (source, { context, event }) =>
  typeof source === "string"
    ? new Function("context", "event", `return ${source}`)(context, { name: event.type, data: event.data })
    : source;
const nothing = () => {};
const never = fromCallback(() => {}); // an actor that is there and does not end by itself
const known = setup({
  actors: new Proxy({}, { get: () => never }),
  guards: { "lumen.expression": (scope, params) => value(params.source, scope) },
  actions: new Proxy(
    {
      "lumen.assign": assign((scope, params) =>
        Object.fromEntries(Object.entries(params).map(([key, source]) => [key, value(source, scope)])),
      ),
      "lumen.raise": raise((_, params) => ({ type: params.value })),
    },
    { get: (table, name) => table[name] ?? nothing },
  ),
});

const paths = (snapshot) => snapshot._nodes.map((node) => node.path.join(".")).filter(Boolean).sort();

function run({ config, events }) {
  const clock = new SimulatedClock();
  const actor = createActor(known.createMachine(config), { clock }).start();
  const seen = [[paths(actor.getSnapshot()), actor.getSnapshot().context]];
  for (const event of events) {
    if (typeof event === "number") clock.increment(event);
    else actor.send({ type: event, data: {} });
    seen.push([paths(actor.getSnapshot()), actor.getSnapshot().context]);
  }
  return seen;
}

function tried(row) {
  try {
    return run(row);
  } catch (error) {
    process.stderr.write(`${error}\n`);
    return null; // XState refuses the machine
  }
}

process.stdout.write(JSON.stringify(JSON.parse(readFileSync(0, "utf8")).map(tried)));
