#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Mutates the engine's sources mechanically and expects the suite to kill every mutant.

All mutants are compiled into one program (properties/schemata/mutant.hpp) and chosen by number at run time. A mutant's run
stops at its first kill, or after --seconds. Results are kept in build/schemata/results.txt: an interrupted run goes on,
and shards may be run apart and their files put together.

usage: properties/schemata.py [--seconds S] [--shard I/N] [--jobs N] [--list]
Exit 0 if every mutant is killed or explained as equivalent, 1 if one is not, 2 if it cannot be built.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "schemata"
# The reference path: what defines the engine's answers, and what the fast path falls back on.
FILES = ["bounds.hpp", "conservative.hpp", "edge.hpp", "exact.hpp", "grid.cpp", "grid.hpp", "reference.cpp", "triangle.hpp",
         "viewport.cpp"]
SOURCES = ["arguments.cpp", "grid.cpp", "reference.cpp", "surefill.cpp", "viewport.cpp"]
COMPILER = os.environ.get("CXX", "clang++-19")
FLAGS = ["-std=c++20", "-O2", "-ffp-contract=off", "-DSUREFILL_REFERENCE_ONLY", "-w",
         f'-DSUREFILL_MESHES="{ROOT}/corpus/meshes"', f"-I{ROOT}", f"-I{ROOT}/engine/include",
         f"-I{ROOT}/properties/schemata", f"-I{WORK}/engine"]

# Mutants that change nothing that can be seen: (file, part of the line, kind, why).
EQUIVALENT = []

SKIPPED = re.compile(r"constexpr|static_assert|template|#|using |operator|requires|case |Statistics|statistics")
OPERATOR = re.compile(r"(?<=[\w)\]]) (\+|-|\*|<|<=|>|>=|==|!=) (?=[\w(\-!&*])")
LITERAL = re.compile(r"(?<=[ (])(\d+)(?=[),;]| [-+*<>=?:])")
STATEMENT = re.compile(r"^(\s+)([a-z_]\w*(?:(?:\.|->|\[|\().*| [-+*|&]?= .*)|\+\+\w.*|return (?:true|false)|break|continue);$")
CONDITION = re.compile(r"^(\s*(?:\} else )?if) \((.*)\) (\{|return .*;|continue;|break;)$")


def candidates(file, number, line):
    """(kind, start, end, replacement with {N}) of the mutants of one line."""
    code = line.split("//")[0].rstrip()
    if SKIPPED.search(code) or not code.strip():
        return
    if not re.search(r"^\s*(?:const |static |inline )?[\w:<>]+[&*]? \w+\(.*\{$", code):  # the head of a function
        for m in OPERATOR.finditer(code):
            yield f"operator {m[1]}", m.start(), m.end(), f" {m[1]} Marked<{{N}}>{{}} {m[1]} "
        for m in LITERAL.finditer(code):
            yield f"literal {m[1]}", m.start(), m.end(), f"(surefill::mutant::alive<{{N}}>() ? {int(m[1]) + 1} : {m[1]})"
    m = CONDITION.match(code)
    if m and m[2].count("(") == m[2].count(")") and ";" not in m[2]:
        yield "negated", m.start(2), m.start(2), "surefill::mutant::alive<{N}>() != bool("
    m = STATEMENT.match(code)
    if m and not re.match(r"(const|auto|static|return \w)", m[2]) or (m and m[2] in ("return true", "return false")):
        yield "dropped", m.start(2), m.start(2), "if (!surefill::mutant::alive<{N}>()) "


def mutants():
    """All of them, in order: (file, line number, line, kind, start, end, replacement)."""
    return [(file, n, line, *change) for file in FILES
            for n, line in enumerate((ROOT / "engine/src" / file).read_text().split("\n"), 1)
            for change in candidates(file, n, line)]


def write_sources(all_mutants, left_out):
    """The engine with all mutants but those on lines that do not compile. A line keeps its number."""
    for source in (ROOT / "engine/src").iterdir():
        if source.suffix in (".cpp", ".hpp") and source.is_file():
            text = source.read_text()
            if source.name in FILES:
                lines = text.split("\n")
                for number, (file, n, line, kind, start, end, new) in reversed(list(enumerate(all_mutants, 1))):
                    if file != source.name or number in left_out:
                        continue
                    old = lines[n - 1]
                    if kind == "negated":  # its end first: the closing parenthesis of the condition
                        close = len(old) - (len(line) - CONDITION.match(line.split("//")[0].rstrip()).end(2))
                        old = old[:close] + ")" + old[close:]
                    lines[n - 1] = old[:start] + new.replace("{N}", str(number)) + old[end:]
                text = '#include "mutant.hpp"\n#line 1\n' + "\n".join(lines)
            path = WORK / "engine" / source.name
            if not path.is_file() or path.read_text() != text:
                path.write_text(text)


def compile_one(source, output, extra=()):
    return subprocess.run([COMPILER, *FLAGS, *extra, "-c", source, "-o", output], capture_output=True, text=True)


