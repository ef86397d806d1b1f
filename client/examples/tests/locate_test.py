#!/usr/bin/env python3
"""An example locates a device that walks through a room, against a server that answers.

locate_test.py DOMAIN PROGRAM...   env: ANSWERING_SERVER"""
import os
import pathlib
import subprocess
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python/tests"))
import box_frames as box  # noqa: E402


def main():
    domain, program = sys.argv[1], sys.argv[2:]
    server = subprocess.Popen([os.environ["ANSWERING_SERVER"], domain], stdin=subprocess.PIPE)
    example = subprocess.Popen(program + ["walker", domain, str(box.WIDTH), str(box.HEIGHT), str(box.FOCAL_PX)],
                               stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    for frame in range(box.FRAMES):
        example.stdin.write(box.stamp_ns(frame).to_bytes(8, sys.byteorder) + box.render(frame).tobytes())
        example.stdin.flush()
        time.sleep(0.1)
    lines = example.communicate(timeout=30)[0].decode().splitlines()
    server.communicate(timeout=10)
    assert example.returncode == 0 and server.returncode == 0, (example.returncode, server.returncode)
    assert [int(line.split()[0]) for line in lines] == [box.stamp_ns(i) for i in range(box.FRAMES)], lines
    stamp, state, x, y, z = lines[-1].split()  # odometry lies at (1, 2, 3) for that server
    assert state == "tracking" and 1 < float(x) < 2 and 1.5 < float(y) < 3 and 2.5 < float(z) < 3.5, lines[-1]


if __name__ == "__main__":
    main()
