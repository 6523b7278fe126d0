"""Progress, Control-C, the GIL, and errors: what stays usable after them."""

import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy as np

import whit
from samples import SIZE, pixels, scene_of, temporary_folder

LONG = dict(size=(640, 400), spp=64)  # seconds, if nothing ends it


class Control(unittest.TestCase):
    def setUp(self):
        self.scene = whit.Scene("whitted")
        self.expected = pixels(self.scene).copy()

    def tearDown(self):
        np.testing.assert_array_equal(pixels(self.scene), self.expected)

    def test_progress_is_told_and_ends_the_work(self):
        told = []

        def progress(phase, fraction):
            told.append((phase, fraction, threading.get_ident()))
            return len(told) < 3

        with self.assertRaises(whit.Error) as caught:
            self.scene.render(progress=progress, **LONG)
        self.assertEqual(caught.exception.exit_status, 130)
        self.assertEqual(len(told), 3)
        for phase, fraction, thread in told:
            self.assertIn("tracing", phase)
            self.assertTrue(0 <= fraction <= 1)
            self.assertEqual(thread, threading.get_ident())

    def test_what_a_progress_function_raises(self):
        def progress(phase, fraction):
            raise LookupError("mine")

        with self.assertRaisesRegex(LookupError, "mine"):
            self.scene.render(progress=progress, **LONG)

    def test_a_progress_function_cannot_use_the_scene(self):
        def progress(phase, fraction):
            self.scene.render(size=SIZE)

        with self.assertRaises(whit.Error) as caught:
            self.scene.render(progress=progress, **LONG)
        self.assertEqual(caught.exception.exit_status, 2)

    def test_control_c(self):
        timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            while True:
                self.scene.render(**LONG)
        timer.join()

    def test_control_c_while_waiting_for_another_thread(self):
        begun, stop = threading.Event(), threading.Event()

        def progress(phase, fraction):
            begun.set()
            return not stop.is_set()

        def render():
            with self.assertRaises(whit.Error):
                while True:
                    self.scene.render(progress=progress, **LONG)

        thread = threading.Thread(target=render)
        thread.start()
        begun.wait()
        timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            while True:
                self.scene.render(**LONG)
        stop.set()
        thread.join()

    def test_others_run_meanwhile(self):
        counted = 0
        done = threading.Event()

        def render():
            self.scene.render(size=(320, 200), spp=16)
            done.set()

        thread = threading.Thread(target=render)
        thread.start()
        while not done.is_set():
            counted += 1
            time.sleep(0.001)
        thread.join()
        self.assertGreater(counted, 5)

    def test_errors_of_options(self):
        for options, words in (({"camera": "nobody"}, "nobody"), ({"spp": 0}, "spp"),
                               ({"size": "wide"}, "size"), ({"size": (0, 5)}, "size"),
                               ({"tonemap": "flmic"}, "filmic"), ({"fov": float("nan")}, "fov"),
                               ({"eye": (1, 2)}, "eye"), ({"crop": (0, 0, 1000, 9)}, "crop"),
                               ({"sphere_segments": 16}, "sphere_segments"),
                               ({"simd": "sse9"}, "simd"), ({"depth": 2**70}, "depth")):
            with self.subTest(**options), self.assertRaises(whit.Error) as caught:
                self.scene.render(**options)
            self.assertEqual(caught.exception.exit_status, 2)
            self.assertIn(words, str(caught.exception))
        with self.assertRaisesRegex(TypeError, "did you mean 'size'"):
            self.scene.render(sise=SIZE)
        with self.assertRaisesRegex(TypeError, "depth: expected N"):
            self.scene.render(depth=object())

    def test_arguments_of_the_wrong_kind(self):
        for arguments in ({"threads": 2**70}, {"sky": 4}, {"movable": 4}, {"max_memory_gb": "much"},
                          {"sphere_segments": 1.5}):
            with self.subTest(**arguments), self.assertRaises(TypeError):
                whit.Scene("whitted", **arguments)
        whit.Scene("whitted", threads=10**9)
        for source in (None, 4, object()):
            with self.subTest(source=source), self.assertRaises(TypeError):
                whit.Scene(source)

    def test_errors_of_scenes(self):
        with temporary_folder():
            with open("bad.json", "w", encoding="utf-8") as file:
                file.write('{"whit": 1,\n "size": }')
            with open("worse.json", "w", encoding="utf-8") as file:
                file.write('{"whit": 1, "size": ["wide", 3]}')
            cases = [("bad.json", 3, "bad.json", "2:10"), ("worse.json", 3, "worse.json", "/size/0"),
                     ("no-such-scene", 2, None, None), ("none.json", 4, "none.json", None)]
            for name, status, file, place in cases:
                with self.subTest(name=name), self.assertRaises(whit.Error) as caught:
                    whit.Scene(name)
                error = caught.exception
                self.assertEqual((error.exit_status, error.file, error.place),
                                 (status, file, place), str(error))

    def test_errors_of_members(self):
        for pointer, value, status in (("lights", 4, 2), ("/lights/0/intensity", "much", 3),
                                       ("/lights/9/intensity", 4, 3), ("/nonsense", 4, 3),
                                       ("/lights/0/intensity", float("inf"), 3),
                                       ("/scene/1/radius", -1, 3)):
            with self.subTest(pointer=pointer), self.assertRaises(whit.Error) as caught:
                self.scene.set(pointer, value)
            self.assertEqual(caught.exception.exit_status, status)
        with self.assertRaises(whit.Error):
            self.scene.set_time(1)

    def test_errors_of_files(self):
        picture = self.scene.render(size=SIZE)
        for path, status in (("no/such/folder/a.png", 4), ("a.gif", 2)):
            with self.assertRaises(whit.Error) as caught:
                picture.write(path)
            self.assertEqual(caught.exception.exit_status, status)

    def test_a_scene_that_did_not_come_to_be(self):
        scene = whit.Scene.__new__(whit.Scene)
        with self.assertRaises(AttributeError):
            scene.render()

    def test_loading_is_ended(self):
        with self.assertRaises(whit.Error) as caught:
            whit.Scene("landscape?triangles=400000", progress=lambda phase, fraction: False)
        self.assertEqual(caught.exception.exit_status, 130)


