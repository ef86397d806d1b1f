#!/usr/bin/env python3
"""Perturbs a recording's extrinsics, calibrates, and tells how far the result is off. Truth is read here alone.

calibration_trial.py LILOC REC... [--initial none] [--no-scan] [--seed N] [--off-m 0.05] [--off-deg 3]
With --no-scan places are compared relative to the first LiDAR.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

import numpy as np


def matrix(pose):
    x, y, z, w = np.array(pose["rotation_xyzw"]) / np.linalg.norm(pose["rotation_xyzw"])
    T = np.eye(4)
    T[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                 [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                 [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    T[:3, 3] = pose["translation"]
    return T


def product(a, b):
    """Of quaternions xyzw."""
    av, bv = a[:3], b[:3]
    return np.append(a[3] * bv + b[3] * av + np.cross(av, bv), a[3] * b[3] - av @ bv)


def perturbed(pose, rng, off_m, off_deg):
    shift, axis = (v / np.linalg.norm(v) for v in rng.normal(size=(2, 3)))
    half = np.radians(off_deg) / 2
    turn = np.append(axis * np.sin(half), np.cos(half))
    return {"translation": list(np.array(pose["translation"]) + off_m * shift),
            "rotation_xyzw": list(product(turn, np.array(pose["rotation_xyzw"])))}


def trial(args, rec, rng):
    site = json.loads((rec / "site.json").read_text())
    truth = [matrix(lidar["T_map_sensor"]) for lidar in site["global_lidars"]]
    for i, lidar in enumerate(site["global_lidars"]):
        if not (args.no_scan and i == 0):
            lidar["T_map_sensor"] = perturbed(lidar["T_map_sensor"], rng, args.off_m, args.off_deg)
    with tempfile.TemporaryDirectory() as folder:
        start = pathlib.Path(folder) / "site.json"
        start.write_text(json.dumps(site))
        command = [args.liloc, "calibrate", rec, "--site", start, "--out", f"{folder}/out.json", "--json",
                   "--initial", args.initial]
        if not args.no_scan:
            command += ["--reference", rec / "reference.ply"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    if not done.stdout:
        print(f"{rec.name}: exit {done.returncode}: {done.stderr.strip()}")
        return
    for lidar, T_true in zip(json.loads(done.stdout)["lidars"], truth):
        off = np.linalg.inv(T_true) @ matrix(lidar["T_map_sensor"])
        turn = np.degrees(np.arccos(np.clip((np.trace(off[:3, :3]) - 1) / 2, -1, 1)))
        print(f"{rec.name} {lidar['id']}: off {100 * np.linalg.norm(off[:3, 3]):.2f} cm {turn:.3f} deg, "
              f"residual {1000 * lidar['residual_m']:.1f} mm, overlap {lidar['overlap']:.2f}, "
              f"conflict {lidar['conflict']:.2f}, sd {1000 * lidar['sd_m']:.1f} mm {lidar['sd_deg']:.2f} deg, "
              f"scale {100 * lidar['depth_scale_error']:.2f} %, {lidar['doubt'] or 'trusted'}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("liloc")
    parser.add_argument("recordings", nargs="+", type=pathlib.Path)
    parser.add_argument("--initial", default="site", choices=["site", "none"])
    parser.add_argument("--no-scan", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--off-m", type=float, default=0.05)
    parser.add_argument("--off-deg", type=float, default=3)
    args = parser.parse_args()
    rng = np.random.default_rng(args.seed)
    for rec in args.recordings:
        trial(args, rec, rng)


if __name__ == "__main__":
    main()
