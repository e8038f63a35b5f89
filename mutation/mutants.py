#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Breaks a copy of the engine, one line at a time, and expects `surefill certify` to notice each: exit status 1 and a
reduced scene of at most two triangles on which broken engine and oracle differ. A check that cannot fail is a defect.

usage: mutation/mutants.py [NAME ...]     (default: all of MUTANTS)
       mutation/mutants.py --check        does each line to be broken stand once where it is looked for?
Exit 0 if every mutant is caught, 1 if one is not, 2 if one cannot be built. Works in build/mutants.
"""
import json
import os
import pathlib
import subprocess
import sys

# (name, file, the text that is there, the text that breaks it)
MUTANTS = [
    ("tie-sign", "engine/src/exact/edge.hpp",
     "return along_x != 0 ? along_x : along_y;",
     "return along_x != 0 ? -along_x : along_y;"),
    ("tie-of-horizontal-edges", "engine/src/exact/edge.hpp",
     "const int along_x = sign_of(a) * shift.x, along_y = sign_of(b) * shift.y;",
     "const int along_x = sign_of(a) * shift.x, along_y = sign_of(b);"),
    ("edge-bound-zero", "engine/src/exact/edge.hpp",
     "constexpr double kEdgeErrorBound = 0x1p-50;",
     "constexpr double kEdgeErrorBound = 0;"),
    ("residual-unchecked", "engine/src/exact/edge.hpp",
     "if (ax.error == 0 && by.error == 0 && ab.error == 0 && abc.error == 0) {",
     "if (ax.error == 0 && by.error == 0 && ab.error == 0) {"),
    ("expansion-loses-a-term", "engine/src/exact/edge.hpp",
     "    sum.add(-(jy * kx));\n",
     ""),
    ("value-bound-zero", "engine/src/exact/triangle.hpp",
     "(1 + 0x1p-20)}",
     "0}"),
    ("rounding-by-cast", "engine/src/exact/triangle.hpp",
     "    ++statistics.values_by_expansion;\n    return exact();",
     "    return static_cast<float>(q.value);"),
    ("halfway-away-from-even", "engine/src/exact/exact.hpp",
     "if (above != 0) return above > 0 ? high : low;",
     "return above >= 0 ? high : low;"),
    ("box-ignores-w", "engine/src/exact/bounds.hpp",
     "if (w[i] > 0) continue;",
     "continue;"),
    ("box-last-row", "engine/src/exact/bounds.hpp",
     "std::clamp(highest + 1,",
     "std::clamp(highest,"),
    ("int32-bound-zero", "engine/src/fast/record.hpp",
     "kSmallBound = 16, kTileBound = 64;",
     "kSmallBound = 0, kTileBound = 0;"),
    ("depth-bound-zero", "engine/src/fast/set_up-inl.hpp",
     "hn::Store(total, dd, batch.plane_error + lane);",
     "hn::Store(hn::Zero(dd), dd, batch.plane_error + lane);"),
    ("attribute-at-corner", "engine/src/fast/shade-inl.hpp",
     "pixels.y[l] = y + 0.5;",
     "pixels.y[l] = y;"),
    ("index-order", "engine/src/fast/fragments-inl.hpp",
     "draw.identifiers[position] < draw.identifiers[other] : position < other;",
     "draw.identifiers[position] > draw.identifiers[other] : position > other;"),
    ("nan-let-through", "engine/src/fast/set_up-inl.hpp",
     "hn::MulAdd(v.z, zero, hn::MulAdd(v.w, zero, sum))",
     "hn::MulAdd(v.w, zero, sum)"),
    ("clip-on-stored-depth", "engine/src/exact/triangle.hpp",
     "if (!(low > 0 && high < 1) && !inside_unit_range(exact_depth_numerator(p), statistics)) return false;",
     ""),
    ("facing-of-d", "engine/src/reference.cpp",
     "(facing > 0) == (draw_.front_face",
     "(facing >= 0) != (draw_.front_face"),
    ("scissor-closed", "engine/src/fast/frame.cpp",
     "std::min(region.x1, scissor->x1)",
     "std::min(region.x1, scissor->x1 + (scissor->x1 < region.x1 ? 1 : 0))"),
    ("flat-minus-zero", "engine/src/fast/shade-inl.hpp",
     "values_of(l, 0)[c] + 0.0f;",
     "values_of(l, 0)[c];"),
    ("centroid-last-sample", "engine/src/fast/shade-inl.hpp",
     "for (int n = 0; n < target_.samples; ++n) {",
     "for (int n = target_.samples - 1; n >= 0; --n) {"),
    ("viewport-rounds-twice", "engine/src/viewport.cpp",
     "  if (low == high) return low;\n",
     "  return static_cast<float>(estimate);\n"),
    ("float-state-kept", "engine/src/float_environment.hpp",
     "FloatState::of_engine().set(); }",
     "}"),
    ("exception-flags-lost", "engine/src/float_environment.hpp",
     "return FloatState(control_ | flags);",
     "return FloatState((control_ & ~0x3Fu) | flags);"),
]

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "mutants"


def refresh_copy():
    """The working tree in WORK/src. Files that did not change are not touched, so that builds are incremental."""
    names = subprocess.run(["git", "ls-files", "-z", "-co", "--exclude-standard"], cwd=ROOT, check=True,
                           capture_output=True).stdout.split(b"\0")
    for name in map(os.fsdecode, filter(None, names)):
        source, copy = ROOT / name, WORK / "src" / name
        if source.is_file() and (not copy.is_file() or source.read_bytes() != copy.read_bytes()):
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(source.read_bytes())


def build():
    with open(WORK / "log", "w") as log:
        for command in (["cmake", "-S", WORK / "src", "-B", WORK / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"],
                        ["cmake", "--build", WORK / "build", "--target", "surefill_command"]):
            if subprocess.run(command, stdout=log, stderr=subprocess.STDOUT).returncode != 0:
                sys.exit(f"mutants: the build failed, see {WORK / 'log'}")


def certify(name):
    """(exit status, triangles of the smallest reduced scene or None, names of the checks that failed)"""
    scenes = WORK / "scenes" / name
    scenes.mkdir(parents=True, exist_ok=True)
    for old in scenes.iterdir():
        old.unlink()
    with open(scenes / "report.txt", "w") as report:
        status = subprocess.run([WORK / "build" / "certify" / "surefill", "certify", "--level", "quick", "--corpus",
                                 ROOT / "corpus", "--output-dir", scenes, "--json", scenes / "report.json"],
                                stdout=report, stderr=subprocess.STDOUT).returncode
    sizes = [sum(line.split()[:1] == ["triangle"] for line in scene.read_text().splitlines())
             for scene in scenes.glob("*.scene")]
    failed = [check["name"] for check in json.loads((scenes / "report.json").read_text())["checks"] if check["differences"]]
    return status, min(sizes, default=None), failed


def broken(name, file, old, new, root):
    text = (root / file).read_text()
    if text.count(old) != 1:
        print(f"mutants: {name}: its line stands {text.count(old)} times in {file}", file=sys.stderr)
        sys.exit(2)
    return text.replace(old, new)


def main():
    if sys.argv[1:] == ["--check"]:
        for mutant in MUTANTS:
            broken(*mutant, ROOT)
        return 0
    unknown = set(sys.argv[1:]) - {mutant[0] for mutant in MUTANTS}
    if unknown:
        sys.exit(f"mutants: no such mutant: {', '.join(sorted(unknown))}")
    missed = []
    print(f"{'mutant':26} {'caught':7} {'triangles':9} by")
    for name, file, old, new in MUTANTS:
        if sys.argv[1:] and name not in sys.argv[1:]:
            continue
        refresh_copy()
        text = broken(name, file, old, new, WORK / "src")
        (WORK / "src" / file).write_text(text)
        build()
        status, triangles, failed = certify(name)
        caught = status == 1 and triangles is not None and triangles <= 2
        if not caught:
            missed.append(name)
        by = ", ".join(failed[:4]) + (f" and {len(failed) - 4} more" if len(failed) > 4 else "")
        print(f"{name:26} {'yes' if caught else f'NO, {status}':7} {triangles if triangles is not None else '-'!s:9} {by}",
              flush=True)
    print(f"not caught: {', '.join(missed)}" if missed else "all caught")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
