"""A headless Chromium driven by its DevTools protocol over a pipe: the standard library alone.

https://chromedevtools.github.io/devtools-protocol/; messages are JSON, each closed by a zero byte.
"""
import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

PROGRAMS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")


class BrowserError(Exception):
    """The browser does not answer, or answers with an error."""


def find_browser():
    return next(filter(None, map(shutil.which, PROGRAMS)), None)


class Browser:
    """With one page; a context manager."""

    def __init__(self, program, timeout_s=120):
        self.timeout_s, self.number, self.buffer, self.session = timeout_s, 0, b"", None
        self.events = []
        self.profile = tempfile.TemporaryDirectory(prefix="browser-")
        command_read, self.command = os.pipe()
        self.answers, answer_write = os.pipe()
        flags = ["--headless", "--disable-gpu", "--hide-scrollbars", "--disable-dev-shm-usage", "--no-first-run",
                 "--remote-debugging-pipe", "--user-data-dir=" + self.profile.name]
        if os.geteuid() == 0:
            flags.append("--no-sandbox")  # which root cannot have; the pages are our own
        self.process = subprocess.Popen(  # the protocol's pipes are file descriptors 3 and 4
            ["sh", "-c", f'exec "$0" "$@" 3<&{command_read} 4>&{answer_write}', program, *flags],
            pass_fds=(command_read, answer_write), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(command_read)
        os.close(answer_write)

    def __enter__(self):
        try:
            target = self.call("Target.createTarget", url="about:blank")["targetId"]
            self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
            self.call("Page.enable")
        except BaseException:
            self.close()
            raise
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        os.close(self.command)
        os.close(self.answers)
        self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        shutil.rmtree(self.profile.name, ignore_errors=True)  # its helpers may still be writing
        self.profile._finalizer.detach()

    def read(self, end):
        """The next message; BrowserError after `end` (monotonic seconds)."""
        while b"\0" not in self.buffer:
            ready, _, _ = select.select([self.answers], [], [], max(0.0, end - time.monotonic()))
            part = os.read(self.answers, 1 << 20) if ready else b""
            if not part:
                raise BrowserError("the browser has ended" if ready else "the browser does not answer")
            self.buffer += part
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, **params):
        self.number += 1
        message = {"id": self.number, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self.command, data):]
        end = time.monotonic() + self.timeout_s
        while True:
            answer = self.read(end)
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise BrowserError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            if "method" in answer:
                self.events.append(answer["method"])

    def open(self, url, width, height, dark):
        """Loads a page as a screen of this size shows it, to a reader who prefers dark or light."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)
        self.call("Emulation.setEmulatedMedia",
                  features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.events.clear()
        self.call("Page.navigate", url=url)
        end = time.monotonic() + self.timeout_s
        while "Page.loadEventFired" not in self.events:
            self.events.append(self.read(end).get("method"))

    def evaluate(self, script):
        """The value of an expression in the page."""
        answer = self.call("Runtime.evaluate", expression=script, returnByValue=True)
        if "exceptionDetails" in answer:
            raise BrowserError(answer["exceptionDetails"].get("exception", {}).get("description", "script failed"))
        return answer["result"].get("value")

    def screenshot(self, path):
        data = self.call("Page.captureScreenshot", captureBeyondViewport=True)["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(data))
