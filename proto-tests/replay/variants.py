#!/usr/bin/env python3
"""Replays recordings with the paper's variants, one after another, and prints a table.

variants.py LILOC OUT REC...     LILOC: the program; OUT: a folder for the traces
"""
import json
import pathlib
import subprocess
import sys

from figures import error, ms, share

VARIANTS = ["", "--verify paper", "--icp point", "--voxel 0.03", "--voxel 0.08", "--method paper",
            "--method paper --sampling 1", "--method paper --sampling 0.3", "--method paper --sampling 0.2",
            "--method dynamic-noopt --sampling 1", "--method dynamic-nover", "--method static-noopt --sampling 1"]
HEAD = ["options", "recording", "device", "frames with a pose", "online error", "spots 10 deg, 0.3 m",
        "spots 3 deg, 0.1 m", "verified", "wrong", "spot, median"]


def rows(variant, report):
    for name, device in report["devices"].items():
        spots = device["spots"]
        yield [f"`{variant}`" if variant else "(none)", report["recording"], name,
               share(device["online"]["coverage"]), error(device["online"]),
               f"{share(spots['loose'])} of {spots['n_overlap']}", share(spots["strict"]),
               f"{spots['verified']} of {spots['n']}", str(spots["verified_wrong"]), ms(spots["latency_ms_median"])]


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__.strip())
    program, out = sys.argv[1], pathlib.Path(sys.argv[2])
    print("\n".join("| " + " | ".join(row) + " |" for row in (HEAD, ["---"] * len(HEAD))), flush=True)
    for variant in VARIANTS:
        for recording in sys.argv[3:]:
            folder = out / pathlib.Path(recording).name
            subprocess.run([program, "replay", recording, "--out", folder, "--lockstep", *variant.split()],
                           check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            for row in rows(variant, json.loads((folder / "report.json").read_text())):
                print("| " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main()
