"""Chromium and a server of whit for tests: starts both, and looks at the page over the DevTools protocol."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.request

BROWSERS = ("chromium", "chromium-browser", "google-chrome")


def skip(why):
    print(f"!! NOT checked: {why}")
    sys.exit(77)


try:
    import websocket
except ImportError:
    skip("python3-websocket is not here: the page of whit serve is not looked at")


class Server:
    """`whit serve` with these words; `url` is its address."""

    def __init__(self, whit, *words):
        self.process = subprocess.Popen([whit, "serve", *words], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                        text=True)
        self.url = self.process.stdout.readline().strip()
        if not self.url.startswith("http://"):
            raise RuntimeError("whit serve printed no address")

    def stop(self):
        self.process.terminate()
        self.process.wait(20)


class Browser:
    """A headless Chromium with one page."""

    def __init__(self):
        found = next((name for name in map(shutil.which, BROWSERS) if name), None)
        if not found:
            skip("no Chromium here: the page of whit serve is not looked at")
        self.folder = tempfile.mkdtemp()
        self.log = open(os.path.join(self.folder, "log"), "w+")
        self.process = subprocess.Popen(
            [found, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
             "--remote-debugging-port=0", "--remote-allow-origins=*", f"--user-data-dir={self.folder}/profile",
             "about:blank"], stdout=subprocess.DEVNULL, stderr=self.log)
        where = os.path.join(self.folder, "profile", "DevToolsActivePort")
        for _ in range(300):
            if os.path.exists(where) and open(where).read().count("\n"):
                break
            time.sleep(0.1)
        port = open(where).read().split("\n")[0]
        self.pages = f"http://127.0.0.1:{port}/json/list"
        self.number = 0
        self.events = []
        self.attach("page")

    def attach(self, kind):
        """Talks to the page, or to the "iframe" of another site in it, from now on. Returns whether it is there."""
        with urllib.request.urlopen(self.pages) as answer:
            pages = json.load(answer)
        page = next((page for page in pages if page["type"] == kind), None)
        if page:
            self.socket = websocket.create_connection(page["webSocketDebuggerUrl"], timeout=60)
            for domain in ("Page", "Runtime", "Network", "Log"):
                self.call(f"{domain}.enable")
        return page is not None

    def call(self, method, **parameters):
        self.number += 1
        self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            message = json.loads(self.socket.recv())
            if message.get("id") == self.number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']}")
                return message["result"]
            self.events.append(message)

    def size(self, width, height, density=1):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=density,
                  mobile=False)

    def open(self, url):
        self.call("Page.navigate", url=url)

    def run(self, script):
        answer = self.call("Runtime.evaluate", expression=f"(async () => {{ {script} }})()",
                           awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(answer["exceptionDetails"]["exception"].get("description"))
        return answer["result"].get("value")

    def wait(self, condition, seconds=60):
        """Waits until a condition in the page's script holds, and returns its value."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            value = self.run(f"const value = {condition}; return value instanceof Node || value")
            if value:
                return value
            time.sleep(0.05)
        raise AssertionError(f"{condition} did not become true")

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def drag(self, start, end, steps=8, pause=0.02, button="left"):
        buttons = {"left": 1, "right": 2, "middle": 4}[button]
        self.mouse("mousePressed", *start, button=button, buttons=buttons, clickCount=1)
        for i in range(1, steps + 1):
            at = [a + (b - a) * i / steps for a, b in zip(start, end)]
            self.mouse("mouseMoved", *at, button=button, buttons=buttons)
            time.sleep(pause)
        self.mouse("mouseReleased", *end, button=button, buttons=0, clickCount=1)

    def click(self, x, y):
        self.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        self.mouse("mouseReleased", x, y, button="left", buttons=0, clickCount=1)

    def key(self, code, key, kinds=("keyDown", "keyUp"), pause=0.0, **more):
        for kind in kinds:
            self.call("Input.dispatchKeyEvent", type=kind, code=code, key=key, **more)
            time.sleep(pause)

    def screenshot(self, path):
        import base64
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("Page.captureScreenshot")["data"]))

    def stop(self):
        self.socket.close()
        self.process.terminate()
        self.process.wait(20)
        self.log.close()
        shutil.rmtree(self.folder, ignore_errors=True)
