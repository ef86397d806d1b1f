#!/usr/bin/env python3
"""What viewers of `liloc-server --web` cost: its threads' processor time, its memory, bytes to each viewer.

page_viewers.py PID PORT [--viewers N] [--slow BYTES_A_SECOND] [--seconds S]   on loopback, without a token
"""
import argparse
import os
import pathlib
import selectors
import socket
import time


def viewer(port, receive_buffer=0):
    one = socket.socket()
    if receive_buffer:
        one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
    one.connect(("127.0.0.1", port))
    one.sendall(f"GET /live HTTP/1.1\r\nHost: localhost:{port}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n".encode())
    if not one.recv(12).startswith(b"HTTP/1.1 101"):
        raise SystemExit("page_viewers: refused: is --web on, without a token, and not full?")
    one.setblocking(False)
    return one


def thread_times_s(pid):
    times = {}
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        fields = (task / "stat").read_text().rsplit(")", 1)[1].split()
        times[(task / "comm").read_text().strip(), task.name] = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return times


def resident_mb(pid):
    return int(pathlib.Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE") / 1e6


def read_for(seconds, viewers, slow, bytes_a_second):
    chosen, counts = selectors.DefaultSelector(), {}
    for one in viewers:
        chosen.register(one, selectors.EVENT_READ)
        counts[one] = 0
    start, slow_bytes = time.monotonic(), 0
    while (past := time.monotonic() - start) < seconds:
        for key, _ in chosen.select(0.05):
            count = len(key.fileobj.recv(1 << 18))
            if count == 0:  # else it would count as readable for ever
                raise SystemExit("page_viewers: the server has closed a viewer's connection")
            counts[key.fileobj] += count
        if slow and slow_bytes < past * bytes_a_second:
            try:
                slow_bytes += len(slow.recv(max(1, int(past * bytes_a_second) - slow_bytes)))
            except BlockingIOError:
                pass
    return [count / seconds for count in counts.values()], slow_bytes / seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pid", type=int)
    parser.add_argument("port", type=int)
    parser.add_argument("--viewers", type=int, default=50)
    parser.add_argument("--slow", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=20)
    arguments = parser.parse_args()
    before_mb = resident_mb(arguments.pid)
    viewers = [viewer(arguments.port) for _ in range(arguments.viewers)]
    slow = viewer(arguments.port, 65536) if arguments.slow else None
    read_for(3, viewers, slow, arguments.slow)  # the room is sent to each
    times = thread_times_s(arguments.pid)
    rates, slow_rate = read_for(arguments.seconds, viewers, slow, arguments.slow)
    used = sorted(((now - times.get(task, 0)) / arguments.seconds, task)
                  for task, now in thread_times_s(arguments.pid).items())
    if rates:
        print(f"{len(rates)} viewers: {sum(rates) / len(rates) / 1e3:.0f} kB/s each, least {min(rates) / 1e3:.0f}")
    if slow:
        print(f"slow one: {slow_rate / 1e3:.0f} kB/s")
    print(f"resident: {before_mb:.1f} MB before, {resident_mb(arguments.pid):.1f} MB now")
    print("threads, % of a core:", ", ".join(f"{100 * share:.1f} {task[0]}" for share, task in reversed(used)))


if __name__ == "__main__":
    main()
