"""Makes the wheel of the module by CMake, for pip (PEP 517), with the libraries of the system.

--config-settings build-dir=FOLDER: a build folder that is kept, or is there already; it is
relative to the folder that pip was called in."""

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def _callers_folder():
    """The working directory of pip, which calls this program in the folder of the sources."""
    folder = pathlib.Path(f"/proc/{os.getppid()}/cwd")
    return folder.resolve() if folder.exists() else pathlib.Path.cwd()


def _build(folder):
    """The files of the package, from their paths to their bytes."""
    if not (folder / "CMakeCache.txt").exists():
        print("whit: compiling takes minutes; pip install -v shows how far it is", flush=True)
        subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-DCMAKE_BUILD_TYPE=Release",
                        "-DWHIT_PYTHON=ON", "-DWHIT_TESTS=OFF",
                        f"-DPython_EXECUTABLE={sys.executable}"], check=True)
    # Without a number, make would start all compilers at once, and memory would run out.
    jobs = str(len(os.sched_getaffinity(0)))
    subprocess.run(["cmake", "--build", folder, "--parallel", jobs, "--target", "whit_python"],
                   check=True)
    scenes = ROOT / "scenes"
    files = {f"whit/{path.name}": path.read_bytes()
             for path in (folder / "python" / "whit").iterdir() if path.is_file()}
    files.update({f"whit/scenes/{path.relative_to(scenes)}": path.read_bytes()
                  for path in scenes.rglob("*")
                  if path.suffix in (".json", ".hdr", ".ply", ".glb")
                  and "pictures" not in path.parts})
    return files


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    cmake = (ROOT / "CMakeLists.txt").read_text()
    version = re.search(r"project\(whit VERSION ([0-9.]+)", cmake)[1]
    python = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    tag = f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"
    info = f"whit-{version}.dist-info"
    with tempfile.TemporaryDirectory() as folder:
        kept = (config_settings or {}).get("build-dir", folder)
        files = _build(_callers_folder() / kept)
    files[f"{info}/METADATA"] = (
        f"Metadata-Version: 2.1\nName: whit\nVersion: {version}\n"
        "Summary: Real-time Whitted ray tracing on CPUs\nRequires-Python: >=3.9\n"
        "Requires-Dist: numpy\nDescription-Content-Type: text/markdown\n\n"
        f"{(HERE / 'README.md').read_text()}").encode()
    files[f"{info}/WHEEL"] = ("Wheel-Version: 1.0\nGenerator: whit\nRoot-Is-Purelib: false\n"
                              f"Tag: {tag}\n").encode()
    files[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    digests = {path: base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
               for path, data in files.items()}
    record = "".join(f"{path},sha256={digests[path]},{len(files[path])}\n" for path in files)
    files[f"{info}/RECORD"] = f"{record}{info}/RECORD,,\n".encode()
    name = f"whit-{version}-{tag}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / name, "w",
                         zipfile.ZIP_DEFLATED) as archive:
        for path, data in files.items():
            archive.writestr(path, data)
    return name
