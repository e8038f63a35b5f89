#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks what a compiler does not: which folder includes which, the length of code files, and their format.

usage: cmake/check_sources.py [FOLDER]        (default: the project)
Prints FILE:LINE: CAUSE for each fault. Exit 0: none; 1: some; 2: clang-format 14 is missing.
"""
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys

# The rooms of the house, from the ground up: a room's name is a folder (or a file) and holds for all below it that has no
# room of its own. A room may include itself and those that its row names, which stand above its row.
ENGINE = ["engine/include"]
SUITE = [*ENGINE, "oracle", "corpus", "properties"]
ROOMS = {
    "hwy": [],  # Highway's headers
    "engine/include": [],
    "engine/src/build_check.hpp": [],
    "engine/src/float_environment.hpp": ["engine/src/build_check.hpp"],
    "engine/src/facts.hpp": [*ENGINE],
    "engine/src/exact": [*ENGINE, "engine/src/build_check.hpp", "engine/src/facts.hpp"],
    "engine/src/fast": [*ENGINE, "engine/src/exact", "engine/src/float_environment.hpp", "engine/src/facts.hpp",
                        "engine/src/build_check.hpp", "hwy"],
    "engine/src": [*ENGINE, "engine/src/exact", "engine/src/fast", "engine/src/float_environment.hpp", "engine/src/facts.hpp",
                   "engine/src/build_check.hpp", "hwy"],
    "python": [*ENGINE],
    "examples": [*ENGINE],  # those that embed the engine
    "mutation/zoo/zoo.hpp": [*ENGINE],
    "oracle/edges.hpp": [*ENGINE],
    "oracle/model.hpp": [*ENGINE],
    "oracle": [*ENGINE, "oracle/edges.hpp", "oracle/model.hpp"],
    "corpus": [*ENGINE],
    "textbook": [*ENGINE, "engine/src/exact"],  # it shows the engine's own arithmetic
    "properties": SUITE[:-1],
    "proofs": SUITE,
    "elsewhere": [*ENGINE, "corpus", "properties"],
    "certify/adapter.h": [],
    "certify/adapter2.h": ["certify/adapter.h"],
    "certify/drivers": ["certify/adapter.h", "certify/adapter2.h"],  # plugins: all they know of the suite
    "examples/rivals": ["certify/adapter.h", "certify/adapter2.h"],  # the same
    "certify/judge": [*ENGINE, "corpus", "oracle/edges.hpp", "oracle/model.hpp"],  # a library without an oracle, files or processes
    "certify": [*SUITE, "oracle/model.hpp", "textbook", "certify/adapter.h", "certify/adapter2.h", "certify/judge",
                "mutation/zoo/zoo.hpp"],
    "reference/surefill_reference.h": [],  # the engine's reference path in one file: it stands alone
    "reference": ["reference/surefill_reference.h"],
    "bench": [*ENGINE, "corpus", "hwy"],
    "fuzz": [*SUITE, "certify", "certify/judge", "hwy"],
    "examples/fuzz_your_rasterizer.cpp": [*SUITE, "fuzz"],  # an example of the suite
    "mutation": [*SUITE, "certify", "certify/adapter.h", "certify/judge", "mutation/zoo/zoo.hpp", "oracle/model.hpp"],
    "web/wasm": [*SUITE, "certify"],  # the page's judge: what the certify command is made of, without a system
    # Tests see what they test, what that sees, and the properties.
    "engine/tests": [*SUITE, "engine/src", "engine/src/exact", "engine/src/fast", "hwy"],
    "oracle/tests": [*SUITE, "oracle/model.hpp"],
    "corpus/tests": SUITE,
    "textbook/tests": [*SUITE, "engine/src/exact", "textbook"],
    "properties/tests": SUITE,
    "certify/tests": [*SUITE, "oracle/model.hpp", "certify/judge", "textbook", "certify", "certify/adapter.h", "certify/adapter2.h",
                      "mutation"],
    "fuzz/tests": [*SUITE, "certify", "fuzz"],
    "mutation/tests": [*SUITE, "certify", "certify/adapter.h", "mutation", "mutation/zoo/zoo.hpp"],
    "mutation/schemata": [*SUITE, "certify", "engine/tests", "hwy"],  # a suite of its own, of the engine's tests among others
}
LONGEST = 700  # lines
MADE = {"reference/surefill_reference.cpp": "reference/amalgamate.py"}  # files of any length, and what makes them
FORMATTED = {".c", ".cpp", ".h", ".hpp"}
CODE = FORMATTED | {".cmake", ".in", ".ml", ".mjs", ".py", ".sh", ".v"}
INCLUDE = re.compile(r'\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)')


def code_files(root):
    """Paths below root, as texts; without what is built and what is hidden."""
    for folder, folders, names in os.walk(root):
        folders[:] = sorted(f for f in folders if f[0] != "." and f != "__pycache__" and not (folder == str(root) and f in ("build", "out")))
        for name in sorted(names):
            path = pathlib.Path(folder, name)
            if (path.suffix in CODE or name in ("CMakeLists.txt", "dev")) and not path.is_symlink():
                yield path.relative_to(root).as_posix()


def room_of(path):
    """The longest room that is the path or a folder above it."""
    parts = path.split("/")
    return next((room for n in range(len(parts), 0, -1) if (room := "/".join(parts[:n])) in ROOMS), None)


def meant(root, file, include):
    """The project's file that an include names, or the name itself where none is there (it is built, or a library's)."""
    for base in (os.path.dirname(file), "", "engine/include", "engine/src"):
        path = os.path.normpath(os.path.join(base, include))
        if (root / path).is_file():
            return path
    return include


def check_includes(root, file, lines):
    room = room_of(file)
    if room is None:
        yield 1, "this folder has no row in the table of cmake/check_sources.py"
        return
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        target = meant(root, file, match[1] or match[2])
        other = room_of(target)
        if match[2] and other is None:
            continue  # a library's
        if other is None:
            yield number, f'"{match[1]}" is no file of the project; a library\'s header is included with <>'
        elif other != room and other not in ROOMS[room]:
            yield number, f"{room} may not include {other} ({target})"


def check_format(root, program, files):
    """(file, line, cause), each line once."""
    result = subprocess.run([program, "--dry-run", "-Werror", "--style=file", *files], cwd=root, capture_output=True, text=True)
    found = re.findall(r"^(.+?):(\d+):\d+: error: (.*)$", result.stderr, re.M)
    if result.returncode != 0 and not found:
        sys.exit(f"check_sources: clang-format failed:\n{result.stderr}")
    return sorted({(file, int(line), "not as clang-format 14 has it (clang-format -i FILE)") for file, line, _ in found})


def clang_format():
    for name in ("clang-format-14", "clang-format"):
        program = shutil.which(name)
        if program and "version 14." in subprocess.run([program, "--version"], capture_output=True, text=True).stdout:
            return program
    print("check_sources: clang-format 14 is not there (Debian's package clang-format)", file=sys.stderr)
    sys.exit(2)


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent).resolve()
    above = []
    for room, below in ROOMS.items():
        upward = [name for name in below if name not in above]
        if upward:
            sys.exit(f"check_sources: the table is no order of layers: {room} names {', '.join(upward)}, which stands below it")
        above.append(room)
    program = clang_format()
    files, faults = list(code_files(root)), []
    for file in files:
        lines = (root / file).read_text(encoding="utf-8").splitlines()
        if file in MADE:
            made = subprocess.run([sys.executable, root / MADE[file], "--check"], capture_output=True, text=True)
            if made.returncode != 0:
                faults.append((file, 1, made.stderr.strip()))
        elif len(lines) > LONGEST:
            faults.append((file, LONGEST + 1, f"{len(lines)} lines; a file of code has at most {LONGEST}"))
        if pathlib.Path(file).suffix in FORMATTED:
            faults += [(file, *fault) for fault in check_includes(root, file, lines)]
    formatted = [file for file in files if pathlib.Path(file).suffix in FORMATTED]
    shares = [formatted[n::8] for n in range(8) if formatted[n::8]]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for found in pool.map(lambda share: check_format(root, program, share), shares):
            faults += found
    for file, line, cause in sorted(faults):
        print(f"{file}:{line}: {cause}")
    print(f"sources: {len(files)} files of code, {len(formatted)} of them C and C++: "
          + (f"{len(faults)} faults" if faults else "layers, lengths and format hold"))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
