"""Scenes in child processes, which os.fork and multiprocessing make, from several threads."""

import os
import signal
import sys
import threading
import traceback
import unittest
from pathlib import Path

import numpy as np
from numpy.testing import assert_array_equal

import whit
from samples import (SECONDS, SIZE, another_thread_rendering, assert_same, expect_in_processes,
                     in_threads, pixels, python, scene_of, temporary_folder)


def status_of_child(body):
    """Calls body() in a forked child. Returns its exit status: 0, 1 after an exception, or the
    negative number of the signal that ended it."""
    child = os.fork()
    if child == 0:
        signal.alarm(SECONDS)
        try:
            body()
        except BaseException:
            traceback.print_exc()
            sys.stderr.flush()
            os._exit(1)
        os._exit(0)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


class Fork(unittest.TestCase):
    def setUp(self):
        self.scene = whit.Scene("orrery", moves=True)
        self.expected = pixels(self.scene).copy()

    def in_child(self, body):
        self.assertEqual(status_of_child(body), 0)

    def render(self):
        assert_same(self.scene, self.expected)

    def test_a_child_renders(self):
        self.in_child(self.render)
        self.render()

    def test_a_child_of_a_child_renders(self):
        self.in_child(lambda: self.in_child(self.render))

    def test_a_child_builds(self):
        self.scene.set_time(2)
        later = pixels(self.scene).copy()
        self.scene.set_time(0)

        def build():
            self.scene.set_time(2)
            assert_same(self.scene, later)
            assert_same(whit.Scene("orrery", moves=True), self.expected)
            pixels(scene_of())
            del self.scene

        self.in_child(build)

    def test_a_child_asks_for_hits(self):
        origins = np.random.default_rng(1).normal(size=(1000, 3)) * 5
        expected = self.scene.closest(origins, -origins).t

        def ask():
            for scene in (self.scene, whit.Scene("orrery", moves=True)):
                assert_array_equal(scene.closest(origins, -origins).t, expected)

        self.assertTrue(np.isfinite(expected).any())
        self.in_child(ask)

    def test_a_fork_in_another_thread(self):
        self.assertEqual(in_threads(status_of_child, [self.render]), [0])

    def test_a_scene_rendered_in_another_thread(self):
        [scene] = in_threads(whit.Scene, ["whitted"])
        [expected] = in_threads(pixels, [scene])
        self.in_child(lambda: assert_same(scene, expected))

    def test_pictures_are_written(self):
        with temporary_folder():
            picture = self.scene.render(size=SIZE)

            def write(name):
                picture.write(f"{name}.exr")
                picture.write(f"{name}.png")

            write("a")
            self.in_child(lambda: write("b"))
            for kind in ("exr", "png"):
                self.assertEqual(Path(f"a.{kind}").read_bytes(), Path(f"b.{kind}").read_bytes())

    def test_other_threads_that_render(self):
        """The child has its own scene; the other thread's gives an error."""
        theirs = whit.Scene("whitted")

        def in_child():
            self.render()
            with self.assertRaisesRegex(whit.Error, "another thread used the scene"):
                theirs.render(size=SIZE)

        with another_thread_rendering(theirs):
            self.in_child(in_child)

    def test_a_fork_while_another_thread_builds(self):
        """Embree's locks may be held for ever in the child: an error says so."""
        begun, stop = threading.Event(), threading.Event()

        def progress(phase, fraction):
            if phase.startswith("building"):
                begun.set()
                stop.wait(SECONDS)
            return True

        # Reports are some time apart: now and then a build ends without one.
        for _ in range(5):
            theirs = whit.Scene("landscape?triangles=2000000")
            thread = threading.Thread(target=lambda: theirs.render(size=SIZE, progress=progress))
            thread.start()
            while thread.is_alive() and not begun.wait(0.01):
                pass
            if begun.is_set():
                break

        def in_child():
            self.render()
            with self.assertRaisesRegex(whit.Error, "forked while another thread built"):
                scene_of().render(size=SIZE)

        try:
            self.assertTrue(begun.is_set())
            self.in_child(in_child)
        finally:
            stop.set()
            thread.join()

    def test_a_child_ends(self):
        """While a thread of the parent renders, the child exits at once, with its scenes."""
        program = ("import os, signal, sys, threading, time, whit\n"
                   "scene, other = whit.Scene('whitted'), whit.Scene('whitted')\n"
                   "scene.render(size=(64, 40))\n"
                   "def work():\n"
                   "    while True: other.render(size=(64, 40), spp=256)\n"
                   "threading.Thread(target=work, daemon=True).start()\n"
                   "time.sleep(0.2)\n"
                   "if os.fork() == 0:\n"
                   "    signal.alarm(8)\n"
                   "    scene.render(size=(64, 40))\n"
                   "    sys.exit(0)\n"
                   "sys.exit(os.waitstatus_to_exitcode(os.wait()[1]))\n")
        # From version 3.12 on, Python warns of every fork of a process with threads.
        done = python(program, "-W", "ignore::DeprecationWarning", timeout=SECONDS)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_a_fork_by_a_progress_function(self):
        children = []

        def progress(phase, fraction):
            if phase.startswith("tracing") and not children:
                children.append(os.fork())
                if children[0] == 0:
                    signal.alarm(SECONDS)

        try:
            self.scene.render(size=(640, 400), spp=8, progress=progress)
        except whit.Error as error:
            if children[0] == 0:
                self.render()
                os._exit(7 if "forked" in str(error) else 1)
            raise
        if children[0] == 0:
            os._exit(1)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(children[0], 0)[1]), 7)

    def test_multiprocessing(self):
        expect_in_processes("fork", self.scene, 2)


if __name__ == "__main__":
    unittest.main()
