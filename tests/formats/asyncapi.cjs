// Parses AsyncAPI documents with AsyncAPI's own parser, whose folder is the argument: a JSON list of texts on standard
// input, a list of findings out.
globalThis.window = globalThis.self = globalThis;
const Parser = require(process.argv[2] + "/browser/index.js");
const parser = new Parser();

async function parse(text) {
  const { document, diagnostics } = await parser.parse(text);
  const channels = document ? document.allChannels().all() : [];
  const operations = document ? document.operations().all() : [];
  return {
    errors: diagnostics.filter((d) => d.severity === 0).map((d) => d.message),
    channels: Object.fromEntries(channels.map((c) => [c.id(), c.address()])),
    actions: Object.fromEntries(operations.map((o) => [o.id(), o.action()])),
    payloads: Object.fromEntries(channels.map((c) => [c.id(), c.messages().all().map((m) => m.payload()?.json())])),
  };
}

(async () => {
  const found = [];
  for (const text of JSON.parse(require("fs").readFileSync(0, "utf8"))) found.push(await parse(text));
  console.log(JSON.stringify(found));
})();
