#!/usr/bin/env python3
"""Runs every command of deploy/HANDBOOK.md on a simulated site, in its order but for what waits for the installation.

handbook_test.py ROOT BUILD   exit 0: all succeeded; 1: the one that failed is named; 77: not permitted here

In namespaces of its own: what is installed and configured is seen by nobody else, and the network is a loopback of its
own. `sudo` runs what it is given, `sysctl` changes nothing, `systemctl` starts what a unit names, and `journalctl` has
what that says.
"""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

SKIPPED = 77
LIMIT_S = 240
OVERLAID = ["/etc", "/usr/local", "/var/lib"]
SUDO = '#!/bin/sh\nexec "$@"\n'
SYSCTL = '#!/bin/sh\ntest "$*" = --system\n'
SYSTEMCTL = r"""#!/bin/bash
# enable --now UNIT, start UNIT, stop UNIT, restart UNIT; as far as the handbook goes.
set -euo pipefail
verb="$1" unit="${*: -1}"
[[ "$verb" != enable ]] || [[ "$2" == --now ]]
instance="${unit#*@}" template="$unit"
[[ "$unit" != *@* ]] || template="${unit%%@*}@"
file="/usr/local/lib/systemd/system/$template.service"
command="$(sed -n 's/^ExecStart=//p' "$file")"
[[ -n "$command" ]]
pid="$PWD/$unit.pid"
if [[ "$verb" == stop || "$verb" == restart ]]; then
  kill "$(cat "$pid")"
  # One that has ended may stay as a zombie: nobody waits for it here.
  while grep -qs '^State:[[:space:]]*[A-Y]' "/proc/$(cat "$pid")/status"; do sleep 0.05; done
  [[ "$verb" != stop ]] || exit 0
fi
mkdir -p /var/lib/liloc "$PWD/journal"
${command//%i/$instance} >>"$PWD/journal/$unit.log" 2>&1 &
echo $! >"$pid"
"""
JOURNALCTL = r"""#!/bin/bash
# -u UNIT --since TIME; all that the unit has said, as it runs for no longer than the handbook waits.
set -euo pipefail
[[ "$1" == -u && "$3" == --since && -n "$4" && $# == 4 ]]
date --date "$4" >/dev/null
cat "$PWD/journal/$2.log"
"""


def blocks(text):
    """The commands in the order in which they can be run: what has to wait for the installation comes after it."""
    found = re.findall(r"^```sh([^\n]*)\n(.*?)^```$", text, re.M | re.S)
    waiting = [body for mark, body in found if "@after-install" in mark]
    rest = [body for mark, body in found if "@after-install" not in mark]
    return rest[:1] + waiting + rest[1:]


def own_namespaces():
    """The folder to work in, once in namespaces of its own; the call outside of them does not come back."""
    if "LILOC_HANDBOOK" in os.environ:
        return pathlib.Path(os.environ["LILOC_HANDBOOK"])
    user = [] if os.geteuid() == 0 else ["--map-root-user"]
    flags = ["unshare", *user, "--mount", "--net", "--pid", "--fork", "--mount-proc", "--kill-child"]
    if subprocess.run([*flags, "true"], capture_output=True).returncode != 0:
        print("SKIPPED: namespaces are not permitted here")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as work:
        inside = subprocess.run([*flags, sys.executable, *sys.argv], env={**os.environ, "LILOC_HANDBOOK": work})
    sys.exit(inside.returncode)


def stage(work, root, build):
    """Folders that take what is written, commands that stand for others, and a loopback."""
    subprocess.run(["mount", "-t", "tmpfs", "tmpfs", work], check=True)
    for i, folder in enumerate(OVERLAID):
        upper, scratch = work / f"upper{i}", work / f"scratch{i}"
        upper.mkdir()
        scratch.mkdir()
        options = f"lowerdir={folder},upperdir={upper},workdir={scratch}"
        subprocess.run(["mount", "-t", "overlay", "overlay", "-o", options, folder], check=True)
    subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
    commands = work / "commands"
    commands.mkdir()
    for name, text in [("sudo", SUDO), ("sysctl", SYSCTL), ("systemctl", SYSTEMCTL),
                       ("journalctl", JOURNALCTL)]:
        (commands / name).write_text(text)
        (commands / name).chmod(0o755)
    tree = work / "tree"
    (tree / "build").mkdir(parents=True)
    (tree / "build" / "release").symlink_to(build)
    (tree / "deploy").symlink_to(root / "deploy")
    return tree, commands


def run(tree, commands, script):
    env = {**os.environ, "PATH": f"{commands}:/usr/local/bin:{os.environ['PATH']}", "HOME": str(tree)}
    shell = subprocess.Popen(["bash", "-euxo", "pipefail", "-c", script], cwd=tree, env=env, start_new_session=True)
    try:
        return shell.wait(LIMIT_S)
    except subprocess.TimeoutExpired:
        os.killpg(shell.pid, signal.SIGKILL)
        print(f"handbook: not done after {LIMIT_S} s")
        return 1


def main():
    root, build = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    if int(pathlib.Path("/proc/sys/net/core/rmem_max").read_text()) < 4194304:
        print("SKIPPED: net.core.rmem_max is too low here; `liloc doctor` would say so")
        return SKIPPED
    tree, commands = stage(own_namespaces(), root, build)
    parts = blocks((root / "deploy" / "HANDBOOK.md").read_text())
    if len(parts) < 8:
        print("handbook: its commands are not found")
        return 1
    status = run(tree, commands, "\n".join(parts))
    if status == 0:
        return 0
    for log in sorted([*tree.glob("*.log"), *tree.glob("journal/*.log")]):
        print(f"--- {log.name}\n" + "\n".join(log.read_text(errors="replace").splitlines()[-15:]))
    print("handbook: the last command above failed")
    return 1


if __name__ == "__main__":
    sys.exit(main())
