#!/usr/bin/env python3
"""The page in headless Chromium: it draws a simulated site, moves, picks a device, and survives a server's restart.

browser_test.py BIN [--screenshot FILE]   BIN holds liloc, liloc-server and liloc-client; FILE.png gets a FILE.phone.png beside it
exit 0: it does; 1: it does not; 77: there is no Chromium (`deploy/install --page`)
"""
import argparse
import base64
import json
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import zlib

DOMAIN = "181"
SITE = ["--lidars", "3", "--lidar-rate", "5", "--devices", "2", "--device-rate", "10", "--people", "3", "--seed", "7",
        "--image-width", "240", "--image-height", "180", "--seconds", "600"]


class Failure(Exception):
    pass


class Chromium:
    """One page, spoken to over a pipe: no port is opened."""

    def __init__(self, program, folder):
        to_read, self.to = os.pipe()
        self.back, to_write = os.pipe()
        self.count, self.buffer, self.events = 0, b"", []
        flags = ["--headless=new", "--no-sandbox", "--disable-gpu-sandbox", "--use-angle=swiftshader",
                 "--enable-unsafe-swiftshader", "--remote-debugging-pipe", f"--user-data-dir={folder}/profile",
                 "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
                 "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1", "--window-size=1280,800", "about:blank"]
        with open(f"{folder}/chromium.log", "w", encoding="utf-8") as log:
            environment = {**os.environ, "DBUS_SESSION_BUS_ADDRESS": "disabled:"}
            self.process = subprocess.Popen(
                ["bash", "-c", f'exec "$@" 3<&{to_read} 4>&{to_write}', "-", program, *flags],
                pass_fds=(to_read, to_write), stdout=log, stderr=log, env=environment)
        os.close(to_read)
        os.close(to_write)
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def message(self, until):
        while b"\0" not in self.buffer:
            os.set_blocking(self.back, False)
            try:
                part = os.read(self.back, 1 << 16)
            except BlockingIOError:
                part = None
            if part == b"":
                raise Failure("Chromium has ended")
            if part:
                self.buffer += part
            elif time.monotonic() > until:
                raise Failure("Chromium does not answer")
            else:
                time.sleep(0.01)
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def call(self, method, **params):
        self.count += 1
        call = {"id": self.count, "method": method, "params": params}
        if hasattr(self, "session"):
            call["sessionId"] = self.session
        os.write(self.to, json.dumps(call).encode() + b"\0")
        until = time.monotonic() + 60
        while True:
            answer = self.message(until)
            if answer.get("id") == self.count:
                if "error" in answer:
                    raise Failure(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self.events.append(answer)

    def value(self, expression):
        told = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        if "exceptionDetails" in told:
            raise Failure(f"{expression}: {told['exceptionDetails']['text']}")
        return told["result"].get("value")

    def wait(self, expression, what, limit_s=60):
        until = time.monotonic() + limit_s
        while not self.value(expression):
            if time.monotonic() > until:
                raise Failure(f"{what}: not within {limit_s} s")
            time.sleep(0.1)

    def screenshot(self, **more):
        return base64.b64decode(self.call("Page.captureScreenshot", format="png", **more)["data"])

    def complaints(self):
        """What the page's console and its network said."""
        told = []
        for event in self.events:
            params = event.get("params", {})
            if event.get("method") == "Runtime.exceptionThrown":
                details = params["exceptionDetails"]
                told.append(details.get("exception", {}).get("description", details["text"]))
            elif event.get("method") == "Log.entryAdded" and params["entry"]["level"] == "error":
                told.append(params["entry"]["text"])
        return told

    def state(self):
        try:
            return self.value("`${location} ${document.title}: ${document.body?.innerText}`")[:1500]
        except Failure as failure:
            return str(failure)

    def foreign_requests(self, origin):
        urls = [event["params"]["request"]["url"] for event in self.events
                if event.get("method") == "Network.requestWillBeSent"]
        return [url for url in urls if not url.startswith((origin, "data:", "about:", "chrome"))]


def colours(png):
    """How many colours a PNG of 8 bits a channel holds."""
    at, data, width, channels = 8, b"", 0, 3
    while at < len(png):
        size, kind = int.from_bytes(png[at:at + 4], "big"), png[at + 4:at + 8]
        body = png[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, channels = int.from_bytes(body[:4], "big"), {2: 3, 6: 4}[body[9]]
        if kind == b"IDAT":
            data += body
        at += 12 + size
    raw, stride, seen = zlib.decompress(data), width * channels, set()
    above = bytearray(stride)
    for start in range(0, len(raw), stride + 1):
        kind, row = raw[start], bytearray(raw[start + 1:start + 1 + stride])
        for i in range(stride):
            left = row[i - channels] if i >= channels else 0
            up, corner = above[i], above[i - channels] if i >= channels else 0
            guess = left + up - corner
            paeth = min((left, up, corner), key=lambda v, g=guess: abs(g - v))
            row[i] = (row[i] + (0, left, up, (left + up) // 2, paeth)[kind]) & 255
        above = row
        seen.update(bytes(row[i:i + 3]) for i in range(0, stride, channels))
    return len(seen)


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Programs:
    def __init__(self, programs, folder):
        self.programs, self.folder, self.running = programs, folder, []

    def start(self, name, *arguments):
        with open(f"{self.folder}/{name}.log", "a", encoding="utf-8") as log:
            self.running.append(subprocess.Popen([self.programs / name, *arguments], stdout=log, stderr=log))
        return self.running[-1]

    def stop(self, process):
        process.terminate()
        try:
            return process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            return process.wait()

    def stop_all(self):
        for process in reversed(self.running):
            if process.poll() is None:
                self.stop(process)


def look(browser, programs, port, screenshot):
    server = ["--site", f"{programs.folder}/site.json", "--domain", DOMAIN, "--web", str(port)]
    first = programs.start("liloc-server", *server, "--risk", "1e-6")  # so careful that it verifies next to nothing
    for device in ("device0", "device1"):
        programs.start("liloc-client", "--id", device, "--domain", DOMAIN, "--device",
                       f"{programs.folder}/{device}.json")
    origin = f"http://127.0.0.1:{port}"
    wait_for_port(port)
    browser.call("Page.navigate", url=f"{origin}/")
    browser.wait("document.title.startsWith('liloc')", "the site is told", 30)
    browser.wait("Number(document.getElementById('view').dataset.points) > 3000", "points are drawn")
    print("points drawn:", browser.value("document.getElementById('view').dataset.points"))

    uptime = browser.value("document.getElementById('uptime').textContent")
    browser.wait(f"document.getElementById('uptime').textContent !== '{uptime}'", "the clock moves", 10)
    browser.wait("Number(document.getElementById('moving-points').textContent) > 0", "people are seen to move")
    browser.wait("document.querySelectorAll('#lidars .dot.ok, #lidars .dot.slow').length === 3", "three LiDARs are heard")
    browser.wait("document.querySelectorAll('#devices button').length === 2", "two devices ask")
    browser.value("document.querySelector('#devices button[data-id=device0]').click()")
    browser.wait("!document.getElementById('chosen').hidden", "a device is picked")
    browser.wait("document.getElementById('chosen-id').textContent === 'device0'", "the picked one is shown")
    browser.wait("/^(refused|provisional): /.test(document.getElementById('chosen-why').textContent) && "
                 "/is drawn/.test(document.getElementById('chosen-scan').textContent)",
                 "why the picked device is not located is told, and its cloud drawn", 90)
    print("device0:", browser.value("document.getElementById('chosen-why').textContent"))
    browser.wait("document.querySelectorAll('#log li').length > 0", "the log is told")
    found = colours(browser.screenshot(clip={"x": 260, "y": 200, "width": 400, "height": 400, "scale": 1}))
    print("colours in the room's middle:", found)
    if found < 100:
        raise Failure(f"the room's middle has {found} colours: it is not drawn")

    if screenshot:
        pathlib.Path(screenshot).write_bytes(browser.screenshot())

    if programs.stop(first) != 0:
        raise Failure("the server did not stop in order")
    browser.wait("/server/.test(document.getElementById('banner').textContent)", "the page says that the server is gone")
    complaints = [text for text in browser.complaints() if "WebSocket" not in text and "ERR_CONNECTION" not in text]
    programs.start("liloc-server", *server)
    browser.wait("document.getElementById('banner').textContent === ''", "the page comes back", 30)
    browser.wait("document.getElementById('uptime').textContent.startsWith('0 min')", "the new server is shown")
    browser.wait("Number(document.getElementById('room-points').textContent) > 3000", "the room is drawn again")
    browser.wait("/verified: (confirmed|conclusive|corrected)/.test(document.getElementById('chosen-why').textContent)",
                 "the picked device is located", 90)
    print("device0:", browser.value("document.getElementById('chosen-figures').innerText").replace("\n", " "))
    browser.call("Emulation.setDeviceMetricsOverride", width=390, height=844, deviceScaleFactor=2, mobile=True)
    browser.wait("document.documentElement.scrollWidth <= 390", "the page fits a phone's width", 10)
    if screenshot:
        pathlib.Path(screenshot).with_suffix(".phone.png").write_bytes(browser.screenshot())
    complaints += browser.foreign_requests(f"{origin}/")
    if complaints:
        raise Failure("; ".join(complaints))


def wait_for_port(port):
    for _ in range(300):
        with socket.socket() as one:
            if one.connect_ex(("127.0.0.1", port)) == 0:
                return
        time.sleep(0.1)
    raise Failure("the server does not listen")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--screenshot")
    arguments = parser.parse_args()
    chromium = shutil.which("chromium")
    if chromium is None:
        print("browser_test: skipped: there is no Chromium; run deploy/install --page")
        return 77
    with tempfile.TemporaryDirectory(prefix="liloc-page-") as folder:
        programs, browser = Programs(arguments.programs, folder), None
        try:
            programs.start("liloc", "sim", "--live", "--domain", DOMAIN, "--describe", folder, *SITE)
            until = time.monotonic() + 30
            while not pathlib.Path(folder, "device1.json").exists() and time.monotonic() < until:
                time.sleep(0.1)
            browser = Chromium(chromium, folder)
            look(browser, programs, free_port(), arguments.screenshot)
            return 0
        except Failure as failure:
            print(f"browser_test: {failure}", file=sys.stderr)
            for log in sorted(pathlib.Path(folder).glob("*.log")):
                print(f"--- {log.name}", *log.read_text(errors="replace").splitlines()[-8:], sep="\n", file=sys.stderr)
            if browser:
                print("--- page", *browser.complaints()[-5:], browser.state(), sep="\n", file=sys.stderr)
            return 1
        finally:
            if browser:
                browser.process.terminate()
                browser.process.wait()
            programs.stop_all()


if __name__ == "__main__":
    sys.exit(main())
