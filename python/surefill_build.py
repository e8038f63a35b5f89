# SPDX-License-Identifier: Apache-2.0
"""The build backend of pyproject.toml (PEP 517): makes the wheel, of the package's Python files and the library.

It needs CMake, a C++ compiler and Highway (or CMAKE_ARGS=-DSUREFILL_FETCH_HIGHWAY=ON), and no Python package. CMAKE_ARGS goes to
CMake. `--config-settings package=FOLDER` takes a package that CMake has built already (python/CMakeLists.txt).
Linux is tried; for macOS and Windows it is written, and UNTRIED."""

from __future__ import annotations

import base64
import hashlib
import io
import os
import pathlib
import re
import shlex
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from typing import Dict, List, Mapping, Optional, Tuple, Union

ROOT = pathlib.Path(__file__).resolve().parent.parent
Settings = Optional[Mapping[str, Union[str, List[str]]]]

# What every Linux of a manylinux tag has, by PEP 600, of what is used here; and the glibc of the first one whose libstdc++ has each
# GLIBCXX_3.4.x (as auditwheel's policies have it).
SYSTEM = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "libstdc++.so.6", "libgcc_s.so.1"}
GLIBC_OF_GLIBCXX = ((19, 17), (22, 24), (24, 28), (28, 31), (29, 34), (30, 35))


def version() -> str:
    text = (ROOT / "engine/include/surefill/version.hpp").read_text()
    found = re.search(r'SUREFILL_VERSION "([^"]+)"', text)
    if not found:
        raise SystemExit("surefill_build: engine/include/surefill/version.hpp tells no version")
    return found[1]


def metadata() -> str:
    return (f"Metadata-Version: 2.1\nName: surefill\nVersion: {version()}\n"
            "Summary: An exact triangle rasterizer for NumPy arrays: the same bits on every machine\n"
            "License: Apache-2.0\nRequires-Python: >=3.9\nRequires-Dist: numpy>=1.19\n"
            "Classifier: Topic :: Multimedia :: Graphics :: 3D Rendering\nClassifier: Typing :: Typed\n"
            "Description-Content-Type: text/markdown\n\n" + (ROOT / "docs/python.md").read_text())


def linux_tag(libraries: List[pathlib.Path]) -> Tuple[str, str]:
    """The platform tag of a wheel with these libraries, and why it is that one."""
    machine = sysconfig.get_platform().split("-")[-1]
    own, needed, glibc, glibcxx = {lib.name for lib in libraries}, set(), 0, 0
    for library in libraries:
        told = subprocess.run(["objdump", "-p", str(library)], check=True, stdout=subprocess.PIPE, text=True,
                              env={**os.environ, "LC_ALL": "C"}).stdout
        needed |= set(re.findall(r"NEEDED +(\S+)", told)) - own
        references = told[told.find("Version References:"):] if "Version References:" in told else ""
        glibc = max([glibc, *(int(n) for n in re.findall(r"\bGLIBC_2\.(\d+)", references))])
        glibcxx = max([glibcxx, *(int(n) for n in re.findall(r"\bGLIBCXX_3\.4\.(\d+)", references))])
    foreign = sorted(name for name in needed - SYSTEM if not name.startswith("ld-linux"))
    if foreign:
        return f"linux_{machine}", f"it needs {', '.join(foreign)}, which not every Linux has"
    system = glibc
    if glibcxx:
        enough = [least for number, least in GLIBC_OF_GLIBCXX if number >= glibcxx]
        if not enough:
            return f"linux_{machine}", f"it needs GLIBCXX_3.4.{glibcxx}, of which the glibc is not known here"
        system = max(glibc, enough[0])
    return f"manylinux_2_{max(system, 17)}_{machine}", (f"the newest symbols are GLIBC_2.{glibc} and GLIBCXX_3.4.{glibcxx}; "
                                                        f"needed: {', '.join(sorted(needed))}")


def tag(libraries: List[pathlib.Path]) -> str:
    if sys.platform.startswith("linux"):
        name, reason = linux_tag(libraries)
        print(f"surefill_build: tag {name}: {reason}", file=sys.stderr)
        return "py3-none-" + name
    return "py3-none-" + re.sub(r"[-.]", "_", sysconfig.get_platform())


def build_package() -> pathlib.Path:
    """By CMake, in build/wheel; the package's folder."""
    folder = ROOT / "build" / "wheel"
    configure = ["cmake", "-S", str(ROOT), "-B", str(folder), "-DCMAKE_BUILD_TYPE=Release", "-DSUREFILL_SUITE=OFF",
                 "-DSUREFILL_PYTHON=ON", f"-DPython3_EXECUTABLE={sys.executable}", *shlex.split(os.environ.get("CMAKE_ARGS", ""))]
    for command in (configure, ["cmake", "--build", str(folder), "--config", "Release", "--target", "surefill_python", "--parallel"]):
        subprocess.run(command, check=True)
    return folder / "python" / "surefill"


def build_wheel(wheel_directory: str, config_settings: Settings = None, metadata_directory: Optional[str] = None) -> str:
    given = (config_settings or {}).get("package")
    package = pathlib.Path(str(given)).resolve() if given else build_package()
    libraries = sorted(p for p in package.iterdir() if re.search(r"\.(so(\.\d+)*|dylib|dll)$", p.name))
    if not any("surefill" in library.name for library in libraries):
        raise SystemExit(f"surefill_build: there is no library in {package}")
    files: Dict[str, bytes] = {}
    for path in sorted((ROOT / "python/surefill").iterdir()) + libraries:
        if path.suffix == ".py" or path.name == "py.typed" or path in libraries:
            files[f"surefill/{path.name}"] = path.read_bytes()
    info, label = f"surefill-{version()}.dist-info", tag(libraries)
    files[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    files[f"{info}/METADATA"] = metadata().encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: surefill_build\nRoot-Is-Purelib: false\nTag: {label}\n".encode()
    record = "".join(f"{name},sha256={base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()},{len(data)}\n"
                     for name, data in files.items())
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    wheel = f"surefill-{version()}-{label}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as out:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name)  # of 1980, so that the same files give the same wheel
            entry.external_attr, entry.compress_type = 0o100644 << 16, zipfile.ZIP_DEFLATED
            out.writestr(entry, data)
    return wheel


def build_sdist(sdist_directory: str, config_settings: Settings = None) -> str:
    """What build_wheel needs: the engine, its build files, the package."""
    base = f"surefill-{version()}"
    paths = [ROOT / name for name in ("CMakeLists.txt", "pyproject.toml", "LICENSE", "CHANGELOG.md", "docs/semantics.md",
                                      "docs/python.md")]
    for folder in ("cmake", "engine/include", "engine/src", "python"):
        paths += sorted(p for p in (ROOT / folder).rglob("*") if p.is_file() and "__pycache__" not in p.parts)
    paths.append(ROOT / "engine/CMakeLists.txt")

    def entry(name: str, size: int) -> tarfile.TarInfo:
        info = tarfile.TarInfo(f"{base}/{name}")
        info.size, info.mode = size, 0o644
        return info

    with tarfile.open(pathlib.Path(sdist_directory, f"{base}.tar.gz"), "w:gz", format=tarfile.PAX_FORMAT) as out:
        for name, data in [("PKG-INFO", metadata().encode()),
                           *((p.relative_to(ROOT).as_posix(), p.read_bytes()) for p in paths)]:
            out.addfile(entry(name, len(data)), io.BytesIO(data))
    return f"{base}.tar.gz"
