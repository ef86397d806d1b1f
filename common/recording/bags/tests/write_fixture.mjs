#!/usr/bin/env node
// Writes independent.mcap, which bags_test reads: by Foxglove's writers of MCAP and of ROS 2 messages, which share
// no code with the reader. Not part of the build; by hand, in a folder of its own:
//   npm install @mcap/core@2.2.2 @foxglove/rosmsg-msgs-common@3.2.3 @foxglove/rosmsg2-serialization@3.1.0 @foxglove/wasm-zstd@1.0.1
//   cp write_fixture.mjs . && node write_fixture.mjs independent.mcap
import { createRequire } from "node:module";
import { writeFileSync } from "node:fs";
const require = createRequire(import.meta.url);
const { McapWriter } = require("@mcap/core");
const { MessageWriter } = require("@foxglove/rosmsg2-serialization");
const { ros2humble } = require("@foxglove/rosmsg-msgs-common");
const zstd = require("@foxglove/wasm-zstd");

function definitions(root) {
  const all = [], names = new Set(), todo = [root];
  while (todo.length > 0) {
    const name = todo.shift();
    if (names.has(name)) continue;
    names.add(name);
    all.push(ros2humble[name]);
    for (const field of ros2humble[name].definitions) if (field.isComplex) todo.push(field.type);
  }
  return all;
}

const kStart_s = 1_700_000_000;
const stamped = (frame_id, nanosec) => ({ stamp: { sec: kStart_s, nanosec }, frame_id });
const transform = (parent, child, translation, rotation) =>
  ({ header: stamped(parent, 0), child_frame_id: child, transform: { translation, rotation } });

function image(frame, nanosec, value) {
  const data = new Uint8Array(new Uint16Array(8 * 6).fill(value).buffer);
  return { header: stamped(frame, nanosec), height: 6, width: 8, encoding: "16UC1", is_bigendian: 0, step: 16, data };
}

function info(frame, nanosec) {
  return { header: stamped(frame, nanosec), height: 6, width: 8, distortion_model: "plumb_bob", d: [0, 0, 0, 0, 0],
    k: [6, 0, 3.5, 0, 6.5, 2.5, 0, 0, 1], r: [1, 0, 0, 0, 1, 0, 0, 0, 1], p: [6, 0, 3.5, 0, 0, 6.5, 2.5, 0, 0, 0, 1, 0] };
}

function imu(nanosec) {
  return { header: stamped("imu_link", nanosec), orientation: { x: 0, y: 0, z: 0, w: 1 },
    orientation_covariance: Array(9).fill(0), angular_velocity: { x: 0.1, y: 0.2, z: 0.3 },
    angular_velocity_covariance: Array(9).fill(0), linear_acceleration: { x: 0.5, y: -0.5, z: 9.75 },
    linear_acceleration_covariance: Array(9).fill(0) };
}

function* messages() {
  yield ["/tf_static", "tf2_msgs/TFMessage", 0, { transforms: [
    transform("map", "lidar0", { x: 11, y: 2, z: 3 }, { x: 1, y: 0, z: 0, w: 0 }),
    transform("imu_link", "camera", { x: 0.1, y: 0, z: 0 }, { x: 0, y: 0, z: 0, w: 1 })] }];
  for (let i = 0; i < 3; ++i) {
    const at = i * 100_000_000;
    for (const [name, frame] of [["lidar0", "lidar0"], ["camera", "camera"]]) {
      yield [`/${name}/depth/camera_info`, "sensor_msgs/CameraInfo", at, info(frame, at)];
      yield [`/${name}/depth/image`, "sensor_msgs/Image", at, image(frame, at, 2000 + i)];
    }
    for (let k = 0; k < 5; ++k) yield ["/imu", "sensor_msgs/Imu", at, imu(at + k * 20_000_000)];
  }
}

class Buffer {
  bytes = [];
  position = () => BigInt(this.bytes.length);
  write = async (more) => void this.bytes.push(...more);
}

await zstd.isLoaded;
const out = new Buffer();
const writer = new McapWriter({ writable: out, chunkSize: 2048,
  compressChunk: (data) => ({ compression: "zstd", compressedData: zstd.compress(data) }) });
await writer.start({ profile: "ros2", library: "write_fixture.mjs" });
await writer.addAttachment({ name: "note.txt", mediaType: "text/plain", logTime: 0n, createTime: 0n,
  data: new TextEncoder().encode("passed over by readers of messages") });
await writer.addMetadata({ name: "rosbag2", metadata: new Map([["serialized_metadata", "version: 5"]]) });
const channels = new Map(), encoders = new Map();
let sequence = 0;
for (const [topic, type, nanosec, value] of messages()) {
  if (!encoders.has(type)) encoders.set(type, new MessageWriter(definitions(type)));
  if (!channels.has(topic)) {
    const schemaId = await writer.registerSchema({ name: type.replace("/", "/msg/"), encoding: "ros2msg",
      data: new TextEncoder().encode("# left out") });
    channels.set(topic, await writer.registerChannel({ topic, schemaId, messageEncoding: "cdr", metadata: new Map() }));
  }
  const logTime = BigInt(kStart_s) * 1_000_000_000n + BigInt(nanosec);
  await writer.addMessage({ channelId: channels.get(topic), sequence: sequence++, logTime, publishTime: logTime,
    data: encoders.get(type).writeMessage(value) });
}
await writer.end();
writeFileSync(process.argv[2], Uint8Array.from(out.bytes));
