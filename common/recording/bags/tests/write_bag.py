#!/usr/bin/env python3
"""Writes a small ROS 2 bag by the specifications alone, as a writer that shares no code with the reader.

write_bag.py OUT KIND   KIND: db3, mcap, mcap-zstd, mcap-lz4, each also with -big for big-endian CDR
Two LiDARs (an Image and a PointCloud2), a device with depth and IMU, transforms; what stands in it is told in bags_test.cpp.
"""
import ctypes
import sqlite3
import struct
import sys
import zlib

START_NS = 1_700_000_000_000_000_000


class Cdr:
    def __init__(self, big):
        self.order = ">" if big else "<"
        self.bytes = b""

    def put(self, kind, *values):
        size = struct.calcsize(kind)
        for value in values:
            self.bytes += bytes(-len(self.bytes) % size) + struct.pack(self.order + kind, value)
        return self

    def text(self, text):
        raw = text.encode() + b"\0"
        self.put("I", len(raw))
        self.bytes += raw
        return self

    def blob(self, raw):
        self.put("I", len(raw))
        self.bytes += raw
        return self

    def header(self, stamp_ns, frame):
        return self.put("i", stamp_ns // 10**9).put("I", stamp_ns % 10**9).text(frame)

    def done(self):
        return (b"\0\0\0\0" if self.order == ">" else b"\0\1\0\0") + self.bytes


def image(big, stamp_ns, frame, encoding, value):
    kind, size = ("f", 4) if encoding == "32FC1" else ("H", 2)
    row = b"".join(struct.pack("<" + kind, value + u if kind == "H" else value) for u in range(8)) + b"\0" * 4
    return Cdr(big).header(stamp_ns, frame).put("I", 6, 8).text(encoding).put("B", 0).put("I", 8 * size + 4).blob(row * 6).done()


def camera_info(big, stamp_ns, frame):
    out = Cdr(big).header(stamp_ns, frame).put("I", 6, 8).text("plumb_bob").put("I", 5).put("d", *[0.0] * 5)
    out.put("d", 6, 0, 3.5, 0, 6.5, 2.5, 0, 0, 1).put("d", *[1, 0, 0, 0, 1, 0, 0, 0, 1]).put("d", *[0.0] * 12)
    return out.put("I", 1, 1, 0, 0, 0, 0).put("B", 0).done()


def imu(big, stamp_ns):
    out = Cdr(big).header(stamp_ns, "imu_link").put("d", 0, 0, 0, 1).put("d", *[0.0] * 9)
    return out.put("d", 0.1, 0.2, 0.3).put("d", *[0.0] * 9).put("d", 0.5, -0.5, 9.75).put("d", *[0.0] * 9).done()


def points(big, stamp_ns):
    out = Cdr(big).header(stamp_ns, "lidar1").put("I", 1, 3).put("I", 4)
    for name, at in (("x", 0), ("y", 4), ("z", 8), ("intensity", 12)):
        out.text(name).put("I", at).put("B", 7).put("I", 1)
    data = struct.pack("<12f", 0, 0, 2, 1, 1, 0, 2.5, 1, float("nan"), 0, 1, 1)
    return out.put("B", 0).put("I", 16, 48).blob(data).put("B", 0).done()


def transforms(big, stamp_ns):
    tree = [("map", "hall", (10, 0, 0), (0, 0, 0, 1)), ("hall", "lidar0", (1, 2, 3), (1, 0, 0, 0)),
            ("hall", "lidar1", (4, 5, 3), (1, 0, 0, 0)), ("base", "imu_link", (0, 0, 0.5), (0, 0, 0, 1)),
            ("base", "camera", (0.1, 0, 0.5), (0, 0, 0.7071067811865476, 0.7071067811865476))]
    out = Cdr(big).put("I", len(tree))
    for parent, child, t, q in tree:
        out.header(stamp_ns, parent).text(child).put("d", *t).put("d", *q)
    return out.done()


def messages(big):
    yield "/tf_static", "tf2_msgs/msg/TFMessage", START_NS, transforms(big, START_NS)
    for i in range(3):
        at = START_NS + i * 100_000_000
        for name, frame in (("lidar0", "lidar0"), ("lidar1", "lidar1"), ("camera", "camera")):
            yield f"/{name}/depth/camera_info", "sensor_msgs/msg/CameraInfo", at, camera_info(big, at, frame)
        yield "/lidar0/depth/image", "sensor_msgs/msg/Image", at, image(big, at, "lidar0", "16UC1", 2000 + i)
        yield "/lidar1/depth/points", "sensor_msgs/msg/PointCloud2", at, points(big, at)
        yield "/camera/depth/image", "sensor_msgs/msg/Image", at, image(big, at, "camera", "32FC1", 1.5)
        for k in range(10):
            yield "/imu", "sensor_msgs/msg/Imu", at + k * 10_000_000, imu(big, at + k * 10_000_000)
        yield "/chatter", "std_msgs/msg/String", at, Cdr(big).text("hello").done()


def write_db3(out, all_messages):
    database = sqlite3.connect(out)
    database.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
                     "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
    database.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
                     "timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    ids = {}
    for topic, kind, stamp_ns, cdr in all_messages:
        if topic not in ids:
            ids[topic] = len(ids) + 1
            database.execute("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", (ids[topic], topic, kind))
        database.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", (ids[topic], stamp_ns, cdr))
    database.commit()


def record(opcode, body):
    return struct.pack("<BQ", opcode, len(body)) + body


def text(value):
    return struct.pack("<I", len(value)) + value.encode()


def packed(how, raw):
    if how == "":
        return raw
    library = ctypes.CDLL("libzstd.so.1" if how == "zstd" else "liblz4.so.1")
    room = ctypes.create_string_buffer(2 * len(raw) + 1000)
    if how == "zstd":
        library.ZSTD_compress.restype = ctypes.c_size_t
        size = library.ZSTD_compress(room, ctypes.c_size_t(len(room)), raw, ctypes.c_size_t(len(raw)), 3)
    else:
        library.LZ4F_compressFrame.restype = ctypes.c_size_t
        size = library.LZ4F_compressFrame(room, ctypes.c_size_t(len(room)), raw, ctypes.c_size_t(len(raw)), None)
    return room.raw[:size]


def write_mcap(out, all_messages, how):
    magic = b"\x89MCAP0\r\n"
    chunks, records, ids = b"", b"", {}
    for number, (topic, kind, stamp_ns, cdr) in enumerate(all_messages):
        if topic not in ids:
            ids[topic] = len(ids) + 1
            records += record(3, struct.pack("<H", ids[topic]) + text(kind) + text("ros2msg") + struct.pack("<I", 0))
            records += record(4, struct.pack("<HH", ids[topic], ids[topic]) + text(topic) + text("cdr") + struct.pack("<I", 0))
        records += record(5, struct.pack("<HIQQ", ids[topic], number, stamp_ns, stamp_ns) + cdr)
        if number % 20 == 19:
            chunks, records = chunks + chunk(how, records), b""
    chunks += chunk(how, records)
    with open(out, "wb") as file:
        file.write(magic + record(1, text("ros2") + text("write_bag.py")) + chunks + record(15, struct.pack("<I", 0)) +
                   record(2, struct.pack("<QQI", 0, 0, 0)) + magic)


def chunk(how, records):
    small = packed(how, records)
    return record(6, struct.pack("<QQQI", 0, 0, len(records), zlib.crc32(records)) + text(how) +
                  struct.pack("<Q", len(small)) + small)


def main():
    out, kind = sys.argv[1:3]
    big = kind.endswith("-big")
    kind = kind.removesuffix("-big")
    if kind == "db3":
        write_db3(out, messages(big))
    else:
        write_mcap(out, messages(big), kind.removeprefix("mcap").removeprefix("-"))


if __name__ == "__main__":
    main()
