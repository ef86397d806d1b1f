#!/usr/bin/env python3
"""A device in Python: depth frames in, poses out.   locate.py ID DOMAIN WIDTH HEIGHT FOCAL_PX < FRAMES

Standard input stands for your camera's driver: of each frame a stamp (int64, ns), then its depths (uint16, mm).
"""
import sys

import numpy as np

import liloc


def show(now):  # on the registration's thread
    at = "" if now.T_map_sensor is None else " {:.3f} {:.3f} {:.3f}".format(*now.T_map_sensor[:3, 3])
    print(f"{now.stamp_ns} {now.state.name.lower()}{at}", flush=True)


def main():
    name, domain, width, height, focal_px = sys.argv[1], *map(int, sys.argv[2:5]), float(sys.argv[5])
    camera = liloc.Camera(width, height, focal_px, focal_px, (width - 1) / 2, (height - 1) / 2, depth_scale_m=0.001)
    with liloc.Client(name, camera, domain=domain, on_pose=show) as client:
        while stamp := sys.stdin.buffer.read(8):
            depth_mm = np.frombuffer(sys.stdin.buffer.read(2 * width * height), np.uint16)
            client.push_depth(depth_mm.reshape(height, width), int.from_bytes(stamp, sys.byteorder))
    if problem := client.stats().problem:
        print(problem, file=sys.stderr)


if __name__ == "__main__":
    main()
