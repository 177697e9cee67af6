// Reads a recording twice, as a stream and by its index, with all checksums; prints what was found as JSON.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const [folder, file] = process.argv.slice(2);
const require = createRequire(`${folder}/node_modules/`);
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const { decompress } = require("fzstd");

const data = readFileSync(file);
const decompressHandlers = { zstd: (packed, size) => decompress(packed, new Uint8Array(Number(size))) };
const readable = {
  size: async () => BigInt(data.length),
  read: async (offset, length) => data.subarray(Number(offset), Number(offset + length)),
};

const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true, includeChunks: true });
stream.append(data);
const records = {};
for (let record; (record = stream.nextRecord()); ) records[record.type] = (records[record.type] ?? 0) + 1;

const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const topics = {};
let [before, inOrder] = [0n, true];
for await (const message of reader.readMessages({ validateCrcs: true })) {
  const channel = reader.channelsById.get(message.channelId);
  const row = (topics[channel.topic] ??= { schema: reader.schemasById.get(channel.schemaId).name, count: 0 });
  row.count += 1;
  inOrder &&= message.logTime >= before;
  before = message.logTime;
}
const attachments = [];
for await (const attachment of reader.readAttachments({ validateCrcs: true })) attachments.push(attachment.name);
const counted = Number(reader.statistics.messageCount);
console.log(JSON.stringify({ done: stream.done(), records, topics, inOrder, attachments, counted }));
