#!/usr/bin/env python3
"""Fits the model of confidence (server/localization/confidence.hpp) on some worlds and judges it on whole others.

  fit_confidence.py [--svg FILE] [--penalty 3e-5] [--risk 1e-3] WORLD[:WEIGHT]=ROWS.csv ...

A world whose name ends in * is several: one for each first word of its sites' names.

ROWS.csv is what `liloc_spot_bench --evidence` writes. Prints, for each world, how the model that was fitted on the
others does there, then the calibration over all worlds held out, then the coefficients of all together as C++.
Needs python3-scipy."""
import argparse
import csv
import sys

try:
    import numpy as np
    from scipy.optimize import minimize
except ImportError:
    sys.exit("fit_confidence.py: needs scipy; apt-get install python3-scipy")

CLUTTER = ["constant", "log_agreeing", "contradiction", "excess", "log_bits", "log_sd"]
TWIN = ["constant", "share", "support", "contradiction", "log_bits", "alike"]
RIVAL = ["constant", "log_agreeing", "contradiction", "excess", "log_bits", "misfit"]
SIGN = {"constant": 0, "contradiction": -1, "excess": -1, "misfit": -1, "log_sd": -1, "alike": -1}  # others: 1
RIVAL_BITS, FEW_BITS = 0.4, 3.0  # as in confidence.cpp
START = {"constant": 0, "log_agreeing": 1, "share": .5, "support": .3, "contradiction": -.3, "log_bits": 1, "misfit": -.3, "log_sd": -.5}
BINS = [0, .1, .3, .5, .75, .9, .95, .99, .995, .999, .9995, 1]


def place_of(row):
    place = {k: float(row[k]) for k in ("agreeing", "searches", "support", "contradiction", "excess", "misfit", "bits", "sd_m")}
    place.update(right=row["right"] == "1", constant=1.0,
                 log_agreeing=np.log1p(place["agreeing"]), share=place["agreeing"] / max(place["searches"], 1),
                 log_bits=np.log(place["bits"] + FEW_BITS), log_sd=np.log(np.clip(place["sd_m"], .002, .5) / .01))
    return place


def spots_of(path):
    spots = {}
    with open(path) as file:
        for row in csv.DictReader(file):
            spot = spots.setdefault(row["spot"], {"site": (row["site"], row["seed"], row["client"], row["cold"]), "t_s": float(row["t_s"]), "cold": row["cold"] == "1", "places": []})
            spot["places"].append(place_of(row))
    return list(spots.values())


class Rows:
    """The likeliest three places of each spot as rows of three linear forms; only the first decides."""

    def __init__(self, worlds, weights):
        rows = []
        for world, spots in worlds.items():
            sites = len({s["site"] for s in spots})
            per_site = {}
            for s in spots:
                per_site[s["site"]] = per_site.get(s["site"], 0) + 1
            for s in spots:
                weight = weights[world] * (.3 if s["cold"] else 1) / per_site[s["site"]] / np.sqrt(sites)
                for i, place in enumerate(s["places"][:3]):
                    rivals = [o for o in s["places"] if o is not place]
                    rows.append((world, s, place, rivals, i == 0, weight))
        self.world = np.array([r[0] for r in rows])
        self.spot = [r[1] for r in rows]
        self.top = np.array([r[4] for r in rows])
        self.weight = np.array([r[5] for r in rows])
        self.right = np.array([r[2]["right"] for r in rows], float)
        self.clutter = np.array([[r[2][k] for k in CLUTTER] for r in rows])
        self.twin = np.array([[self.alike(r[2], r[3]) if k == "alike" else r[2][k] for k in TWIN] for r in rows])
        most = max(1, max(len(r[3]) for r in rows))
        self.rival, self.mask = np.zeros((len(rows), most, len(RIVAL))), np.zeros((len(rows), most), bool)
        for i, (_, _, place, rivals, _, _) in enumerate(rows):
            for j, o in enumerate(o for o in rivals if o["bits"] >= RIVAL_BITS * place["bits"]):
                self.rival[i, j] = [1.0 if k == "constant" else place[k] - o[k] for k in RIVAL]
                self.mask[i, j] = True

    @staticmethod
    def alike(place, rivals):
        return min(1.5, max([o["bits"] for o in rivals if o["excess"] < .1], default=0) / max(place["bits"], 1))

    def log_odds(self, p, which):
        a, b = len(CLUTTER), len(CLUTTER) + len(TWIN)
        z = np.concatenate([-(self.clutter[which] @ p[:a])[:, None], -(self.twin[which] @ p[a:b])[:, None],
                            np.where(self.mask[which], -(self.rival[which] @ p[b:]), -1e9)], 1)
        top = z.max(1, keepdims=True)
        e = np.exp(z - top)
        return -(top[:, 0] + np.log(e.sum(1))), e / e.sum(1, keepdims=True)


def fit(rows, which, penalty):
    names = CLUTTER + TWIN + RIVAL
    a, b = len(CLUTTER), len(CLUTTER) + len(TWIN)
    clutter, twin, rival = rows.clutter[which], rows.twin[which], rows.rival[which] * rows.mask[which][..., None]
    y, w = rows.right[which], rows.weight[which] / rows.weight[which].sum()
    free = np.array([0.0 if n == "constant" else penalty * (.01 if n == "excess" else 1) for n in names])

    def loss(p):
        odds, share = rows.log_odds(p, which)
        d = w * (1 / (1 + np.exp(-odds)) - y)
        gradient = np.concatenate([(d * share[:, 0]) @ clutter, (d * share[:, 1]) @ twin, np.einsum("i,ij,ijk->k", d, share[:, 2:], rival)])
        return (w * np.logaddexp(0, np.where(y > 0, -odds, odds))).sum() + (free * p * p).sum(), gradient + 2 * free * p

    bounds = [{0: (None, None), 1: (0, None), -1: (None, 0)}[SIGN.get(n, 1)] for n in names]
    found = []
    for alike, contradiction in ((-2, -.3), (-4, -2), (-.5, -.1)):  # the risks share the blame; not convex
        start = np.array([START.get(n, 0) for n in names], float)
        start[0], start[a] = -5, 8
        start[a + TWIN.index("alike")], start[a + TWIN.index("contradiction")] = alike, contradiction
        found.append(minimize(loss, start, jac=True, method="L-BFGS-B", bounds=bounds, options={"maxiter": 5000, "maxfun": 20000, "ftol": 1e-10}))
    return min(found, key=lambda f: f.fun).x


