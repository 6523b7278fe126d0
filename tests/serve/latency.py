#!/usr/bin/env python3
"""How soon a picture follows an input, and how many pictures a second, in Chromium with 480x300 pixels:
    latency.py WHIT [SCENE]
on loopback, and through a relay of 10 Mbit/s that delays each direction by 20 and by 40 ms. Prints numbers and
asserts nothing. The relay stands for `tc netem`, which few kernels have; its queue is 64 kB."""
import os
import queue
import socket
import statistics
import sys
import threading
import time

from browser import Browser, Server

QUEUE_BYTES, CHUNK = 65536, 1448


class Relay:
    """Forwards connections to a port, at so many bits a second in each direction and so much later."""

    def __init__(self, port, bits, delay):
        self.port, self.bits, self.delay = port, bits, delay
        self.free = {True: 0.0, False: 0.0}  # when each direction of the link is free: all connections share it
        self.lock = threading.Lock()
        self.listener = socket.create_server(("127.0.0.1", 0))
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        while True:
            near, _ = self.listener.accept()
            far = socket.create_connection(("127.0.0.1", self.port))
            for a, b, up in ((near, far, True), (far, near, False)):
                for s in (a, b):
                    s.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                waiting = queue.Queue(QUEUE_BYTES // CHUNK)
                threading.Thread(target=self.take, args=(a, waiting, up), daemon=True).start()
                threading.Thread(target=self.give, args=(b, waiting), daemon=True).start()

    def take(self, source, waiting, up):
        while True:
            try:
                data = source.recv(CHUNK)
            except OSError:
                data = b""
            with self.lock:
                self.free[up] = max(self.free[up], time.monotonic()) + 8 * len(data) / self.bits
                due = self.free[up] + self.delay
            waiting.put((due, data))
            if not data:
                return
            time.sleep(max(0, due - self.delay - time.monotonic()))

    @staticmethod
    def give(sink, waiting):
        while True:
            due, data = waiting.get()
            time.sleep(max(0, due - time.monotonic()))
            try:
                if not data:
                    return sink.shutdown(socket.SHUT_WR)
                sink.sendall(data)
            except OSError:
                data = b""


def measure(browser, url, name):
    browser.size(480, 400)
    browser.open(url)
    browser.wait("typeof whit === 'object' && whit.frames > 0", 60)
    browser.run("document.body.classList.add('bare')")
    header = browser.run("return document.querySelector('header').offsetHeight")
    browser.size(480, 300 + header)
    browser.wait("whit.exact && stage.clientHeight === 300", 120)
    waits = []
    for i in range(12):
        browser.wait("whit.exact", 120)
        waits.append(browser.run(
            "const before = whit.frames, begin = performance.now();"
            f"drag('left', {9 if i % 2 else -9}, 0);"
            "while (whit.frames === before) await new Promise(done => setTimeout(done, 1));"
            "return performance.now() - begin"))
    moving = browser.run(
        "const begin = performance.now(), before = whit.frames, sizes = [];"
        "let i = 0; while (performance.now() - begin < 6000) {"
        "drag('left', i++ % 120 < 60 ? 2 : -2, 0); sizes.push(picture.width);"
        "await new Promise(done => setTimeout(done, 16)); }"
        "return [(whit.frames - before) / (performance.now() - begin) * 1000,"
        " sizes.sort((a, b) => a - b)[sizes.length >> 1]]")
    print(f"{name}: the picture changes after {statistics.median(waits):.0f} ms (median of {len(waits)}, longest "
          f"{max(waits):.0f}); in motion {moving[0]:.1f} pictures a second, median width {moving[1]}", flush=True)


whit = os.path.abspath(sys.argv[1])
server = Server(whit, sys.argv[2] if len(sys.argv) > 2 else "atrium", "--quiet")
browser = Browser()
try:
    port = int(server.url.split(":")[2].split("/")[0])
    measure(browser, server.url, "loopback")
    for delay in (0.02, 0.04):
        relay = Relay(port, 10e6, delay)
        address = server.url.replace(f":{port}", f":{relay.listener.getsockname()[1]}")
        measure(browser, address, f"10 Mbit/s, {1000 * delay:.0f} ms each way")
finally:
    browser.stop()
    server.stop()
