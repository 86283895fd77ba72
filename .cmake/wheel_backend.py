# SPDX-License-Identifier: MIT
"""Builds the wheel of the Python package (PEP 517) with cmake, in the folder of the release preset: what is built there already is used.
Needs what .ci/packages.txt lists, and nothing from the network."""
import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "release"


def _version():
    return re.search(r"project\(fettle VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)


def _metadata():
    return f"""Metadata-Version: 2.1
Name: fettle
Version: {_version()}
Summary: Tunes mechanisms of rigid parts under certified clearance
License: MIT
Requires-Python: >=3.11
Requires-Dist: numpy
"""


def _tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return f"{python}-{python}-{platform}"


def _run(*command):
    subprocess.run(command, cwd=ROOT, check=True)


def _build():
    # Not the interpreter of a virtual environment, which goes away: the one that it stands on.
    options = [f"-DPython_EXECUTABLE={os.path.realpath(sys.executable)}", "-DFETTLE_PYTHON=ON"]
    if not (BUILD / "CMakeCache.txt").exists():
        options.append("-DFETTLE_TESTS=OFF")
    _run("cmake", "--preset", "release", *options)
    _run("cmake", "--build", str(BUILD), "--target", "fettle_python", "fettle_cli")


def _files():
    """(path in the wheel, file)."""
    package = ROOT / "design" / "python" / "fettle"
    for file in sorted([*package.glob("*.py"), *package.glob("*.pyi"), package / "py.typed"]):
        yield f"fettle/{file.name}", file
    (module,) = (BUILD / "python" / "fettle").glob("_fettle*" + sysconfig.get_config_var("EXT_SUFFIX"))
    yield f"fettle/{module.name}", module
    yield f"fettle-{_version()}.data/scripts/fettle", BUILD / "bin" / "fettle"


def _digest(data):
    return "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    _build()
    info = f"fettle-{_version()}.dist-info"
    contents = [(name, file.read_bytes(), os.access(file, os.X_OK)) for name, file in _files()]
    wheel = f"Wheel-Version: 1.0\nGenerator: fettle\nRoot-Is-Purelib: false\nTag: {_tag()}\n"
    contents += [(f"{info}/METADATA", _metadata().encode(), False), (f"{info}/WHEEL", wheel.encode(), False)]
    contents.append((f"{info}/LICENSE", (ROOT / "LICENSE").read_bytes(), False))
    record = "".join(f"{name},{_digest(data)},{len(data)}\n" for name, data, _ in contents) + f"{info}/RECORD,,\n"
    contents.append((f"{info}/RECORD", record.encode(), False))
    name = f"fettle-{_version()}-{_tag()}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory, name), "w", zipfile.ZIP_DEFLATED) as archive:
        for path, data, executable in contents:
            entry = zipfile.ZipInfo(path, (2026, 1, 1, 0, 0, 0))
            entry.external_attr = (0o100755 if executable else 0o100644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)
    return name


def get_requires_for_build_wheel(config_settings=None):
    return []
