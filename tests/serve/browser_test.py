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
CTRL = 2  # the DevTools protocol's modifier
keep = sys.argv[2] if len(sys.argv) > 2 else None
wrong = []
browser = Browser()


def check(good, what):
    print(("ok      " if good else "WRONG   ") + what)
    if not good:
        wrong.append(what)


def open_page(server, width=800, height=600):
    browser.size(width, height)
    browser.open(server.url)
    browser.wait("typeof whit === 'object' && whit.exact", 120)


def middle(across=0.5, down=0.5):
    left, top, width, height = browser.run(
        "const r = stage.getBoundingClientRect(); return [r.left, r.top, r.width, r.height]")
    return left + across * width, top + down * height


# A number that tells pictures apart.
SUM = ("(() => { const d = picture.getContext('2d').getImageData(0, 0, picture.width, picture.height).data;"
       " let s = picture.width; for (let i = 0; i < d.length; i += 4) s = (31 * s + d[i] + 7 * d[i + 1]) % 1e9;"
       " return s; })()")


def becomes(condition, what):
    """The condition in the page's script comes true."""
    try:
        browser.wait(condition)
        check(True, what)
    except AssertionError:
        check(False, what)


def changes(what, act, *arguments, **more):
    """The picture at rest differs after the act."""
    before = browser.run(f"return {SUM}")
    act(*arguments, **more)
    becomes(f"whit.exact && {SUM} !== {before}", what)


def open_parts():
    browser.run("document.querySelectorAll('aside > details').forEach(part => { part.open = true; })")


def test_layout(server):
    for width, height in ((360, 740), (800, 600), (1600, 900)):
        open_page(server, width, height)
        open_parts()
        browser.click(*middle())
        browser.wait("whit.settled.tree")
        wide = browser.run(
            "return [document.documentElement, document.querySelector('aside'), document.querySelector('header')]"
            ".map(e => e.scrollWidth - e.clientWidth)")
        check(max(wide) <= 0, f"at {width} pixels nothing is wider than its place: {wide}")
        area = browser.run("return stage.clientWidth * stage.clientHeight / innerWidth / innerHeight")
        check(area > 0.4, f"at {width} pixels the picture has {area:.0%} of the window")
        if keep:
            browser.screenshot(os.path.join(keep, f"serve-{width}.png"))


def test_motion(server):
    open_page(server)
    changes("a drag orbits", browser.drag, middle(), middle(0.7))
    changes("a middle drag pans", browser.drag, middle(), middle(0.5, 0.6), button="middle")
    closer = ("mouseWheel", *middle())
    changes("the wheel moves closer", browser.mouse, *closer, deltaX=0, deltaY=-240)
    changes("W walks", browser.key, "KeyW", "w", pause=0.4)
    changes("F fits the model", browser.key, "KeyF", "f")
    changes("the wheel again", browser.mouse, *closer, deltaX=0, deltaY=-240)
    changes("Home returns to the first camera", browser.key, "Home", "Home")


def test_rays(server):
    open_page(server)
    browser.click(*middle())
    browser.wait("document.querySelector('.sum')")
    # Contributions are sums of floats that doubles add in another order: a few ulps of the pixel.
    error = browser.run("return Number(document.querySelector('.sum').dataset.error)")
    check(error < 1e-5, f"the rays sum up to the pixel: {error}")
    check(browser.run("return whit.settled.tree.nodes.length") >= 2, "the sphere sends rays on")
    check(browser.run("return whit.live.lines.length") >= 2, "the rays are lines in the picture")
    browser.run("document.getElementById('forget').click()")
    browser.wait("!whit.settled.tree")


