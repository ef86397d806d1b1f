#!/usr/bin/env python3
"""Draws a replay from above: where the devices were, and where they were told to be.

plot_trajectory.py REC OUT FILE.svg    after `liloc replay REC --out OUT`
Grey: ground truth. Coloured: the pose each frame had at that moment (online.tum). Triangles: ceiling LiDARs.
"""
import json
import pathlib
import sys

COLOURS = ["#0b6fb8", "#c2410c", "#15803d", "#7e22ce"]
PIXELS_PER_M, MARGIN = 70, 46


def tum(path):
    """[(stamp_s, x, y, z)] of a TUM file."""
    rows = [line.split() for line in path.read_text().splitlines() if line and line[0] != "#"]
    return [tuple(map(float, row[:4])) for row in rows]


def mean_error_cm(truth, online):
    by_stamp = {round(row[0], 3): row[1:] for row in truth}
    errors = [sum((a - b) ** 2 for a, b in zip(row[1:], by_stamp[round(row[0], 3)])) ** 0.5
              for row in online if round(row[0], 3) in by_stamp]
    return 100 * sum(errors) / len(errors) if errors else float("nan")


def draw(rec, out):
    lidars = [entry["T_map_sensor"]["translation"] for entry in json.loads((rec / "site.json").read_text())["global_lidars"]]
    tracks = []
    for folder in sorted((rec / "devices").iterdir()):
        truth, online = tum(folder / "groundtruth.tum"), tum(out / folder.name / "online.tum")
        tracks.append((folder.name, truth, online, mean_error_cm(truth, online)))
    points = [p[:2] for p in lidars] + [row[1:3] for _, truth, online, _ in tracks for row in truth + online]
    x0, x1 = min(p[0] for p in points), max(p[0] for p in points)
    y0, y1 = min(p[1] for p in points), max(p[1] for p in points)

    def at(x, y):
        return f"{MARGIN + (x - x0) * PIXELS_PER_M:.1f},{MARGIN + (y1 - y) * PIXELS_PER_M:.1f}"

    width, height = 2 * MARGIN + (x1 - x0) * PIXELS_PER_M, 2 * MARGIN + (y1 - y0) * PIXELS_PER_M + 22 * len(tracks)
    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" '
           'font-family="sans-serif" font-size="14">', '<rect width="100%" height="100%" fill="white"/>']
    corner = at(x0, y1).split(",")
    svg.append(f'<rect x="{corner[0]}" y="{corner[1]}" width="{(x1 - x0) * PIXELS_PER_M:.1f}" '
               f'height="{(y1 - y0) * PIXELS_PER_M:.1f}" fill="#f8fafc" stroke="#94a3b8"/>')
    for x, y, _ in lidars:
        cx, cy = map(float, at(x, y).split(","))
        svg.append(f'<path d="M{cx:.1f} {cy - 8:.1f} l8 14 h-16 z" fill="#334155"/>')
    for i, (name, truth, online, error_cm) in enumerate(tracks):
        colour = COLOURS[i % len(COLOURS)]
        for rows, stroke, size in ((truth, "#cbd5e1", 9), (online, colour, 2)):
            svg.append(f'<polyline fill="none" stroke="{stroke}" stroke-width="{size}" stroke-linejoin="round" '
                       f'points="{" ".join(at(row[1], row[2]) for row in rows)}"/>')
        svg.append(f'<text x="{MARGIN}" y="{height - 22 * (len(tracks) - i) + 2:.0f}" fill="{colour}">{name}: '
                   f'{len(online)} of {len(truth)} frames located, mean error {error_cm:.1f} cm</text>')
    svg.append(f'<text x="{width - MARGIN:.0f}" y="{MARGIN - 14}" text-anchor="end" fill="#475569">'
               f'{x1 - x0:.1f} m x {y1 - y0:.1f} m between the LiDARs</text>')
    return "\n".join(svg + ["</svg>", ""])


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__.strip())
    pathlib.Path(sys.argv[3]).write_text(draw(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])))