class Ends(unittest.TestCase):
    def test_python_ends_while_threads_render(self):
        program = ("import threading, time, whit\n"
                   "def work():\n"
                   "    scene = whit.Scene('whitted')\n"
                   "    while True: scene.render(size=(64, 40), threads=1)\n"
                   "for _ in range(8): threading.Thread(target=work, daemon=True).start()\n"
                   "time.sleep(0.3)\n")
        for _ in range(5):
            done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True,
                                  check=False, timeout=60)
            self.assertEqual((done.returncode, done.stderr), (0, ""))


class Growth(unittest.TestCase):
    def test_many_renders_take_no_more_memory(self):
        """$WHIT_RENDERS of them; a tenth of them first, until all that is kept is there."""
        renders = int(os.environ.get("WHIT_RENDERS", 400))

        def resident():
            with open("/proc/self/statm", encoding="ascii") as file:
                return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")

        scene = scene_of()

        def render(count):
            for i in range(count):
                scene.set("/lights/0/intensity", 20 + i % 40)
                picture = scene.render(size=(160, 100), eye=(0.01 * (i % 100), 3, 2))
                self.assertEqual(picture.rgb.shape, (100, 160, 3))
                if i % 10 == 0:
                    with self.assertRaises(whit.Error):
                        scene.render(size=(160, 100), camera="nobody")
                if i % 50 == 0:
                    scene_of().render(size=SIZE)

        render(renders // 10)
        before = resident()
        render(renders)
        grown = resident() - before
        print(f"{renders} renders: {before} bytes before, {grown:+} after")
        self.assertLess(grown, 16e6)


if __name__ == "__main__":
    unittest.main()