def test_controls(server):
    open_page(server)

    def choose(name, value):
        browser.run(f"const c = controls.get('{name}'); c.value = '{value}';"
                    "c.dispatchEvent(new Event('change'))")

    changes("a knob changes the picture", choose, "depth", 0)
    check(browser.run("return whit.settled.options.depth") == "0", "and the page says so")
    changes("an effect can be left out", browser.run,
            "document.querySelector('#effects input:enabled:checked').click()")
    changes("another view is shown", choose, "view", "normals")
    changes("] exposes", lambda: browser.key("BracketRight", "]") or choose("view", "none"))
    browser.key("KeyV", "v")
    becomes("document.getElementById('status').textContent.startsWith('depth: ')", "V says which view is shown")
    choose("view", "none")
    browser.wait("whit.settled.view === 'none'")

    pressed = "[...document.querySelectorAll('#presets [aria-pressed=true]')].map(b => b.textContent).join()"
    check(browser.run(f"return {pressed}") == "", "no preset is on after a knob was turned")
    browser.run("[...document.querySelectorAll('#presets button')].find(b => b.textContent === 'standard').click()")
    becomes(f"{pressed} === 'standard'", "the preset that was chosen is on")

    stages = browser.run("return whit.live.stages.map(([name, ms]) => ms).reduce((a, b) => a + b)")
    check(stages > 0, "the stages take time")
    bars = browser.run("return [...document.querySelectorAll('.stage')].map(bar => bar.clientWidth)")
    check(len(bars) == 8 and min(bars) > 250, f"the stages' bars have the width of the panel: {bars}")

    # The box has the focus, as that of somebody who has just typed.
    open_parts()
    browser.run("controls.get('depth').focus()")
    choose("depth", 1000)
    becomes("document.getElementById('error').textContent.includes('depth')",
            "an option beyond its range is an error that names it")
    browser.wait("controls.get('depth').value === whit.settled.options.depth")
    check(browser.run("return controls.get('depth').value") != "1000", "and springs back")

    browser.run("controls.get('fresnel').focus()")
    choose("fresnel", "schlick")
    browser.wait("whit.settled.options.fresnel === 'schlick'")
    browser.key("KeyZ", "z", modifiers=CTRL)
    browser.wait("whit.settled.options.fresnel !== 'schlick'")
    check(browser.run("return controls.get('fresnel').value") != "schlick", "a list shows what undoing returns to")


def test_keys_after_controls(server):
    """Walking keys act after a list, a box and a number were used."""
    open_page(server)
    open_parts()
    for used in ("controls.get('fresnel')", "document.querySelector('#effects input:enabled')",
                 "controls.get('depth')", "document.getElementById('cameras')"):
        browser.run(f"{used}.focus()")
        value = browser.run(f"return {used}.value")
        changes(f"W walks where {used} has the focus", browser.key, "KeyW", "w", pause=0.3)
        check(browser.run(f"return {used}.value") == value, "and does not choose anything")
    browser.run("controls.get('depth').focus()")
    browser.key("Enter", "Enter")
    check(browser.run("return document.activeElement === document.body"), "Enter gives all keys to the picture")


def test_layouts(server):
    """On a German keyboard Z and Y change places, and Ü has the place of [."""
    open_page(server)
    exposure = browser.run("return whit.settled.options.exposure")
    changed = f"whit.settled.options.exposure !== '{exposure}'"
    browser.key("BracketLeft", "ü")
    browser.wait(changed)
    browser.key("KeyZ", "y", modifiers=CTRL)
    browser.key("KeyV", "v")  # is told after the other key
    browser.wait("whit.settled.view === 'depth'")
    check(browser.run(f"return {changed}"), "Ctrl+Y is not taken for Ctrl+Z")
    browser.key("KeyY", "z", modifiers=CTRL)
    becomes(f"!({changed})", "Ctrl+Z undoes")
    browser.run("say('view none')")
    browser.wait("whit.settled.view === 'none'")


