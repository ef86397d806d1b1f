#!/usr/bin/env bash
# Installed units name the installed program and expose less than 1.5 of systemd's 10.
#   units_test.sh BUILD COMPONENT UNIT PROGRAM
set -euo pipefail
build="$1" component="$2" unit="$3" program="$4"
stage="$(mktemp -d)"
trap 'rm -rf "$stage"' EXIT
DESTDIR="$stage" cmake --install "$build" --component "$component" --prefix /opt/liloc >/dev/null
file="$stage/opt/liloc/lib/systemd/system/$unit"
grep -q "^ExecStart=/opt/liloc/bin/$program " "$file"
test -x "$stage/opt/liloc/bin/$program"
if ! command -v systemd-analyze >/dev/null; then
  echo "SKIPPED: no systemd-analyze here"
  exit 77
fi
systemd-analyze security --offline=true --threshold=15 --no-pager "$file" | tail -1
