#!/usr/bin/env python3
"""Fits the chance that a request is verified (server/plan/prediction.cpp) to rows of liloc_plan_bench.

fit_plan.py ROWS... [--test ROWS...]
Prints the coefficients, and of each file how far a site's predicted share is from the verified one. No coefficient but
the first may be negative: a LiDAR more must not lower the chance. Needs NumPy."""
import argparse

import numpy as np


def read(path):
    return np.genfromtxt(path, delimiter=",", names=True)


def features(rows):
    seen, covered, upright, weakest = rows["seen"], rows["covered"], rows["upright"], rows["weakest"]
    return np.column_stack([np.ones(len(rows)), covered / np.maximum(seen, 1), np.log1p(upright), np.log1p(weakest)])


NAMES = ["one", "overlap", "ln(1 + upright)", "ln(1 + weakest)"]


def chance(x, w):
    return 1 / (1 + np.exp(-np.clip(x @ w, -30, 30)))


def fit(x, y, ridge=1.0):
    w = np.zeros(x.shape[1])
    penalty = ridge * np.eye(len(w))
    penalty[0, 0] = 0
    for _ in range(50):
        p = chance(x, w)
        step = np.linalg.solve(x.T * (p * (1 - p)) @ x + penalty, x.T @ (y - p) - penalty @ w)
        w += step
        if np.abs(step).max() < 1e-9:
            break
    return w


def report(name, rows, p):
    y = rows["verified"]
    loss = -np.mean(y * np.log(p) + (1 - y) * np.log(1 - p))
    sites = np.unique(rows["seed"])
    off = [p[rows["seed"] == s].mean() - y[rows["seed"] == s].mean() for s in sites]
    print(f"{name}: {len(sites)} sites, {len(rows)} poses, predicted {100 * p.mean():.1f} %, verified {100 * y.mean():.1f} %, "
          f"a site off by {100 * np.abs(off).mean():.1f} points on average, "
          f"{100 * np.mean(np.abs(off) <= 0.03):.0f} % of them within 3; log loss {loss:.3f}")
    for low, high in zip(np.arange(0, 1, 0.2), np.arange(0.2, 1.01, 0.2)):
        some = (p >= low) & (p < high)
        if some.any():
            print(f"  predicted {low:.1f}..{high:.1f}: {some.sum()} poses, verified {100 * y[some].mean():.1f} %, "
                  f"predicted {100 * p[some].mean():.1f} %")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("rows", nargs="+")
    parser.add_argument("--test", nargs="*", default=[])
    args = parser.parse_args()
    rows = np.concatenate([read(path) for path in args.rows])
    w = fit(features(rows), rows["verified"])
    for name, value in zip(NAMES, w):
        print(f"{name:<18} {value:9.4f}")
    for path in args.rows + args.test:
        some = read(path)
        report(path, some, chance(features(some), w))


if __name__ == "__main__":
    main()