def test_escape(server):
    """Esc closes the rays of a pixel, then the panel, and opens nothing."""
    open_page(server)
    is_bare = "document.body.classList.contains('bare')"
    browser.click(*middle())
    browser.wait("whit.settled.tree")
    browser.key("Escape", "Escape")
    browser.wait("!whit.settled.tree")
    check(not browser.run(f"return {is_bare}"), "Esc closes the rays and keeps the panel")
    for what in ("closes the panel", "keeps it closed"):
        browser.key("Escape", "Escape")
        check(browser.run(f"return {is_bare}"), f"Esc {what}")
    browser.key("KeyH", "h")
    check(browser.run("return document.getElementById('keys').offsetHeight > 0"), "H opens it with the keys")


def test_camera_list(server):
    open_page(server)
    chosen = "document.getElementById('cameras').selectedOptions[0].textContent"
    browser.key("Digit2", "2")
    browser.wait(f"{chosen} === 'through'")
    browser.key("KeyW", "w", pause=0.3)
    browser.wait(f"{chosen} === 'free view'")
    browser.key("Digit1", "1")
    becomes(f"{chosen} === 'main'", "the list of cameras says which one is shown, and that none is")


def test_focus_of_effects(server):
    """The box that Space has switched keeps the focus, so that Tab goes on from there."""
    open_page(server)
    open_parts()
    browser.run("document.querySelector('#effects input:enabled:checked').focus()")
    name = browser.run("return document.activeElement.name")
    browser.key("Space", " ", text=" ")
    browser.wait(f"whit.settled.effects.some(([name, called, on]) => name === '{name}' && !on) && whit.exact")
    check(browser.run("return document.activeElement.name") == name, "a box keeps the focus after Space")
    browser.run("say('undo')")


def test_unsteady_click(server):
    """A click is one although the hand trembles."""
    open_page(server)
    browser.run("say('forget')")
    browser.wait("!whit.settled.tree")
    x, y = middle()
    browser.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
    for i in range(8):
        browser.mouse("mouseMoved", x + i % 2, y, button="left", buttons=1)
    browser.mouse("mouseReleased", x, y, button="left", buttons=0, clickCount=1)
    becomes("whit.settled.tree", "a click with a trembling hand shows the rays")


def test_lost_release(server):
    """A drag ends where the pointer comes back without a button."""
    open_page(server)
    x, y = middle()
    browser.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
    browser.mouse("mouseMoved", x + 20, y, button="left", buttons=1)
    browser.mouse("mouseMoved", x + 60, y)
    check(browser.run("return fingers.size") == 0, "a drag ends without its pointerup")
    browser.mouse("mouseReleased", x, y, button="left", buttons=0, clickCount=1)


def test_no_scene():
    """While scenes are to be chosen from, keys go to their list and not to what it covers."""
    server = Server(whit, "--quiet")
    try:
        browser.open(server.url)
        browser.wait("typeof whit === 'object' && tables && tables.scenes")
        browser.key("KeyV", "v")
        browser.key("Escape", "Escape")
        browser.call("Input.dispatchKeyEvent", type="keyDown", code="Tab", key="Tab", windowsVirtualKeyCode=9)
        check(browser.wait("document.activeElement.closest('#scenes')"), "Tab goes to the list of scenes")
        browser.run("say('scene whitted')")
        browser.wait("tables.scene === 'whitted' && whit.exact", 120)
        check(browser.run("return whit.settled.view") == "none", "a key has not changed what is not shown yet")
        check(browser.run("return getComputedStyle(document.querySelector('aside')).display") != "none",
              "nor has Esc closed the panel")
    finally:
        browser.open("about:blank")  # the page would call the end of its stream an error
        server.stop()


