#!/usr/bin/env python3
"""Prints the README's table of figures from what `liloc replay` wrote.   figures.py OUT..."""
import json
import pathlib
import sys

HEAD = ["recording", "device", "frames with a pose", "online error", "corrected error", "spots 3 deg, 0.1 m",
        "verified", "wrong", "first pose", "spot, median", "odometry drift", "odometry, median"]


def share(value):
    return "-" if value is None else f"{100 * value:.0f} %"


def error(track):
    if track["mean_trans_m"] is None:
        return "-"
    return f"{100 * track['mean_trans_m']:.1f} cm, {track['mean_rot_deg']:.2f} deg"


def ms(value, digits=0):
    return "-" if value is None else f"{value:.{digits}f} ms"


def rows(report):
    for name, device in report["devices"].items():
        spots, local = device["spots"], device.get("local", {})
        yield [report["recording"], name, share(device["online"]["coverage"]), error(device["online"]),
               error(device["trajectory"]), f"{share(spots['strict'])} of {spots['n_overlap']}",
               f"{spots['verified']} of {spots['n']}", str(spots["verified_wrong"]), ms(device["first_pose_ms"]),
               ms(spots["latency_ms_median"]), f"{local.get('end_pct_of_path', 0):.2f} %",
               ms(local.get("latency_ms_median"), 1)]


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__.strip())
    table = [HEAD, ["---"] * len(HEAD)]
    for folder in sys.argv[1:]:
        table += rows(json.loads((pathlib.Path(folder) / "report.json").read_text()))
    print("\n".join("| " + " | ".join(row) + " |" for row in table))


if __name__ == "__main__":
    main()
