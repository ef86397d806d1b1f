#!/usr/bin/env python3
"""Prints which lines a test run has reached: their share by room, and the unreached ones of what changed.

coverage.py BUILD [ROOT]   BUILD: a folder built by the preset `coverage` whose tests have run; exit 1 where none has
Changed is what differs from where this branch left origin's default branch, or from the commit in LILOC_BASE.
"""
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys

from check_includes import room_of

HUNK = re.compile(r"^@@ -\S+ \+(\d+)(?:,(\d+))? @@")


def git(root, *arguments):
    """What git prints; empty where it fails."""
    return subprocess.run(["git", "-C", root, *arguments], capture_output=True, text=True).stdout.strip()


def base_commit(root):
    """As .ci/run has it."""
    named = os.environ.get("LILOC_BASE", "")
    if named:
        return git(root, "rev-parse", "--verify", "--quiet", named + "^{commit}")
    base = git(root, "merge-base", "HEAD", "origin/HEAD")
    return base if base and base != git(root, "rev-parse", "HEAD") else git(root, "rev-parse", "--verify", "--quiet", "HEAD~1")


def gcov(data):
    """The report of one .gcda file, as gcov's JSON."""
    done = subprocess.run(["gcov", "--json-format", "--stdout", data.name], cwd=data.parent, capture_output=True, text=True)
    return json.loads(done.stdout) if done.returncode == 0 and done.stdout.strip() else {"files": []}


def reached(build, root):
    """How often each line ran, by file below the root; tests and what is generated are left out."""
    counts = collections.defaultdict(lambda: collections.defaultdict(int))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for report in pool.map(gcov, sorted(build.rglob("*.gcda"))):
            for file in report["files"]:
                path = pathlib.Path(os.path.normpath(build / file["file"]))
                if not path.is_relative_to(root) or path.is_relative_to(build) or "tests" in path.parts:
                    continue
                lines = counts[str(path.relative_to(root))]
                for line in file["lines"]:
                    lines[line["line_number"]] += line["count"]
    return counts


def print_rooms(counts):
    rooms = collections.defaultdict(lambda: [0, 0])
    for path, lines in counts.items():
        room = rooms[room_of(path) or "(no room)"]
        room[0] += sum(count > 0 for count in lines.values())
        room[1] += len(lines)
    for name, (hit, total) in sorted(rooms.items()):
        print(f"{name:34} {100 * hit / max(total, 1):5.1f} % of {total:5d} lines")


def changed_lines(root, base):
    """Numbers of the lines that are new or other than in `base`, by file."""
    changed, path = collections.defaultdict(set), None
    for line in git(root, "diff", "-U0", "--no-color", base, "--", "*.cpp", "*.hpp").splitlines():
        if line.startswith("+++ "):
            path = line[6:] if line.startswith("+++ b/") else None
        elif path and (hunk := HUNK.match(line)):
            first, count = int(hunk[1]), int(hunk[2] or 1)
            changed[path].update(range(first, first + count))
    return changed


def print_changed(counts, changed, root):
    missed = total = 0
    for path in sorted(changed.keys() & counts.keys()):
        text = (root / path).read_text(errors="replace").splitlines()
        for number in sorted(changed[path] & counts[path].keys()):
            total += 1
            if counts[path][number] == 0 and number <= len(text):
                missed += 1
                print(f"{path}:{number}: {text[number - 1].strip()}")
    print(f"{missed} of {total} changed lines that have code were not reached")


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    root = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else ".").resolve()
    counts = reached(build, root)
    if not counts:
        print(f"coverage: no counts below {build}: run deploy/test --coverage", file=sys.stderr)
        return 1
    print_rooms(counts)
    base = base_commit(root)
    if base:
        print(f"\nnot reached, of what changed since {git(root, 'log', '-1', '--format=%h %s', base)}")
        print_changed(counts, changed_lines(root, base), root)
    return 0


if __name__ == "__main__":
    sys.exit(main())