def build(all_mutants, jobs):
    """Builds the program; returns the numbers of the mutants in it."""
    (WORK / "engine").mkdir(parents=True, exist_ok=True)
    left_out = set()
    while True:
        write_sources(all_mutants, left_out)
        errors = ""
        for source in SOURCES:
            result = compile_one(WORK / "engine" / source, WORK / (source + ".o"), ["-ferror-limit=0"])
            errors += result.stderr if result.returncode else ""
        if not errors:
            break
        bad = {(name, int(n)) for name, n in re.findall(r"(?:^|/)([\w.]+):(\d+)(?::\d+)?:", errors, re.M)}
        more = {number for number, m in enumerate(all_mutants, 1) if (m[0], m[1]) in bad} - left_out
        if not more:
            sys.exit(f"schemata: the engine does not build:\n{errors[:3000]}")
        left_out |= more
    suite = [p for d in ("properties", "properties/zoo", "corpus", "oracle") for p in sorted((ROOT / d).glob("*.cpp"))
             if not p.name.endswith("_test.cpp")] + [ROOT / "properties/schemata/run.cpp"]
    objects = [WORK / (p.parent.name + "-" + p.name + ".o") for p in suite]

    def stale(pair):
        source, output = pair
        if output.is_file() and output.stat().st_mtime > source.stat().st_mtime and source.name != "run.cpp":
            return None
        extra = ["-fdelayed-template-parsing"] if source.name == "meshes.cpp" and "clang" in COMPILER else []
        return compile_one(source, output, extra)

    with ThreadPoolExecutor(jobs) as pool:
        for result in pool.map(stale, zip(suite, objects)):
            if result is not None and result.returncode:
                sys.exit(f"schemata: the suite does not build:\n{result.stderr[:3000]}")
    link = subprocess.run([COMPILER, *objects, *(WORK / (s + ".o") for s in SOURCES), "-o", WORK / "schemata", "-lgmpxx", "-lgmp",
                           "-lmpfr", "-ltinyobjloader", "-lpthread"], capture_output=True, text=True)
    if link.returncode:
        sys.exit(f"schemata: the program does not link:\n{link.stderr[:3000]}")
    return [number for number in range(1, len(all_mutants) + 1) if number not in left_out]


def key(mutant):
    """Names a mutant for ever: its file, line, kind and place, but not its number."""
    return f"{mutant[0]}:{mutant[2].strip()}:{mutant[3]}:{mutant[4]}"


def main():
    parser = argparse.ArgumentParser(description="Kills mutants of the engine")
    parser.add_argument("--seconds", type=float, default=20, help="that a mutant may live (20)")
    parser.add_argument("--shard", default="1/1", help="I/N: every Nth mutant, from the Ith")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--list", action="store_true", help="show the mutants, run none")
    arguments = parser.parse_args()
    everyone = mutants()
    if arguments.list:
        for number, m in enumerate(everyone, 1):
            print(f"{number} {m[0]}:{m[1]} {m[3]}: {m[2].strip()}")
        return 0
    numbers = build(everyone, arguments.jobs)
    index, count = map(int, arguments.shard.split("/"))
    results_file = WORK / "results.txt"
    results = dict(line.rsplit("\t", 1) for line in results_file.read_text().splitlines()) if results_file.is_file() else {}
    wanted = [n for n in numbers if n % count == index % count and not results.get(key(everyone[n - 1]), "").startswith("killed")]
    if subprocess.run([WORK / "schemata", "5", "0"], capture_output=True, text=True).stdout.split()[1:2] != ["survived"]:
        sys.exit("schemata: the engine without a mutant is killed")

    def run(number):
        line = subprocess.run([WORK / "schemata", str(arguments.seconds), str(number)], capture_output=True, text=True).stdout
        return number, " ".join(line.split()[1:])

    with ThreadPoolExecutor(arguments.jobs) as pool, open(results_file, "a") as out:
        for number, outcome in pool.map(run, wanted):
            results[key(everyone[number - 1])] = outcome
            print(f"{key(everyone[number - 1])}\t{outcome}", file=out, flush=True)
            if not outcome.startswith("killed"):
                m = everyone[number - 1]
                print(f"survived: {m[0]}:{m[1]} {m[3]} at {m[4]}: {m[2].strip()}", flush=True)
    mine = [n for n in numbers if n % count == index % count]
    killed = sum(results.get(key(everyone[n - 1]), "").startswith("killed") for n in mine)
    explained = [n for n in mine if not results.get(key(everyone[n - 1]), "").startswith("killed") and any(
        everyone[n - 1][0] == f and part in everyone[n - 1][2] and everyone[n - 1][3] == kind for f, part, kind, why in EQUIVALENT)]
    survivors = len(mine) - killed - len(explained)
    print(f"{len(mine)} mutants, {killed} killed, {len(explained)} explained as equivalent, {survivors} unexplained survivors")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
