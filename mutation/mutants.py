#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Breaks a copy of the engine, one planted fault at a time (faults.py), and expects `surefill certify` to notice each: exit
status 1 and a reduced scene of at most two triangles on which broken engine and oracle differ. A check that cannot fail is a
defect.

usage: mutation/mutants.py [NAME ...]     (default: all that certify must notice)
Exit 0 if every fault is caught, 1 if one is not, 2 if one cannot be built. Works in build/mutants.
"""
import json
import subprocess
import sys

import faults

ROOT = faults.ROOT
WORK = ROOT / "build" / "mutants"


def build():
    WORK.mkdir(parents=True, exist_ok=True)
    with open(WORK / "log", "w") as log:
        for command in (["cmake", "-S", WORK / "src", "-B", WORK / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"],
                        ["cmake", "--build", WORK / "build", "--target", "surefill_command"]):
            if subprocess.run(command, stdout=log, stderr=subprocess.STDOUT).returncode != 0:
                print(f"mutants: the build failed, see {WORK / 'log'}", file=sys.stderr)
                sys.exit(2)


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


def main():
    chosen = faults.named(sys.argv[1:], certify=True)
    missed = []
    print(f"{'fault':26} {'caught':7} {'triangles':9} by")
    for fault in chosen:
        name = fault.name
        faults.plant(fault, WORK / "src")
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
