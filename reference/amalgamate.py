#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes surefill_reference.h and surefill_reference.cpp of the engine's sources: its reference path, as one header and one source.

usage: reference/amalgamate.py [--check] [FOLDER]      (default: the folder of this script)

What goes in is found by following #include from the public calls: a header, and the source beside it. What is of the fast
path stays out. --check writes nothing. Exit 0: the files are as they should be; 1: they are not (--check); 2: the sources
are not as this script knows them.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PUBLIC = ROOT / "engine" / "include"
SOURCES = ROOT / "engine" / "src"
HEADERS = ["surefill/surefill.hpp", "surefill/diagnostics.hpp"]  # what a user includes
CALLS = ["surefill.cpp", "viewport.cpp"]  # where what it declares is defined
INCLUDE = re.compile(r'^#include ([<"])([^>"]+)[>"]\n', re.M)

NOTE = """// SPDX-License-Identifier: Apache-2.0
//
// Surefill {version}: the reference engine in {what}. Made by reference/amalgamate.py of engine/ in
// Surefill's sources: change those, and not this file.
// clang-format off
"""
USE = """//
// To have a golden model in a project of your own, copy surefill_reference.h and surefill_reference.cpp, and compile the second as C++20;
// it needs nothing but the standard library, and starts no threads. It is the engine's reference path: every bit that it
// writes is that of docs/semantics.md and of Surefill itself, on every machine. Where Surefill's sources say `surefill`, here it is
// `surefill_reference`, so both can be linked into one program. What Options says of threads, paths and memory has no effect.
// Compile it without -ffast-math and, on 32-bit x86, with -msse2 -mfpmath=sse: otherwise it does not compile. Where the
// compiler contracts to fused operations all the same, calls return Status::bad_build.
"""
# g++ contracts unless it is told not to. clang does so within an expression, and knows the standard's pragma.
GUARD = """
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off")
#elif defined(_MSC_VER)
#pragma fp_contract(off)
#endif
"""


def fail(cause):
    print(f"amalgamate: {cause}", file=sys.stderr)
    sys.exit(2)


def reference_only(text, path):
    """The text as the preprocessor leaves it where SUREFILL_REFERENCE_ONLY is defined."""
    kept, stack = [], []  # of each open #if: None if it is of no interest here, else whether its branch is left out
    for line in text.splitlines(keepends=True):
        word = re.match(r"\s*#\s*(if|ifdef|ifndef|elif|else|endif)\b(.*)", line)
        ours = False
        if word and word[1] in ("if", "ifdef", "ifndef"):
            ours = "SUREFILL_REFERENCE_ONLY" in line
            condition = " ".join((word[1] + word[2]).split("//")[0].split())
            absent = {"if !defined(SUREFILL_REFERENCE_ONLY)": True, "ifndef SUREFILL_REFERENCE_ONLY": True,
                      "if defined(SUREFILL_REFERENCE_ONLY)": False, "ifdef SUREFILL_REFERENCE_ONLY": False}
            if ours and condition not in absent:
                fail(f"{path}: a condition that this script does not know: {line.strip()}")
            stack.append(absent[condition] if ours else None)
        elif word and stack and word[1] == "endif":
            ours = stack.pop() is not None
        elif word and stack and stack[-1] is not None:
            if word[1] == "elif":
                fail(f"{path}: #elif of SUREFILL_REFERENCE_ONLY")
            stack[-1], ours = not stack[-1], True
        if not ours and True not in stack:
            kept.append(line)
    return "".join(kept)


def body_of(path):
    """(what the file includes, its text without includes, include guard and the comment of the licence)."""
    text = reference_only(path.read_text(encoding="utf-8"), path)
    text = re.sub(r"\A(//|/\*) SPDX-License-Identifier: [^\n]*\n", "", text)
    guard = re.search(r"^#ifndef (\w+_HP?P?)\n#define \1\n", text, re.M)
    if guard:
        text = text.replace(guard[0], "", 1)
        text, removed = re.subn(rf"\n#endif\s*(//|/\*) {guard[1]}( \*/)?\n\Z", "\n", text)
        if removed != 1:
            fail(f"{path}: no end of the guard {guard[1]}")
    includes = INCLUDE.findall(text)
    text = re.sub(r"#if defined\(__SSE2__\)\n#include <immintrin.h>\n#endif\n", "", text)
    return includes, INCLUDE.sub("", text).strip("\n") + "\n"


