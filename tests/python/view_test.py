"""Scene.view(): the server in this process, its life and its picture."""

import gc
import os
import re
import struct
import sys
import time
import unittest
import urllib.error
import urllib.request

import numpy as np

import whit
from samples import error_of, python, scene_of, square_scene

SIZE = (64, 40)


def status(url, **headers):
    """The status of an answer; 0 where nobody listens."""
    try:
        return urllib.request.urlopen(urllib.request.Request(url, headers=headers), timeout=60).status
    except urllib.error.HTTPError as error:
        return error.code
    except urllib.error.URLError:
        return 0


def say(view, line):
    request = urllib.request.Request(view.url + "input", line.encode(), method="POST")
    return urllib.request.urlopen(request, timeout=60).status


def chunks(png):
    """The texts of a PNG, and its compressed pixels."""
    texts, pixels, at = {}, b"", 8
    while at < len(png):
        size, kind = struct.unpack(">I4s", png[at:at + 8])
        data = png[at + 8:at + 8 + size]
        if kind == b"tEXt":
            texts.update([data.decode().split("\0", 1)])
        elif kind == b"IDAT":
            pixels += data
        at += 12 + size
    return texts, pixels


class Views(unittest.TestCase):
    def same_picture(self, view, scene):
        """The view's picture at rest is that of render(), bit for bit; samples are added at rest."""
        texts, pixels = chunks(view.png())
        expected = scene.render(size=SIZE, spp=int(texts["spp"])).png()
        self.assertEqual(pixels, chunks(expected)[1])

    def test_answers_with_its_token(self):
        view = scene_of().view(size=SIZE)
        self.assertRegex(view.url, r"^http://127\.0\.0\.1:\d+/[0-9a-f]{32}/$")
        root = view.url[:-33]
        for expected, url, headers in (
                (200, view.url, {}), (403, root, {}), (403, root + "0" * 32 + "/", {}),
                (421, view.url, {"Host": "evil.example"}),
                (403, view.url, {"Origin": "http://localhost:8888"})):
            self.assertEqual(status(url, **headers), expected, headers)
        self.assertIn(f'src="{view.url}"', view._repr_html_())

    def test_close_ends_it(self):
        view = scene_of().view(size=SIZE)
        view.close()
        view.close()
        self.assertEqual(status(view.url), 0)
        self.assertIsNone(view._repr_html_())
        self.assertIsNone(view._repr_png_())
        self.assertIn("closed", str(error_of(view.png)))

    def test_ends_with_the_object(self):
        other = whit.Scene("whitted").view(size=SIZE)
        self.assertEqual(status(other.url), 200)
        threads = len(os.listdir("/proc/self/task"))
        view = whit.Scene("whitted").view(size=SIZE)
        url = view.url
        self.assertEqual(status(url), 200)
        self.assertGreater(len(os.listdir("/proc/self/task")), threads)
        del view
        gc.collect()
        self.assertEqual([status(url), status(other.url)], [0, 200])
        self.assertLessEqual(len(os.listdir("/proc/self/task")), threads)

    def test_ends_with_the_process(self):
        script = "import whit; view = whit.Scene('whitted').view(); print(view.url)"
        done = python(script, timeout=60)
        self.assertEqual((done.returncode, status(done.stdout.strip()), done.stderr), (0, 0, ""))

    def test_a_fork_leaves_it_alone(self):
        view = whit.Scene("whitted").view(size=SIZE)
        child = os.fork()
        if child == 0:
            del view
            gc.collect()
            os._exit(0)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        self.assertEqual(status(view.url), 200)

    def test_shows_scenes_as_they_are(self):
        scene = whit.Scene(square_scene(), movable=["/scene/0"])
        before = scene.view(size=SIZE)
        scene.set("/lights/0/intensity", 5)
        matrix = np.eye(4)
        matrix[1, 3] = 0.5
        scene.set_transform("/scene/0", matrix)
        self.same_picture(scene.view(size=SIZE), scene)
        self.same_picture(before, scene_of())
        orrery = whit.Scene("orrery", moves=True)
        orrery.set_time(3.25)
        self.same_picture(orrery.view(size=SIZE), orrery)
        for start in whit.Scene("orrery"), whit.Scene("orrery", moves=True):
            self.same_picture(start.view(size=SIZE), start)  # stands still until it is told to play

    def test_made_scenes_are_not_read_again(self):
        view = scene_of().view(size=SIZE)
        say(view, "reload")
        with urllib.request.urlopen(view.url + "stream", timeout=60) as stream:
            wanted = {b"cannot be read again", b"no command renders it"}
            end = time.monotonic() + 60
            while wanted and time.monotonic() < end:
                size, = struct.unpack("<I", stream.read(4))
                message = stream.read(size)
                wanted -= {words for words in wanted if words in message}
                drawn = re.search(rb'"page":(\d+).*"frame":(\d+)', message)
                if drawn:
                    say(view, f"ack {int(drawn[1])} {int(drawn[2])}")
        self.assertEqual(wanted, set())

    def test_refuses_what_it_cannot_show(self):
        scene = scene_of()
        for options, error, words in (
                ({"crop": (0, 0, 8, 8)}, whit.Error, "crop"),
                ({"mode": "reference"}, whit.Error, "reference"),
                ({"camera": "behind"}, whit.Error, "behind"),
                ({"camera": scene.camera()}, TypeError, "camera"),
                ({"dept": 3}, TypeError, r"view\(\).*depth")):
            with self.assertRaisesRegex(error, words):
                scene.view(**options)
        view = scene.view()
        error = error_of(scene.view, port=int(view.url.split(":")[2].split("/")[0]))
        self.assertIn("taken", str(error))
        self.assertEqual(error.exit_status, 4)


if not hasattr(whit._whit, "View"):
    print("!! NOT checked: the module was built without cpp-httplib, and has no views")
    sys.exit(77)

if __name__ == "__main__":
    unittest.main()
