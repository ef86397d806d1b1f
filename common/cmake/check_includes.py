#!/usr/bin/env python3
"""Checks every `#include "room/..."` against the one-way rule: a room includes only the rooms it needs.

check_includes.py [ROOT]   exit 0: all includes keep the rule; 1: file:line and the rule for each that does not
A room may use what it needs directly or through those. Tests (in a room's tests/ folder) may also use
common/testing and common/recording. Only the rooms in DDS_ROOMS may include the transport itself.
"""
import pathlib
import re
import subprocess
import sys

NEEDS = {
    "idl": [],
    "common/base": [],
    "common/command": ["common/base"],
    "common/credentials": ["common/base"],
    "common/geometry": ["common/base"],
    "common/protocol": ["common/geometry"],
    "common/registration": ["common/registration/spot", "common/registration/scan"],
    "common/registration/points": ["common/geometry"],
    "common/registration/sight": ["common/registration/points"],
    "common/registration/features": ["common/registration/points"],
    "common/registration/field": ["common/registration/sight"],
    "common/registration/target": ["common/registration/field"],
    "common/registration/search": ["common/registration/target", "common/registration/features"],
    "common/registration/refine": ["common/registration/target"],
    "common/registration/spot": ["common/registration/search", "common/registration/refine"],
    "common/registration/scan": ["common/registration/points"],
    "common/learned": ["common/registration/features"],
    "common/codec": ["common/geometry", "common/protocol"],
    "common/recording": ["common/geometry"],
    "common/recording/bags": ["common/recording"],
    "common/testing": ["common/registration"],
    "common/wire": ["common/wire/spots", "common/wire/ros"],
    "common/wire/dds": ["idl", "common/geometry", "common/credentials"],
    "common/wire/spots": ["common/wire/dds", "common/protocol"],
    "common/wire/sensors": ["common/wire/dds"],
    "common/wire/ros": ["common/wire/sensors"],
    "server/global_cloud": ["common/registration"],
    "server/localization": ["server/global_cloud", "common/registration", "common/codec", "common/protocol"],
    "server/survey": ["common/registration"],
    "server/plan": ["common/registration"],
    "server/answers": ["server/localization", "common/recording"],
    "server/ingest": ["common/wire", "server/global_cloud"],
    "server/service": ["server/localization", "common/wire"],
    "server/web": ["server/service"],
    "server/view": ["server/web", "common/codec"],
    "server/tools": ["server/survey", "server/answers", "server/global_cloud", "common/recording/bags", "common/wire",
                     "common/command", "common/learned"],
    "server/tools/plan": ["server/plan", "server/tools", "common/recording", "common/command"],
    "server/app": ["server/service", "server/ingest", "server/answers", "server/view", "common/recording",
                   "common/command", "common/learned"],
    "client/include": ["common/base"],
    "client/inertial": ["common/geometry"],
    "client/odometry": ["client/inertial", "common/registration"],
    "client/engine": ["client/odometry", "common/codec", "common/protocol"],
    "client/session": ["client/engine"],
    "client/api": ["client/include", "client/session", "common/wire"],
    "client/examples": ["client/include"],
    "client/app": ["client/api", "common/recording", "common/command"],
    "client/python": ["client/include"],
    "proto-tests/sim": ["proto-tests/sim/motion", "proto-tests/sim/sensors", "common/recording"],
    "proto-tests/sim/base": ["common/base"],
    "proto-tests/sim/shapes": ["common/geometry"],
    "proto-tests/sim/site": ["proto-tests/sim/base", "proto-tests/sim/shapes"],
    "proto-tests/sim/motion": ["proto-tests/sim/site"],
    "proto-tests/sim/sensors": ["proto-tests/sim/base", "proto-tests/sim/shapes"],
    # The tools and trials see both sides.
    "proto-tests": ["server/app", "server/tools", "server/tools/plan", "client/app", "proto-tests/sim", "common/testing"],
}
TEST_EXTRAS = ["common/testing", "common/recording"]
DDS_ROOMS = {"idl", "common/wire", "common/wire/dds", "common/wire/spots", "common/wire/sensors", "common/wire/ros",
             "proto-tests"}
TRANSPORT = re.compile(r"^(dds/|ddsc/|liloc\.h$|ros2\.h$)")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^">]+)[">]')
SOURCES = {".cpp", ".hpp", ".h", ".c", ".cc", ".idl"}


def reach(room):
    """The room and everything it needs, directly or through those."""
    seen, todo = set(), [room]
    while todo:
        name = todo.pop()
        if name not in seen:
            seen.add(name)
            todo += NEEDS[name]
    return seen


def room_of(path):
    """The room that a root-relative path lies in, or None."""
    return next((room for room in sorted(NEEDS, key=len, reverse=True) if path.startswith(room + "/")), None)


def sources(root):
    """Tracked and new files; a tree without git (a release archive) is walked instead."""
    try:
        listed = subprocess.run(["git", "-C", root, "ls-files", "-co", "--exclude-standard"], check=True,
                                capture_output=True, text=True).stdout.splitlines()
    except (OSError, subprocess.CalledProcessError):
        listed = [str(path.relative_to(root)) for path in root.rglob("*")
                  if path.is_file() and path.relative_to(root).parts[0] not in ("build", ".git")]
    return sorted(path for path in listed if pathlib.Path(path).suffix in SOURCES and (root / path).exists())


def problem(path, quote, included):
    room = room_of(path)
    if room is None:
        return "lies in no room: add its folder to NEEDS"
    if TRANSPORT.match(included) and room not in DDS_ROOMS:
        return f"includes the transport ({included}): only {', '.join(sorted(DDS_ROOMS))} know of it"
    target = room_of(included) if quote == '"' else None
    if target is None:
        return None
    allowed = reach(room)
    if "/tests/" in path:
        allowed = allowed.union(*(reach(extra) for extra in TEST_EXTRAS))
    if target in allowed:
        return None
    return f"{room} includes {target} ({included}): it needs only {', '.join(NEEDS[room]) or 'the standard library'}"


def check(root):
    problems, count = [], 0
    for path in sources(root):
        for number, line in enumerate((root / path).read_text(errors="replace").splitlines(), 1):
            found = INCLUDE.match(line)
            if not found:
                continue
            count += 1
            text = problem(path, *found.groups())
            if text:
                problems.append(f"{path}:{number}: {text}")
    return problems, count


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    problems, count = check(root)
    if count == 0:
        print(f"check_includes: no #include found below {root}: is it the project's root?", file=sys.stderr)
        return 1
    print("\n".join(problems) if problems else f"{count} includes keep the one-way rule")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
