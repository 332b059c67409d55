// Reads a recording of this project with Foxglove's packages, and a recording of these packages with the reader
// of this project.
//   node check.mjs FIXTURE_PROGRAM FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import rosmsg from "@foxglove/rosmsg";
import serialization from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader, McapStreamReader, McapWriter } from "@mcap/core";
import { decompress } from "fzstd";

const [fixture, folder] = process.argv.slice(2);
const decompressHandlers = { zstd: (bytes) => decompress(bytes) };
const readable = (bytes) => ({
  size: async () => BigInt(bytes.length),
  read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length)),
});

/** Converts integers beyond 2^53 to text and typed arrays to arrays. Makes both sides comparable. */
const plain = (value) => JSON.parse(JSON.stringify(value, (_, x) =>
  typeof x === "bigint" ? (Number.isSafeInteger(Number(x)) ? Number(x) : String(x))
  : ArrayBuffer.isView(x) ? Array.from(x) : x));
/** Converts names to lower case: this project writes `tension_N`, but ROS 2 allows only `tension_n`. */
const lowered = (value) => Array.isArray(value) ? value.map(lowered)
  : value && typeof value === "object"
    ? Object.fromEntries(Object.entries(value).map(([key, x]) => [key.toLowerCase(), lowered(x)]))
    : value;
const expectedOf = (line) => {
  const [topic, sequence, ...json] = line.split(" ");
  return { topic, sequence: Number(sequence),
    message: lowered(JSON.parse(json.join(" ").replace(/:(-?\d{16,})(?=[,}])/g, ':"$1"'))) };
};

async function ourFileTheirReader() {
  execFileSync(fixture, ["write", `${folder}/ours.mcap`, `${folder}/ours.jsonl`]);
  const bytes = readFileSync(`${folder}/ours.mcap`);
  const expected = readFileSync(`${folder}/ours.jsonl`, "utf8").trim().split("\n").map(expectedOf);
  assert.equal(expected.length, 3 * 17);

  const reader = await McapIndexedReader.Initialize({ readable: readable(bytes), decompressHandlers });
  assert.equal(reader.header.profile, "");
  assert.match(reader.header.library, /^erp \d/);
  assert.equal(reader.statistics.messageCount, BigInt(expected.length));
  assert.ok(reader.chunkIndexes.length > 1);
  const readers = new Map();
  const found = [];
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    assert.equal(schema.encoding, "ros2msg");
    assert.equal(channel.messageEncoding, "cdr");
    if (!readers.has(schema.id)) {
      const definitions = rosmsg.parse(new TextDecoder().decode(schema.data), { ros2: true });
      readers.set(schema.id, new serialization.MessageReader(definitions));
    }
    const decoded = readers.get(schema.id).readMessage(message.data);
    assert.equal(message.logTime, 1000n + BigInt(message.sequence));
    found.push({ topic: channel.topic, sequence: message.sequence, message: plain(decoded) });
  }
  assert.deepEqual(found, expected);
  const attachments = [];
  for await (const attachment of reader.readAttachments()) attachments.push(attachment);
  assert.equal(attachments.length, 18);
  assert.equal(new TextDecoder().decode(attachments[0].data), '<robot name="rig"/>');

  const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  stream.append(bytes);
  let records = 0;
  while (stream.nextRecord()) ++records;
  assert.ok(stream.done() && records > expected.length);
}

async function theirFileOurReader() {
  const parts = [];
  let size = 0n;
  const writable = {
    position: () => size,
    write: async (part) => { parts.push(Buffer.from(part)); size += BigInt(part.length); },
  };
  const writer = new McapWriter({ writable, chunkSize: 100 });
  await writer.start({ profile: "x", library: "theirs" });
  const schemaId = await writer.registerSchema({ name: "s/msg/S", encoding: "ros2msg", data: new TextEncoder().encode("string a\n") });
  const channelId = await writer.registerChannel({ topic: "t", schemaId, messageEncoding: "cdr", metadata: new Map([["k", "v"]]) });
  await writer.addAttachment({ name: "note", logTime: 1n, createTime: 1n, mediaType: "text/plain", data: new TextEncoder().encode("hello") });
  for (let i = 0; i < 20; ++i)
    await writer.addMessage({ channelId, sequence: i, logTime: BigInt(100 - i), publishTime: 0n, data: new TextEncoder().encode(`m${i}`) });
  await writer.end();
  writeFileSync(`${folder}/theirs.mcap`, Buffer.concat(parts));
  const lines = execFileSync(fixture, ["read", `${folder}/theirs.mcap`], { encoding: "utf8" }).trim().split("\n");
  assert.equal(lines[0], "complete");
  assert.equal(lines[1], "note hello");
  const backwards = Array.from({ length: 20 }, (_, i) => `t ${19 - i} m${19 - i}`);
  assert.deepEqual(lines.slice(2), backwards);
}

await ourFileTheirReader();
await theirFileOurReader();
console.log("Foxglove's packages and ours read each other's recordings");
