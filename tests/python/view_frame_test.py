"""Scene.view() in a frame of another page, as a notebook shows it, in Chromium."""

import http.server
import json
import os
import pathlib
import sys
import threading
import time
import unittest

import whit
from samples import scene_of

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "serve"))


class Page(http.server.BaseHTTPRequestHandler):
    """A notebook: a page that shows a view in a frame."""

    def do_GET(self):
        body = b"<!doctype html><title>notebook</title>" + self.server.frame.encode()
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_):
        pass


class Frames(unittest.TestCase):
    def serve_page_on(self, host, view):
        """The port of a server on `host` whose page shows the view in a frame."""
        server = http.server.ThreadingHTTPServer((host, 0), Page)
        self.addCleanup(server.shutdown)
        server.frame = view._repr_html_()
        threading.Thread(target=server.serve_forever, daemon=True).start()
        return server.server_address[1]

    def test_a_notebook_shows_it_in_a_frame(self):
        view = scene_of().view(width=640, height=400)
        other_host = self.serve_page_on("127.0.0.2", view)
        notebook = self.serve_page_on("127.0.0.1", view)
        browser.size(800, 600)

        # A page of another host than localhost may not frame the view.
        browser.open(f"http://127.0.0.2:{other_host}/")
        browser.wait("document.title === 'notebook' && document.readyState === 'complete'")
        self.assertTrue(any("frame-ancestors" in json.dumps(event) for event in browser.events), browser.events)

        # A notebook's page is of localhost: the view draws, and steers by the mouse.
        browser.open(f"http://localhost:{notebook}/")
        browser.wait("location.hostname === 'localhost' && document.readyState === 'complete'")
        end = time.monotonic() + 60
        while not browser.attach("iframe"):
            self.assertLess(time.monotonic(), end, "no frame")
            time.sleep(0.1)
        browser.wait("whit.exact && whit.frames > 1")
        self.assertEqual(browser.run("return $('error').textContent"), "")
        frames = browser.run("return whit.frames")
        browser.drag((200, 200), (260, 220))
        browser.wait(f"whit.frames > {frames}")
        browser.wait("whit.exact")

        if "WHIT_SCREENSHOT" in os.environ:
            browser.attach("page")
            browser.screenshot(os.environ["WHIT_SCREENSHOT"])


if not hasattr(whit._whit, "View"):
    print("!! NOT checked: the module was built without cpp-httplib, and has no views")
    sys.exit(77)

if __name__ == "__main__":
    # Both end the program with status 77 where there is no browser to look with.
    from browser import Browser
    browser = Browser()
    try:
        unittest.main()
    finally:
        browser.stop()
