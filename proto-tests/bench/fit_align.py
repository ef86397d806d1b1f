#!/usr/bin/env python3
"""Fits what `liloc align` holds for likely, and tells how it does on scenes that it was not fitted on.

fit_align.py ROWS      rows of `liloc_spot_bench --pairs DIR --pair-rows ROWS`, several scenes in one file

Prints for each scene, fitted on the others: right answers, log loss, calibration, and for some risks how many are
trusted and how many of them wrongly; then the weights of a fit on all. Needs NumPy."""
import collections
import sys

import numpy as np

SOLVED_M, NEARLY_M = 0.2, 0.35  # between these the truth itself is in doubt: not fitted on
RIDGE = 0.3  # pulls the weights of scaled regressors to 0; 0.1 to 1 alike
RISKS = (0.01, 0.05, 0.1, 0.2, 0.3)


def read(path):
    """Per pair: (scene, kind), rows of [rmse, regressors]."""
    pairs = collections.OrderedDict()
    for line in open(path):
        f = line.split(",")
        pair = pairs.setdefault((f[0], int(f[2]), int(f[3])), ((f[0], int(f[1])), []))
        if int(f[5]) >= 0:
            pair[1].append([float(x) for x in f[6:]])
    return [(key, np.array(rows)) for key, rows in pairs.values()]


def logistic(x, y, weight, free):
    """Weights of greatest penalized likelihood; `free`: columns that are not pulled to 0."""
    pull = np.where(free, 1e-6, RIDGE)
    b = np.zeros(x.shape[1])
    for _ in range(60):
        p = 1 / (1 + np.exp(-np.clip(x @ b, -30, 30)))
        step = np.linalg.solve((x.T * (weight * p * (1 - p))) @ x + np.diag(pull), x.T @ (weight * (y - p)) - pull * b)
        b = b + step
        if abs(step).max() < 1e-8:
            break
    return b


def fit_poses(pairs):
    rows = np.vstack([r for _, r in pairs if len(r)])
    clear = (rows[:, 0] < SOLVED_M) | (rows[:, 0] > NEARLY_M)
    x, y = rows[clear, 1:], rows[clear, 0] < SOLVED_M
    mean, scale = x[:, 1:].mean(0), x[:, 1:].std(0)
    b = logistic(np.c_[np.ones(len(x)), (x[:, 1:] - mean) / scale], y, np.ones(len(x)), np.arange(x.shape[1]) == 0)
    return np.r_[b[0] - (b[1:] / scale * mean).sum(), b[1:] / scale]


def best_of(pairs, weights):
    """Of each pair with any pose: kind, rmse of the likeliest, its log odds, its share among its rivals."""
    found = []
    for key, rows in pairs:
        if not len(rows):
            continue
        odds = rows[:, 1:] @ weights
        best = odds.argmax()
        found.append((key, rows[best, 0], [1.0, odds[best]], 1 / np.exp(odds - odds[best]).sum()))
    return found


def probability(found, confidence):
    odds = np.array([f[2] for f in found]) @ confidence
    return np.array([f[3] for f in found]) / (1 + np.exp(-np.clip(odds, -30, 30)))


def fit_confidence(found):
    clear = [f for f in found if not SOLVED_M <= f[1] <= NEARLY_M]
    return logistic(np.array([f[2] for f in clear]), np.array([f[1] < SOLVED_M for f in clear]), np.ones(len(clear)),
                    np.array([True, True]))


def fit(pairs):
    """Confidence is fitted on poses that the weights were not fitted on."""
    folds = [fit_poses(pairs[:i] + pairs[i + len(pairs) // 5 :]) for i in range(0, len(pairs), max(1, len(pairs) // 5))]
    size = max(1, len(pairs) // 5)
    found = [f for k, w in enumerate(folds) for f in best_of(pairs[k * size : (k + 1) * size], w)]
    return fit_poses(pairs), fit_confidence(found)


def report(name, pairs, found, confidence):
    p = probability(found, confidence)
    right = np.array([f[1] < SOLVED_M for f in found])
    loss = -np.log(np.where(right, p, 1 - p).clip(1e-6)).mean()
    bins = np.digitize(p, [0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.99])
    error = sum((bins == b).sum() * abs(p[bins == b].mean() - right[bins == b].mean()) for b in set(bins)) / len(p)
    solvable = sum((r[:, 0] < SOLVED_M).any() for _, r in pairs if len(r))
    trusted = "; ".join(f"{100 * k:g} %: {(p >= 1 - k).sum()} ({(~right[p >= 1 - k]).sum()} wrong)" for k in RISKS)
    print(f"{name}: {len(pairs)} pairs, {right.sum()} right of {solvable} in question, log loss {loss:.3f}, "
          f"calibration error {error:.3f}; trusted at {trusted}")
    return p, right


def main():
    pairs = read(sys.argv[1])
    kinds = ("published", "low overlap", "other", "no overlap")
    for scene in dict.fromkeys(key[0] for key, _ in pairs):
        weights, confidence = fit([p for p in pairs if p[0][0] != scene])
        for kind in range(4):
            held = [p for p in pairs if p[0] == (scene, kind)]
            if held:
                report(f"{scene}, {kinds[kind]}", held, best_of(held, weights), confidence)
    weights, confidence = fit(pairs)
    print("weights", ", ".join(f"{w:.3f}" for w in weights))
    print("confidence", ", ".join(f"{w:.3f}" for w in confidence))


if __name__ == "__main__":
    main()