def test_two_shapes(server):
    """A page whose shape differs from that of the picture shows it undistorted, and clicks hit its pixels."""
    open_page(server)
    browser.run("say('forget')")
    browser.wait("!whit.settled.tree")
    browser.run("await fetch('input', {method: 'POST', body: 'size 200 400 1'})")
    browser.wait("whit.live.window + '' === '200,400' && whit.exact")
    box = "const b = picture.getBoundingClientRect(), s = stage.getBoundingClientRect();"
    shape = browser.run(box + "return b.width / b.height")
    # Sizes on the screen are in whole pixels or fractions of them.
    check(abs(shape - 0.5) < 0.005, f"an upright picture stays upright: {shape}")
    check(browser.run(box + "return Math.abs(b.left + b.width / 2 - s.left - s.width / 2) < 1"), "in the middle")
    left, top, width, height = browser.run(box + "return [b.left, b.top, b.width, b.height]")
    browser.click(left + 0.75 * width, top + 0.25 * height)
    browser.wait("whit.settled.tree")
    at = browser.run("return whit.settled.tree.pixel")
    check(abs(at[0] - 150) <= 2 and abs(at[1] - 100) <= 2, f"a click is at its pixel: {at}")
    browser.drag(middle(), middle(0.55))
    becomes("shape().fills && whit.exact", "who steers gets the shape of the page")


def test_density(server):
    """A window that is moved to a denser screen gets as many pixels as that has."""
    open_page(server)
    across = browser.run("return whit.live.window[0]")
    browser.size(800, 600, 2)
    browser.call("Page.captureScreenshot")  # the page is told with the next frame that it draws
    becomes(f"whit.live.window[0] === {2 * across}", "the picture follows the density of the screen")


def test_telephone(server):
    """By touch, whatever is pressed is as large as a finger."""
    browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
    open_page(server, 360, 740)
    open_parts()
    small = browser.run(
        "return [...document.querySelectorAll('button, select, a.button, summary, input')].filter(e => e.offsetParent)"
        ".map(e => [e.closest('label') || e, e]).map(([e, own]) => [e.getBoundingClientRect().height, own.id || own.name ||"
        " own.textContent]).filter(([height]) => height < 44)")
    check(matches("(pointer: coarse)") and not small, f"all targets have 44 pixels: {small}")
    browser.call("Emulation.setTouchEmulationEnabled", enabled=False)
    role = browser.run("return [picture.getAttribute('role'), picture.getAttribute('aria-label')].join()")
    check(role == "img,picture of chess", f"the picture has a role and a name: {role}")


def matches(query):
    return browser.run(f"return matchMedia('{query}').matches")


def test_lost_server():
    """A server that ends, and another one in its place, are told apart."""
    first = Server(whit, "whitted", "--quiet")
    port = first.url.split(":")[2].split("/")[0]
    open_page(first, 360, 300)
    first.stop()
    becomes("document.getElementById('error').textContent.includes('start it again')",
            "a server that has ended is told")
    second = Server(whit, "whitted", "--quiet", "--port", port)
    try:
        becomes("document.getElementById('error').textContent.includes('printed last')",
                "a server that started again has another address")
    finally:
        second.stop()


def test_download(server):
    open_page(server)
    browser.drag(middle(), middle(0.3))
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


def test_nothing_else(server):
    open_page(server)
    loaded = browser.run("return performance.getEntriesByType('resource').map(entry => entry.name)")
    check(all(name.startswith(server.url) for name in loaded), "the page loads nothing from elsewhere")
    said = [event for event in browser.events if event["method"] == "Runtime.exceptionThrown" or
            event["method"] == "Log.entryAdded" and event["params"]["entry"]["level"] == "error"]
    check(not said, f"the browser reports no error: {said}")


server = Server(whit, chess, "--quiet")
spheres = Server(whit, "whitted", "--quiet")
try:
    for test in (test_layout, test_motion, test_controls, test_keys_after_controls, test_two_shapes, test_density,
                 test_telephone, test_download):
        test(server)
    for test in (test_rays, test_layouts, test_escape, test_camera_list, test_focus_of_effects, test_unsteady_click,
                 test_lost_release):
        test(spheres)
    test_no_scene()
    browser.events = [event for event in browser.events if "status of 400" not in str(event)]
    test_nothing_else(server)
    test_lost_server()
finally:
    browser.stop()
    server.stop()
    spheres.stop()
sys.exit(1 if wrong else 0)
