#!/usr/bin/env python3
"""Holds liloc.idl to its protocol version: its meaning may not change while the version stays.

check_version.py           exit 0: liloc.idl is what versions.txt keeps for the present kProtocolVersion; 1: it is not
check_version.py --renew   keeps the present meaning; refused for a version that was released

versions.txt has a line per version: its number, the digest of liloc.idl without comments and blanks, and the release
that it came with, or "unreleased".
"""
import hashlib
import pathlib
import re
import sys

IDL = pathlib.Path(__file__).resolve().parent.parent
ROOT = IDL.parent
COMMAND = "python3 idl/tests/check_version.py --renew"


def digest(idl):
    """Of what the IDL means: comments and blanks do not count."""
    text = re.sub(r"//[^\n]*|/\*.*?\*/", " ", idl, flags=re.S)
    words = re.findall(r"[A-Za-z0-9_]+|[^\sA-Za-z0-9_]", text)
    return hashlib.sha256(" ".join(words).encode()).hexdigest()


def present_version(header):
    return int(re.search(r"kProtocolVersion\s*=\s*(\d+)", header).group(1))


def read_versions(text):
    rows = [line.split() for line in text.splitlines() if line.strip() and not line.startswith("#")]
    return {int(version): (kept, release) for version, kept, release in rows}


def problem(idl, version, kept):
    """Why the IDL is not that of the version, or None."""
    if version not in kept:
        return f"protocol version {version} has no digest in idl/versions.txt; keep it: {COMMAND}"
    was, release = kept[version]
    if digest(idl) == was:
        return None
    if release != "unreleased":
        return (f"liloc.idl has changed, but protocol version {version} was released with {release}; raise "
                f"kProtocolVersion in common/protocol/spot.hpp, then: {COMMAND}")
    return f"liloc.idl has changed within version {version}, which is not released yet; keep it: {COMMAND}"


def renewed(text, idl, version):
    kept = read_versions(text)
    if version in kept and kept[version][1] != "unreleased" and kept[version][0] != digest(idl):
        raise ValueError(problem(idl, version, kept))
    lines = [line for line in text.splitlines() if line.startswith("#") or line.split()[:1] != [str(version)]]
    release = kept.get(version, (None, "unreleased"))[1]
    return "\n".join(lines + [f"{version} {digest(idl)} {release}"]) + "\n"


def main(arguments):
    idl = (IDL / "liloc.idl").read_text()
    version = present_version((ROOT / "common/protocol/spot.hpp").read_text())
    versions = IDL / "versions.txt"
    if arguments == ["--renew"]:
        try:
            versions.write_text(renewed(versions.read_text(), idl, version))
        except ValueError as refused:
            print(refused, file=sys.stderr)
            return 1
        return 0
    if arguments:
        print(__doc__)
        return 0 if arguments == ["--help"] else 2
    wrong = problem(idl, version, read_versions(versions.read_text()))
    if wrong:
        print(wrong, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
