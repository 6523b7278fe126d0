"""Makes the wheel of the module by CMake, for pip (PEP 517). Nothing is fetched: the libraries are
those of the system.

--config-settings build-dir=FOLDER: a build folder that is kept, or is there already."""

import base64
import hashlib
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def _version():
    text = (ROOT / "CMakeLists.txt").read_text()
    return re.search(r"project\(whit VERSION ([0-9.]+)", text)[1]


def _tag():
    python = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    platform = re.sub("[-.]", "_", sysconfig.get_platform())
    return f"{python}-{python}-{platform}"


def _build(folder):
    if not (folder / "CMakeCache.txt").exists():
        configure = ["cmake", "-S", ROOT, "-B", folder, "-DCMAKE_BUILD_TYPE=Release",
                     "-DWHIT_PYTHON=ON", "-DWHIT_TESTS=OFF", f"-DPython_EXECUTABLE={sys.executable}"]
        if shutil.which("ninja"):
            configure += ["-G", "Ninja"]
        subprocess.run(configure, check=True)
    subprocess.run(["cmake", "--build", folder, "--parallel", "--target", "whit_python"],
                   check=True)
    return folder / "python" / "whit"


def _files(package):
    for path in sorted(package.iterdir()):
        if path.is_file():
            yield f"whit/{path.name}", path.read_bytes()
    scenes = ROOT / "scenes"
    for path in sorted(scenes.rglob("*")):
        if path.suffix in (".json", ".hdr", ".ply") and "pictures" not in path.parts:
            yield f"whit/scenes/{path.relative_to(scenes)}", path.read_bytes()


def _metadata():
    readme = (HERE / "README.md").read_text()
    return ("Metadata-Version: 2.1\nName: whit\n"
            f"Version: {_version()}\nSummary: Real-time Whitted ray tracing on CPUs\n"
            "Requires-Python: >=3.9\nRequires-Dist: numpy\n"
            f"Description-Content-Type: text/markdown\n\n{readme}")


def _record(name, data):
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}\n"


def _write_wheel(path, files):
    info = f"whit-{_version()}.dist-info"
    wheel = f"Wheel-Version: 1.0\nGenerator: whit\nRoot-Is-Purelib: false\nTag: {_tag()}\n"
    files += [(f"{info}/METADATA", _metadata().encode()), (f"{info}/WHEEL", wheel.encode()),
              (f"{info}/LICENSE", (ROOT / "LICENSE").read_bytes())]
    record = "".join(_record(name, data) for name, data in files) + f"{info}/RECORD,,\n"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files + [(f"{info}/RECORD", record.encode())]:
            archive.writestr(zipfile.ZipInfo(name, (2026, 1, 1, 0, 0, 0)), data,
                             zipfile.ZIP_DEFLATED)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    name = f"whit-{_version()}-{_tag()}.whl"
    kept = (config_settings or {}).get("build-dir")
    with tempfile.TemporaryDirectory() as folder:
        package = _build(pathlib.Path(kept or folder).resolve())
        _write_wheel(pathlib.Path(wheel_directory) / name, list(_files(package)))
    return name


def build_sdist(sdist_directory, config_settings=None):
    raise NotImplementedError("the sources are the whole repository")
