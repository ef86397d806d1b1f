#!/usr/bin/env python3
"""Checks that deploy/TROUBLESHOOTING.md has a heading for every message of a client's `problem`.

check_troubleshooting.py [ROOT]   exit 0: it has; 1: the file and each message that lacks one

Messages are the texts in functions of client/ whose name ends in `problem`, those assigned to a `problem`, and the errors
by which a frame is refused. A heading in back quotes covers the messages that it is a part of. What `liloc doctor` says is
checked by server/tools/tests/diagnosis_test.cpp.
"""
import pathlib
import re
import sys

TEXT = re.compile(r'"((?:[^"\\]|\\.)*)"')
FUNCTION = re.compile(r"^std::string [\w:]*problem\(.*?^}", re.MULTILINE | re.DOTALL)
ASSIGNMENT = re.compile(r"\bproblem\s*=\s*[^;]*;", re.DOTALL)
REFUSAL = re.compile(r"\bfail\([^;]*;", re.DOTALL)
REFUSING = ["common/base/stamp_watch.cpp", "client/engine/engine.cpp"]  # their errors end in `problem`
LEAST = 12  # characters; shorter texts are parts of a message ("before")


def joined(code):
    """Texts that the compiler joins, as one."""
    return re.sub(r'"\s*\n\s*"', "", code)


def messages(root):
    for path in sorted((root / "client").rglob("*.cpp")):
        if "tests" in path.parts:
            continue
        code = joined(path.read_text())
        for pattern in (FUNCTION, ASSIGNMENT):
            for part in pattern.findall(code):
                for text in TEXT.findall(part):
                    yield path, text
    for name in REFUSING:
        for part in REFUSAL.findall(joined((root / name).read_text())):
            yield root / name, max(TEXT.findall(part), key=len, default="")


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    page = (root / "deploy/TROUBLESHOOTING.md").read_text()
    headings = re.findall(r"^### `(.*)`$", page, re.MULTILINE)
    found = [(path, text) for path, text in messages(root) if len(text) >= LEAST]
    missing = [(path, text) for path, text in found if not any(h in text for h in headings)]
    for path, text in missing:
        print(f'{path}: deploy/TROUBLESHOOTING.md has no heading for "{text}"')
    if len(found) < 10:
        print(f"only {len(found)} messages found: have the sources moved?")
        return 1
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
