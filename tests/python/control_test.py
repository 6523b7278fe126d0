"""Progress, Control-C, the GIL, and errors: what stays usable after them."""

import os
import signal
import threading
import time
import unittest
from pathlib import Path


import whit
from samples import (LONG, SIZE, another_thread_rendering, assert_same, error_of, pixels, python,
                     scene_of, temporary_folder)


class Control(unittest.TestCase):
    def setUp(self):
        self.scene = whit.Scene("whitted")
        self.expected = pixels(self.scene).copy()

    def tearDown(self):
        assert_same(self.scene, self.expected)

    def test_progress_is_told_and_ends_the_work(self):
        told = []

        def progress(phase, fraction):
            told.append((phase, fraction, threading.get_ident()))
            return len(told) < 3

        self.assertEqual(error_of(self.scene.render, progress=progress, **LONG).exit_status, 130)
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
        error = error_of(self.scene.render, progress=lambda *_: self.scene.render(size=SIZE), **LONG)
        self.assertEqual(error.exit_status, 2)

    def test_control_c(self):
        timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            while True:
                self.scene.render(**LONG)
        timer.join()

    def test_control_c_while_waiting_for_another_thread(self):
        with another_thread_rendering(self.scene):
            self.test_control_c()

    def test_others_run_meanwhile(self):
        counted = 0
        thread = threading.Thread(target=self.scene.render, kwargs=dict(size=(320, 200), spp=16))
        thread.start()
        while thread.is_alive():
            counted += 1
            time.sleep(0.001)
        self.assertGreater(counted, 5)

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
            Path("bad.json").write_text('{"whit": 1,\n "size": }')
            Path("worse.json").write_text('{"whit": 1, "size": ["wide", 3]}')
            for name, *expected in (("bad.json", 3, "bad.json", "2:10"),
                                    ("worse.json", 3, "worse.json", "/size/0"),
                                    ("no-such-scene", 2, None, None),
                                    ("none.json", 4, "none.json", None)):
                error = error_of(whit.Scene, name)
                self.assertEqual([error.exit_status, error.file, error.place], expected, str(error))

    def test_a_scene_that_did_not_come_to_be(self):
        with self.assertRaises(AttributeError):
            whit.Scene.__new__(whit.Scene).render()


class Ends(unittest.TestCase):
    def test_python_ends_while_threads_render(self):
        program = ("import threading, time, whit\n"
                   "def work():\n"
                   "    scene = whit.Scene('whitted')\n"
                   "    while True: scene.render(size=(64, 40), threads=1)\n"
                   "for _ in range(8): threading.Thread(target=work, daemon=True).start()\n"
                   "time.sleep(0.3)\n")
        for _ in range(5):
            done = python(program, timeout=60)
            self.assertEqual((done.returncode, done.stderr), (0, ""))


class Growth(unittest.TestCase):
    def test_many_renders_take_no_more_memory(self):
        """$WHIT_RENDERS of them; a tenth of them first, until all that is kept is there."""
        renders = int(os.environ.get("WHIT_RENDERS", 400))

        def resident():
            return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE")

        scene = scene_of()

        def render(count):
            for i in range(count):
                scene.set("/lights/0/intensity", 20 + i % 40)
                picture = scene.render(size=(160, 100), eye=(0.01 * (i % 100), 3, 2))
                self.assertEqual(picture.rgb.shape, (100, 160, 3))
                if i % 10 == 0:
                    error_of(scene.render, size=(160, 100), camera="nobody")
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
