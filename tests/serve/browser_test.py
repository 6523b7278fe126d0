#!/usr/bin/env python3
"""The page of `whit serve` in Chromium: it draws, fits its window, and does what keys, pointer and controls
ask for; its download is that of the command it prints.
    browser_test.py WHIT [FOLDER]    with a folder, screenshots are kept there
Skips with status 77 where Chromium or python3-websocket is missing."""
import os
import subprocess
import sys
import tempfile
import urllib.request

from browser import Browser, Server

whit = os.path.abspath(sys.argv[1])
chess = os.path.join(os.environ.get("WHIT_SOURCE_DIR", os.getcwd()), "scenes", "chess.glb")
keep = sys.argv[2] if len(sys.argv) > 2 else None
wrong = []


def check(good, what):
    print(("ok      " if good else "WRONG   ") + what)
    if not good:
        wrong.append(what)


def open_page(browser, server, width=800, height=600):
    browser.size(width, height)
    browser.open(server.url)
    browser.wait("typeof whit === 'object' && whit.exact", 120)


def middle(browser, across=0.5, down=0.5):
    left, top, width, height = browser.run(
        "const r = stage.getBoundingClientRect(); return [r.left, r.top, r.width, r.height]")
    return left + across * width, top + down * height


# A number that tells pictures apart.
SUM = ("(() => { const d = picture.getContext('2d').getImageData(0, 0, picture.width, picture.height).data;"
       " let s = picture.width; for (let i = 0; i < d.length; i += 4) s = (31 * s + d[i] + 7 * d[i + 1]) % 1e9;"
       " return s; })()")


def changes(browser, act, what):
    """The picture at rest differs after the act."""
    before = browser.run(f"return {SUM}")
    act()
    try:
        browser.wait(f"whit.exact && {SUM} !== {before}", 60)
        check(True, what)
    except AssertionError:
        check(False, what)


def test_layout(browser, server):
    for width, height in ((360, 740), (800, 600), (1600, 900)):
        open_page(browser, server, width, height)
        browser.run("document.querySelectorAll('aside > details').forEach(part => { part.open = true; })")
        browser.click(*middle(browser))
        browser.wait("whit.settled.tree")
        wide = browser.run(
            "return [document.documentElement, document.querySelector('aside'), document.querySelector('header')]"
            ".map(e => e.scrollWidth - e.clientWidth)")
        check(max(wide) <= 0, f"at {width} pixels nothing is wider than its place: {wide}")
        area = browser.run("return stage.clientWidth * stage.clientHeight / innerWidth / innerHeight")
        check(area > 0.4, f"at {width} pixels the picture has {area:.0%} of the window")
        if keep:
            browser.screenshot(os.path.join(keep, f"serve-{width}.png"))


def test_motion(browser, server):
    open_page(browser, server)
    changes(browser, lambda: browser.drag(middle(browser), middle(browser, 0.7)), "a drag orbits")
    changes(browser, lambda: browser.drag(middle(browser), middle(browser, 0.5, 0.6), button="middle"),
            "a middle drag pans")
    changes(browser, lambda: browser.mouse("mouseWheel", *middle(browser), deltaX=0, deltaY=-240),
            "the wheel moves closer")
    changes(browser, lambda: browser.key("KeyW", "w", pause=0.4), "W walks")
    changes(browser, lambda: browser.key("KeyF", "f"), "F fits the model")
    changes(browser, lambda: browser.mouse("mouseWheel", *middle(browser), deltaX=0, deltaY=-240), "the wheel again")
    changes(browser, lambda: browser.key("Home", "Home"), "Home returns to the first camera")


def test_rays(browser, server):
    open_page(browser, server)
    browser.click(*middle(browser))
    browser.wait("document.querySelector('.sum')")
    # Contributions are sums of floats that doubles add in another order: a few ulps of the pixel.
    error = browser.run("return Number(document.querySelector('.sum').dataset.error)")
    check(error < 1e-5, f"the rays sum up to the pixel: {error}")
    check(browser.run("return whit.settled.tree.nodes.length") >= 2, "the sphere sends rays on")
    check(browser.run("return whit.live.lines.length") >= 2, "the rays are lines in the picture")
    browser.run("document.getElementById('forget').click()")
    browser.wait("!whit.settled.tree")