def renamed(text):
    text = re.sub(r"\bnamespace surefill\b", "namespace surefill_reference", text)
    text = re.sub(r"\bsurefill::(?=\w)", "surefill_reference::", text)
    text = re.sub(r"\bSUREFILL_API ", "", text)
    text = text.replace("#include <surefill/surefill.hpp>", '#include "surefill_reference.h"')  # in an example
    return text.replace("SUREFILL_VERSION", "SUREFILL_REFERENCE_VERSION")


class Amalgam:
    def __init__(self):
        self.seen, self.standard, self.parts = set(), set(), []

    def found(self, name, file):
        """The path of an #include, or None if it is not the engine's."""
        return next((path.resolve() for path in (file.parent / name, SOURCES / name, PUBLIC / name) if path.is_file()), None)

    def add(self, path):
        """The file, after what it includes and before the sources beside those headers."""
        if path in self.seen or path.name == "export.h" or SOURCES / "fast" in path.parents:
            return
        self.seen.add(path)
        includes, text = body_of(path)
        beside = []
        for kind, name in includes:
            header = self.found(name, path)
            if kind == "<":
                self.standard.add(name)
            elif header is None:
                fail(f"{path}: {name} is not found")
            else:
                self.add(header)
                beside.append(header.with_suffix(".cpp"))
        self.parts.append((path, text))
        for source in beside:
            if source.is_file() and source != path:
                self.add(source)

    def text(self):
        parts = [f"\n// ---------------------------------------------------------------- {path.relative_to(ROOT / 'engine').as_posix()}\n{renamed(text)}"
                 for path, text in self.parts]
        return "".join(parts)

    def includes(self):
        return "".join(f"#include <{name}>\n" for name in sorted(self.standard - {"immintrin.h"}))


def header_and_source():
    header, source = Amalgam(), Amalgam()
    for name in HEADERS:
        header.add((PUBLIC / name).resolve())
    source.seen |= header.seen
    for name in CALLS:
        source.add((SOURCES / name).resolve())
    version = re.search(r'SUREFILL_VERSION "([^"]+)"', (PUBLIC / "surefill" / "version.hpp").read_text())[1]
    intrinsics = "\n#if defined(__SSE2__)\n#include <immintrin.h>\n#endif\n" if "immintrin.h" in source.standard else ""
    # The sources beside the headers come after all headers: those are what they need.
    source.parts.sort(key=lambda part: part[0].suffix == ".cpp")
    return (NOTE.format(version=version, what="one file, its header") + USE +
            "#ifndef SUREFILL_REFERENCE_H\n#define SUREFILL_REFERENCE_H\n\n" + header.includes() + header.text() +
            "\n#endif  // SUREFILL_REFERENCE_H\n",
            NOTE.format(version=version, what="one file, its source") + '#include "surefill_reference.h"\n\n' + source.includes() +
            intrinsics + GUARD + source.text())


def main(arguments):
    check = "--check" in arguments
    folders = [argument for argument in arguments if argument != "--check"]
    if len(folders) > 1 or any(folder.startswith("-") for folder in folders):
        print(__doc__, file=sys.stderr)
        return 2
    folder = pathlib.Path(folders[0]) if folders else pathlib.Path(__file__).resolve().parent
    stale = []
    for name, text in zip(("surefill_reference.h", "surefill_reference.cpp"), header_and_source()):
        path = folder / name
        if path.is_file() and path.read_text(encoding="utf-8") == text:
            continue
        stale.append(name)
        if not check:
            folder.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
    if check and stale:
        print(f"amalgamate: {' and '.join(stale)}: not of the engine as it is; reference/amalgamate.py makes them", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
