#!/usr/bin/env python3
"""Checks that a built libliloc-client.so shows the public API and nothing else, and links nothing heavy.

check_library.py LIBRARY CLIENT_H SONAME   exit 0: it does; 1: a line for each symbol or library at fault
"""
import pathlib
import re
import subprocess
import sys

CPP_API = {"create", "~Client", "push_depth", "push_unusable", "push_imu", "push_points", "push_odometry", "newest", "stats", "stop"}
CPP_CALL = re.compile(r"^liloc::client::Client::(~?\w+)(?:\[abi:\w+\])?\(")
# PCL's I/O and visualization drag VTK and Qt along: too much for a robot.
HEAVY = re.compile(r"pcl_(io|visualization)|vtk|Qt5|Qt6|GL\b|libX11|embree|png|python", re.IGNORECASE)


def declared_in(header):
    """Functions that the C header declares."""
    text = re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)
    return set(re.findall(r"^[\w* ]*\b(liloc_client_\w+)\(", text, flags=re.MULTILINE))


def faults(symbols, needed, soname, header, wanted_soname):
    """One line for each; `symbols` are demangled names of defined dynamic symbols."""
    c_api, found_c, found_cpp, found = declared_in(header), set(), set(), []
    for symbol in symbols:
        call = CPP_CALL.match(symbol)
        if symbol in c_api:
            found_c.add(symbol)
        elif call:
            found_cpp.add(call.group(1))
        elif not symbol.startswith("liloc::client::set_log(") and symbol != "__odr_asan":
            found.append(f"shows {symbol}: add it to a public header, or hide it in liloc-client.map")
    found += [f"lacks {name}, which client.h declares" for name in sorted(c_api - found_c)]
    found += [f"lacks liloc::client::Client::{name}" for name in sorted(CPP_API - found_cpp)]
    found += [f"links {name}" for name in needed if HEAVY.search(name)]
    if not any(symbol.startswith("liloc::client::set_log(") for symbol in symbols):
        found.append("lacks liloc::client::set_log")
    if soname != wanted_soname:
        found.append(f"SONAME is {soname}, not {wanted_soname}")
    return found


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def main():
    library, header, wanted_soname = sys.argv[1:]
    listing = output_of("nm", "-D", "--defined-only", "-C", "--format=posix", library)
    # posix: name, type, value, size; names may hold blanks
    symbols = [re.sub(r"\s+[A-Za-z]\s+[0-9a-f]+(\s+[0-9a-f]+)?$", "", line.strip()) for line in listing.splitlines()]
    dynamic = output_of("readelf", "-d", "-W", library)
    needed = re.findall(r"\(NEEDED\).*\[(.*)\]", dynamic)
    soname = (re.findall(r"\(SONAME\).*\[(.*)\]", dynamic) or ["missing"])[0]
    found = faults(symbols, needed, soname, pathlib.Path(header).read_text(), wanted_soname)
    print("\n".join(f"{library}: {fault}" for fault in found))
    print(f"{len(symbols)} symbols shown; links {', '.join(needed)}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
