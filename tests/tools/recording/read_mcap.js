// node read_mcap.js NODE_MODULES FILE.mcap: reads the file with the reader of the format's authors, in
// order and by its index, with all checksums; holds every message against its schema; prints what
// there is as one JSON document.
"use strict";
const fs = require("fs");
const path = require("path");
const [modules, file] = process.argv.slice(2);
const { McapIndexedReader, McapStreamReader } = require(path.join(modules, "@mcap/core"));
const { crc32 } = require(path.join(modules, "@foxglove/crc"));

const fail = (why) => { throw new Error(why); };

const is = {
  object: (v) => v !== null && typeof v === "object" && !Array.isArray(v),
  array: Array.isArray,
  number: (v) => typeof v === "number" && Number.isFinite(v),
  integer: Number.isInteger,
  string: (v) => typeof v === "string",
  boolean: (v) => typeof v === "boolean",
};

function check(schema, value, where) {
  if (!is[schema.type](value)) fail(`${where} is no ${schema.type}`);
  if (schema.minimum !== undefined && value < schema.minimum) fail(`${where} is too small`);
  if (schema.maximum !== undefined && value > schema.maximum) fail(`${where} is too large`);
  for (const [i, item] of schema.type === "array" ? value.entries() : []) check(schema.items, item, `${where}/${i}`);
  for (const [name, part] of Object.entries(schema.properties ?? {})) check(part, value[name], `${where}/${name}`);
}

(async () => {
  const bytes = fs.readFileSync(file);
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
  };

  // In order.
  const stream = new McapStreamReader({ includeChunks: true, validateCrcs: true });
  stream.append(new Uint8Array(bytes));
  const seen = { messages: 0, chunks: 0, schemas: 0, channels: 0 };
  for (let record; (record = stream.nextRecord()) !== undefined; ) {
    if (record.type === "Message") ++seen.messages;
    if (record.type === "Chunk") ++seen.chunks;
    if (record.type === "MessageIndex" && record.records.length === 0) fail("an empty index");
  }
  if (!stream.done()) fail("the file does not end with its magic");
  const dataEnd = bytes.lastIndexOf(Buffer.from([0x0f, 4, 0, 0, 0, 0, 0, 0, 0]));
  if (crc32(bytes.subarray(0, dataEnd)) !== bytes.readUInt32LE(dataEnd + 9)) fail("checksum of the data");
  if (bytes.readUInt32LE(bytes.length - 12) === 0) fail("no checksum of the summary");

  // By its index, which checks the summary.
  const reader = await McapIndexedReader.Initialize({ readable });
  const out = { topics: {}, library: reader.header.library, summary: reader.summaryOffsetsByOpcode.size };
  const poses = {}, log = [], entities = [];
  let last = -1n, observed;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    if (message.logTime < last) fail("messages are not in order of time");
    last = message.logTime;
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    const value = JSON.parse(new TextDecoder().decode(message.data));
    check(JSON.parse(new TextDecoder().decode(schema.data)), value, channel.topic);
    const topic = (out.topics[channel.topic] ??= { schema: schema.name, encoding: channel.messageEncoding, count: 0 });
    ++topic.count;
    if (schema.encoding !== "jsonschema") fail("a schema is no JSON schema");
    for (const t of value.transforms ?? []) {
      const time = Number(message.logTime) / 1e9;
      if (Math.abs(t.timestamp.sec + t.timestamp.nsec / 1e9 - time) > 1e-9) fail("a transform is of another time");
      (poses[t.child_frame_id] ??= []).push({ time, parent: t.parent_frame_id, ...t.translation });
    }
    for (const e of value.entities ?? []) entities.push(e);
    if (channel.topic === "/events") log.push(`${(Number(message.logTime) / 1e9).toFixed(3)} ${value.level} ${value.message}`);
    if (channel.topic === "/observations") observed = value;
  }
  const counted = Object.values(out.topics).reduce((sum, topic) => sum + topic.count, 0);
  const statistics = reader.statistics;
  if (counted !== seen.messages || BigInt(counted) !== statistics.messageCount) fail("counts of messages differ");
  if (statistics.chunkCount !== seen.chunks) fail("counts of chunks differ");
  for (const [id, channel] of reader.channelsById) {
    const count = BigInt(out.topics[channel.topic]?.count ?? 0);
    if ((statistics.channelMessageCounts.get(id) ?? 0n) !== count) fail(`count of ${channel.topic}`);
  }
  process.stdout.write(JSON.stringify({ ...out, ...seen, poses, log, entities, observed }));
})().catch((error) => {
  process.stderr.write(`${error.stack}\n`);
  process.exit(1);
});