def test_controls(browser, server):
    open_page(browser, server)

    def choose(name, value):
        browser.run(f"const c = controls.get('{name}'); c.value = '{value}';"
                    "c.dispatchEvent(new Event('change'))")

    changes(browser, lambda: choose("depth", 0), "a knob changes the picture")
    check(browser.run("return whit.settled.options.depth") == "0", "and the page says so")
    changes(browser, lambda: browser.run("document.querySelector('#effects input:enabled:checked').click()"),
            "an effect can be left out")
    changes(browser, lambda: choose("view", "normals"), "another view is shown")
    changes(browser, lambda: browser.key("BracketRight", "]") or choose("view", "none"), "] exposes")
    stages = browser.run("return whit.live.stages.map(([name, ms]) => ms).reduce((a, b) => a + b)")
    check(stages > 0, "the stages take time")
    browser.run("say('set depth 1000')")
    browser.wait("document.getElementById('error').textContent.includes('depth')")
    check(True, "an option beyond its range is an error that names it")


def test_download(browser, server):
    open_page(browser, server)
    browser.drag(middle(browser), middle(browser, 0.3))
    browser.wait("!whit.exact")
    browser.wait("whit.exact", 120)
    command = browser.wait("whit.settled.command")
    folder = tempfile.mkdtemp()
    for end in ("png", "exr"):
        with urllib.request.urlopen(server.url + "picture." + end) as answer:
            downloaded = os.path.join(folder, "down." + end)
            open(downloaded, "wb").write(answer.read())
        words = command.replace(".png", "." + end).replace("whit render", f"'{whit}' render")
        subprocess.run(words + " --quiet", shell=True, check=True, cwd=folder)
        made = next(os.path.join(folder, f) for f in os.listdir(folder) if f.endswith(end) and "down" not in f)
        same = subprocess.run([whit, "compare", downloaded, made, "--json", "-"], capture_output=True, text=True)
        check('"rmse": 0.0' in same.stdout, f"the {end.upper()} is that of the command: {command}")
        if end == "png":
            shown = browser.run(
                "const image = await createImageBitmap(await (await fetch('picture.png')).blob(),"
                " {colorSpaceConversion: 'none'}), c = new OffscreenCanvas(image.width, image.height);"
                "const pen = c.getContext('2d', {alpha: false}); pen.drawImage(image, 0, 0);"
                "const a = pen.getImageData(0, 0, c.width, c.height).data;"
                "const b = picture.getContext('2d').getImageData(0, 0, picture.width, picture.height).data;"
                "return a.length === b.length && a.every((v, i) => v === b[i]);")
            check(shown, "the page at rest shows every pixel of the PNG")


def test_nothing_else(browser, server):
    open_page(browser, server)
    loaded = browser.run("return performance.getEntriesByType('resource').map(entry => entry.name)")
    check(all(name.startswith(server.url) for name in loaded), "the page loads nothing from elsewhere")
    said = [event for event in browser.events if event["method"] == "Runtime.exceptionThrown" or
            event["method"] == "Log.entryAdded" and event["params"]["entry"]["level"] == "error"]
    check(not said, f"the browser reports no error: {said}")


browser = Browser()
server = Server(whit, chess, "--quiet")
spheres = Server(whit, "whitted", "--quiet")
try:
    for test in (test_layout, test_motion, test_controls, test_download):
        test(browser, server)
    test_rays(browser, spheres)
    browser.events = [event for event in browser.events if "status of 400" not in str(event)]
    test_nothing_else(browser, server)
finally:
    browser.stop()
    server.stop()
    spheres.stop()
sys.exit(1 if wrong else 0)