def show_world(name, rows, which, odds, limit):
    y = rows.right[which]
    spots = [s for s, w in zip(rows.spot, which) if w]
    verified = odds >= limit
    history = np.array([not s["cold"] for s in spots])
    located, sites = 0, {}
    for s, v in zip(spots, verified):
        if not s["cold"]:
            sites.setdefault(s["site"], []).append(s["t_s"] if v else 1e9)
    located = sum(min(times) <= 3 for times in sites.values())
    loss = np.logaddexp(0, np.where(y > 0, -odds, odds)).mean()
    refused = lambda m: f"{100 * (1 - verified[m & (y > 0)].mean()):.0f} %" if (m & (y > 0)).any() else "-"
    print(f"| {name} | {len(sites)} | {len(y)} | {100 * y.mean():.0f} % | {loss:.3f} | {refused(history)} | {refused(~history)} | "
          f"{int((verified & (y == 0)).sum())} of {int(verified.sum())} | {located} |")


def show_calibration(odds, right):
    p = 1 / (1 + np.exp(-odds))
    table, error = [], 0.0
    print("\n| told | answers | mean told | right |\n|---|---|---|---|")
    for low, high in zip(BINS, BINS[1:]):
        m = (p > low) & (p <= high)
        if not m.any():
            continue
        table.append((p[m].mean(), right[m].mean(), int(m.sum())))
        error += m.sum() * abs(p[m].mean() - right[m].mean()) / len(p)
        print(f"| {100 * low:g} to {100 * high:g} % | {m.sum()} | {100 * p[m].mean():.2f} % | {100 * right[m].mean():.2f} % |")
    print(f"\ncalibration error {100 * error:.2f} %")
    return table


def draw(table, path):
    at = lambda v: 40 + 3.2 * 100 * v
    dots = "".join(f'<circle cx="{at(p):.1f}" cy="{400 - at(r):.1f}" r="{2 + n ** .5 / 8:.1f}" fill="#2563eb" fill-opacity=".7"><title>{n} answers: told {100 * p:.1f} %, right {100 * r:.1f} %</title></circle>' for p, r, n in table)
    ticks = "".join(f'<text x="{at(v):.0f}" y="378" text-anchor="middle">{100 * v:.0f}</text><text x="34" y="{404 - at(v):.0f}" text-anchor="end">{100 * v:.0f}</text>' for v in (0, .25, .5, .75, 1))
    with open(path, "w") as file:
        file.write(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 410" font-family="sans-serif" font-size="11"><rect width="400" height="410" fill="#fff"/>'
                   f'<path d="M40 360H360M40 360V40M40 360L360 40" stroke="#999" fill="none"/>{dots}{ticks}<text x="200" y="398" text-anchor="middle">confidence told, %</text>'
                   f'<text x="12" y="200" text-anchor="middle" transform="rotate(-90 12 200)">answers that were right, %</text></svg>\n')


def show_model(p):
    at = 0
    print()
    for name, fields in (("clutter", CLUTTER), ("twin", TWIN), ("rival", RIVAL)):
        print(f"      .{name} = {{" + ", ".join(f".{f} = {v:.2f}" for f, v in zip(fields, p[at:])) + "},")
        at += len(fields)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("worlds", nargs="+", metavar="WORLD[:WEIGHT]=ROWS.csv")
    parser.add_argument("--svg", help="write a reliability diagram")
    parser.add_argument("--penalty", type=float, default=3e-5, help="on squared coefficients")
    parser.add_argument("--risk", type=float, default=1e-3, help="the share of verified answers that may be wrong")
    args = parser.parse_args()
    worlds, weights = {}, {}
    for argument in args.worlds:
        name, _, path = argument.partition("=")
        name, _, weight = name.partition(":")
        for spot in spots_of(path):
            world = name[:-1] + spot["site"][0].split()[0] if name.endswith("*") else name
            worlds.setdefault(world, []).append(spot)
            weights[world] = float(weight or 1)
    rows, limit = Rows(worlds, weights), np.log((1 - 5 * args.risk) / (5 * args.risk))
    print("| world held out | devices | answers | right | log loss | right ones refused: history | cold | wrong verified | located within 3 s |\n|---|---|---|---|---|---|---|---|---|")
    held_odds, held_right = [], []
    for name in worlds:
        model = fit(rows, rows.world != name, args.penalty) if len(worlds) > 1 else fit(rows, rows.world == name, args.penalty)
        which = (rows.world == name) & rows.top
        odds = rows.log_odds(model, which)[0]
        show_world(name, rows, which, odds, limit)
        held_odds.append(odds)
        held_right.append(rows.right[which])
    table = show_calibration(np.concatenate(held_odds), np.concatenate(held_right))
    if args.svg:
        draw(table, args.svg)
    model = fit(rows, rows.world != "", args.penalty)
    odds = rows.log_odds(model, rows.top)[0]
    show_world("none: the model itself", rows, rows.top, odds, limit)
    show_model(model)


if __name__ == "__main__":
    main()
