#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The planted faults: what is wrong on purpose, as a text of the product that stands in one place, and the text that breaks it.
The product itself has no hooks: a fault is put into a copy of the tree.

usage: mutation/faults.py --check      does each anchor stand once where it is looked for? Exit 0 if so, else 1.
"""
import os
import pathlib
import subprocess
import sys
from typing import NamedTuple

ROOT = pathlib.Path(__file__).resolve().parent.parent


class Fault(NamedTuple):
    name: str
    target: str  # the fuzz target that is to find it (time_to_find.py)
    certify: bool  # must the quick level of certify notice it, too (mutants.py)?
    what: str
    file: str
    old: str
    new: str


FAULTS = [
    Fault("tie-sign", "triangle", True, "the sign of ties on edges that are not level", "engine/src/exact/edge.hpp",
          "return along_x != 0 ? along_x : along_y;",
          "return along_x != 0 ? -along_x : along_y;"),
    Fault("edge-bound-zero", "triangle", True, "no error bound of edge functions", "engine/src/exact/edge.hpp",
          "constexpr double kEdgeErrorBound = 0x1p-50;",
          "constexpr double kEdgeErrorBound = 0;"),
    Fault("residual-unchecked", "triangle", True, "the residual rung forgets its last sum", "engine/src/exact/edge.hpp",
          "if (ax.error == 0 && by.error == 0 && ab.error == 0 && abc.error == 0) {",
          "if (ax.error == 0 && by.error == 0 && ab.error == 0) {"),
    Fault("value-bound-zero", "triangle", True, "no error bound of values", "engine/src/exact/approximation.hpp",
          "(1 + 0x1p-20)}",
          "0}"),
    Fault("halfway-away-from-even", "triangle", True, "halfway cases rounded up", "engine/src/exact/exact.hpp",
          "if (above != 0) return above > 0 ? high : low;",
          "return above >= 0 ? high : low;"),
    Fault("box-ignores-w", "triangle", True, "a screen box that forgets the vertices behind the eye",
          "engine/src/exact/bounds.hpp",
          "if (w[i] > 0) continue;",
          "continue;"),
    Fault("snap-halfway", "grid", False, "halfway between grid positions, ties not to even", "engine/src/exact/grid.cpp",
          "return std::fmod(floor_of_t, 2) == 0 ? floor_of_t : up;",
          "return up;"),
    Fault("guard-band-cut", "grid", False, "a cut at the guard band that depends on the order of the end points",
          "engine/src/exact/grid.cpp",
          "sum.add_scaled(fa, fa.sign() * at_b);",
          "sum.add_scaled(fa, fa.sign() * (at_a < at_b ? at_b * (1 + 0x1p-20) : at_b));"),
    Fault("depth-tie", "paths", False, "equal depths resolved by position and not by identifier", "engine/src/fragments.cpp",
          "  const std::uint32_t index = index_of(draw_, f.position);\n  return takes_equal",
          "  const std::uint32_t index = index_at(place) + (f.position < layers_->position(place) ? -1u : 1u);\n  return takes_equal"),
    Fault("viewport-rounds-twice", "scene", True, "the viewport map rounded twice", "engine/src/viewport.cpp",
          "  if (low == high) return low;\n",
          "  return static_cast<float>(estimate);\n"),
    Fault("index-one-past", "arguments", False, "an index one past the vertices is accepted", "engine/src/arguments.cpp",
          "static_cast<std::uint32_t>(draw.vertices.size() - 1);",
          "static_cast<std::uint32_t>(draw.vertices.size());"),
    Fault("vertex-one-past", "reader", False, "a vertex number one past the vertices is read", "corpus/scene_reader.cpp",
          "if (number >= draw().vertices.size()) {",
          "if (number > draw().vertices.size()) {"),
]


def refresh_copy(tree):
    """The working tree in `tree`, and nothing else. Files that did not change are not touched, so that builds are incremental."""
    listed = subprocess.run(["git", "ls-files", "-z", "-co", "--exclude-standard"], cwd=ROOT, check=True,
                            capture_output=True).stdout.split(b"\0")
    names = {name for name in map(os.fsdecode, filter(None, listed)) if (ROOT / name).is_file()}
    for old in [path for path in tree.rglob("*") if path.is_file() and path.relative_to(tree).as_posix() not in names]:
        old.unlink()
    for name in sorted(names):
        source, copy = ROOT / name, tree / name
        if not copy.is_file() or source.read_bytes() != copy.read_bytes():
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(source.read_bytes())


def broken(fault, tree):
    """The text of its file, with the fault in it; None if its anchor does not stand there once."""
    try:
        text = (tree / fault.file).read_text()
    except FileNotFoundError:
        text = ""
    if text.count(fault.old) == 1:
        return text.replace(fault.old, fault.new)
    print(f"{fault.file}:1: the anchor of the planted fault {fault.name} stands here {text.count(fault.old)} times: {fault.old!r}",
          file=sys.stderr)
    return None


def plant(fault, tree):
    """The working tree with the fault in it, in `tree`."""
    refresh_copy(tree)
    text = broken(fault, tree)
    if text is None:
        sys.exit(2)
    (tree / fault.file).write_text(text)


def named(names, certify=False):
    """The faults of these names, or all; those alone that certify must notice, if so asked."""
    able = [fault for fault in FAULTS if fault.certify or not certify]
    unknown = sorted(set(names) - {fault.name for fault in able})
    if unknown:
        sys.exit(f"no such fault: {', '.join(unknown)} (there are: {', '.join(fault.name for fault in able)})")
    return [fault for fault in able if not names or fault.name in names]


if __name__ == "__main__":
    if sys.argv[1:] != ["--check"]:
        sys.exit(__doc__)
    sys.exit(1 if None in [broken(fault, ROOT) for fault in FAULTS] else 0)
