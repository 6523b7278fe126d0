"""What the tests of the Python module share."""

import concurrent.futures
import contextlib
import multiprocessing
import os
import signal
import subprocess
import sys
import tempfile
import threading

import numpy as np
from numpy.testing import assert_array_equal

import whit

SIZE = (48, 30)
LONG = dict(size=(640, 400), spp=64)  # seconds, if nothing ends it
SECONDS = 60  # a child that hangs is ended by its alarm


@contextlib.contextmanager
def temporary_folder():
    """A folder, which is also the working directory while it is there."""
    before = os.getcwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            yield folder
        finally:
            os.chdir(before)


def program(*words):
    """The output of the program whit."""
    done = subprocess.run([os.environ["WHIT_PROGRAM"], *words], capture_output=True, text=True,
                          check=False)
    if done.returncode != 0:
        raise AssertionError(f"whit {' '.join(words)}: {done.stderr}{done.stdout}")
    return done.stdout


def expect_picture(picture, name, *words):
    """Expects that the program, with these words, makes the same files of a scene."""
    for kind in ("exr", "png"):
        picture.write(f"module.{kind}")
        program("render", name, "-o", f"program.{kind}", "--size", "48x30", "--quiet", *words)
        program("compare", f"module.{kind}", f"program.{kind}", "--tolerance", "0", "--quiet")


def python(code, *flags, **arguments):
    """The outcome of a Python program; `arguments` are those of subprocess.run."""
    return subprocess.run([sys.executable, *flags, "-c", code], capture_output=True, text=True,
                          check=False, **arguments)


def in_threads(work, *arguments):
    """What map(work, *arguments) has, each call on a thread of its own."""
    with concurrent.futures.ThreadPoolExecutor(len(arguments[0])) as pool:
        return list(pool.map(work, *arguments))


@contextlib.contextmanager
def another_thread_rendering(scene):
    """Another thread renders the scene, again and again, while this is entered."""
    begun, stop = threading.Event(), threading.Event()

    def progress(phase, fraction):
        begun.set()
        return not stop.is_set()

    def work():
        with contextlib.suppress(whit.Error):
            while True:
                scene.render(progress=progress, **LONG)

    thread = threading.Thread(target=work)
    thread.start()
    begun.wait()
    try:
        yield
    finally:
        stop.set()
        thread.join()


def _put_pixels(scene, queue):
    signal.alarm(SECONDS)
    queue.put(pixels(scene))


def expect_in_processes(method, scene, count):
    """Expects that so many processes, made by that method, have the picture of the scene."""
    expected = pixels(scene)
    context = multiprocessing.get_context(method)
    queue = context.Queue()
    processes = [context.Process(target=_put_pixels, args=(scene, queue)) for _ in range(count)]
    for process in processes:
        process.start()
    for _ in processes:
        assert_array_equal(queue.get(timeout=SECONDS), expected)
    for process in processes:
        process.join()
        assert_array_equal(process.exitcode, 0)


def error_of(call, *arguments, **named):
    """The whit.Error that a call raises."""
    try:
        call(*arguments, **named)
    except whit.Error as error:
        return error
    raise AssertionError("nothing was raised")


def square(**arrays):
    """A mesh, its corners at -1 and 1 in the plane y = 0."""
    positions = np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]], np.float32)
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
    return whit.Mesh(arrays.pop("positions", positions), arrays.pop("triangles", triangles),
                     **arrays)


def square_scene(mesh=None, **members):
    """The description of a scene of that mesh, seen from above, a light beside it."""
    return {
        "cameras": {"above": {"eye": [0, 3, 2], "at": [0, 0, 0], "fov": 50}},
        "lights": [{"position": [2, 4, 1], "intensity": 60}],
        "materials": {"red": {"diffuse": [0.8, 0.2, 0.1]}},
        "scene": [{"mesh": mesh or square(), "material": "red"}],
        **members,
    }


def scene_of(mesh=None, **members):
    return whit.Scene(square_scene(mesh, **members))


def pixels(scene):
    """The picture of a scene in the size that tests use, as linear colors."""
    return scene.render(size=SIZE).rgb


def _picture(shown):
    return pixels(shown) if isinstance(shown, whit.Scene) else shown


def assert_same(one, other):
    """Expects the same picture, bit for bit, of two scenes, or of a scene and a picture."""
    assert_array_equal(_picture(one), _picture(other))


def assert_other(one, other):
    """Expects two pictures, of scenes or as they are, to differ."""
    if np.array_equal(_picture(one), _picture(other)):
        raise AssertionError("the pictures are the same")
