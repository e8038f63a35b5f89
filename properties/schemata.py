#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Mutates the engine's sources mechanically and expects the suite to kill every mutant.

All mutants are compiled into one program (properties/schemata/mutant.hpp) and chosen by number at run time. The suite is
every check of `surefill certify` but the large meshes. A mutant's run stops at its first kill, or after --seconds; a mutant
that changes nothing that can be seen is explained in properties/schemata/equivalent.txt. Results are kept in
build/schemata/results.txt: an interrupted run goes on, and shards may be run apart and their files put together.

usage: properties/schemata.py [--seconds S] [--shard I/N] [--jobs N] [--only FILE] [--list]
Exit 0 if every mutant is killed or explained as equivalent, 1 if one is not, 2 if it cannot be built.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "schemata"
EQUIVALENT = ROOT / "properties/schemata/equivalent.txt"
# The reference path: what defines the engine's answers, and what the fast path falls back on.
FILES = ["arguments.cpp", "bounds.hpp", "conservative.hpp", "edge.hpp", "exact.hpp", "grid.cpp", "grid.hpp",
         "reference.cpp", "triangle.hpp", "viewport.cpp"]
SOURCES = ["arguments.cpp", "grid.cpp", "reference.cpp", "surefill.cpp", "viewport.cpp"]
COMPILER = [*(["ccache"] if shutil.which("ccache") else []), os.environ.get("CXX", "clang++-19")]
# What a mutant does must not be the optimizer's choice: variables that a dropped statement leaves unset are 0, and an index
# out of an array's bounds ends the process.
UNDEFINED = "bounds,float-cast-overflow,signed-integer-overflow,integer-divide-by-zero,shift"
DEFINED = ["-ftrivial-auto-var-init=zero", "-fstrict-flex-arrays=3", f"-fsanitize={UNDEFINED}", f"-fsanitize-trap={UNDEFINED}"]
FLAGS = ["-std=c++20", "-O2", "-ffp-contract=off", "-DSUREFILL_REFERENCE_ONLY", "-w",
         f'-DSUREFILL_MESHES="{ROOT}/corpus/meshes"', f'-DSUREFILL_CORPUS="{ROOT}/corpus"', f"-I{ROOT}",
         f"-I{ROOT}/engine/include", f"-I{ROOT}/properties/schemata", f"-I{WORK}/engine"]
CHECKS = ["argument_check.cpp", "checks.cpp", "contract_checks.cpp", "judge.cpp", "mesh.cpp", "mesh_checks.cpp"]

# SUREFILL_PLANT is false in the engine as it is shipped.
SKIPPED = re.compile(r"constexpr|static_assert|template|#|using |operator|requires|case |Statistics|\+\+statistics|if \(SUREFILL_PLANT")
PLANTED = re.compile(r"(?: \+ \()?SUREFILL_PLANT\(\w+\)(?:.* :(?: 0\))?|.*)")
OPERATOR = re.compile(r"(?<=[\w)\]]) (\+|-|\*|<|<=|>|>=|==|!=) (?=[\w(\-!&*])")
LITERAL = re.compile(r"(?<=[ (])(\d+)(?=[),;]| [-+*<>=?:])")
STATEMENT = re.compile(r"^(\s+)([a-z_]\w*(?:(?:\.|->|\[|\().*| [-+*|&]?= .*)|\+\+\w.*|break|continue);$")
RETURN = re.compile(r"^\s+return (true|false);$")
CONDITION = re.compile(r"^(\s*(?:\} else )?if) \((.*)\) (\{|return .*;|continue;|break;)$")


class Mutant:
    def __init__(self, file, line_number, line, kind, start, end, replacement):
        self.file, self.line_number, self.line, self.kind = file, line_number, line, kind
        self.start, self.end, self.replacement = start, end, replacement
        marked = line[:start] + "«" + line[start:end] + "»" + line[end:]
        self.name = f"{file}: {' '.join(marked.split())}"  # for ever, unless the line itself changes


def candidates(line):
    """(kind, start, end, replacement with {N}) of the mutants of one line."""
    code = re.sub(r'"[^"]*"', lambda m: "_" * len(m[0]), line).split("//")[0].rstrip()  # no mutants within texts
    code = PLANTED.sub(lambda m: "_" * len(m[0]), code)
    if SKIPPED.search(code) or not code.strip():
        return
    if not re.search(r"^\s*(?:const |static |inline )?[\w:<>]+[&*]? \w+\(.*\{$", code):  # the head of a function
        for m in OPERATOR.finditer(code):
            yield "operator", m.start(1), m.end(1), f"{m[1]} Marked<{{N}}>{{}} {m[1]}"
        for m in LITERAL.finditer(code):
            yield "literal", m.start(), m.end(), f"(surefill::mutant::alive<{{N}}>() ? {int(m[1]) + 1} : {m[1]})"
    m = CONDITION.match(code)
    if m and m[2].count("(") == m[2].count(")") and ";" not in m[2]:
        yield "negated", m.start(2), m.end(2), "surefill::mutant::alive<{N}>() != bool(" + m[2] + ")"
    m = STATEMENT.match(code)
    if m and not re.match(r"(const|auto|static|return) ", m[2]):
        yield "dropped", m.start(2), m.end(2), "if (!surefill::mutant::alive<{N}>()) " + m[2]
    m = RETURN.match(code)
    if m:
        yield "flipped", m.start(1), m.end(1), f"surefill::mutant::alive<{{N}}>() != {m[1]}"


def mutants():
    """All of them, in order."""
    everyone = [Mutant(file, n, line, *change) for file in FILES
                for n, line in enumerate((ROOT / "engine/src" / file).read_text().split("\n"), 1)
                for change in candidates(line)]
    times = Counter()
    for m in everyone:
        times[m.name] += 1
        if times[m.name] > 1:
            m.name += f" ({times[m.name]})"  # the same line again
    return everyone


def with_mutants(line, here):
    """The line with all of these (number, mutant) in it; those around a whole condition or statement hold the others."""
    for number, m in sorted(here, key=lambda pair: (pair[1].start, -pair[1].end), reverse=True):
        inner = line[m.start:len(line) - (len(m.line) - m.end)]  # what has become of it
        line = line[:m.start] + m.replacement.replace(m.line[m.start:m.end], inner, 1).replace(
            "{N}", str(number)) + line[m.start + len(inner):] if m.kind in ("negated", "dropped") else (
                line[:m.start] + m.replacement.replace("{N}", str(number)) + line[m.end:])
    return line


def write_sources(all_mutants, left_out):
    """The engine with all mutants but those on lines that do not compile. A line keeps its number."""
    for source in (ROOT / "engine/src").iterdir():
        if source.suffix not in (".cpp", ".hpp") or not source.is_file():
            continue
        text = source.read_text()
        if source.name in FILES:
            lines, on_line = text.split("\n"), {}
            for number, m in enumerate(all_mutants, 1):
                if m.file == source.name and number not in left_out:
                    on_line.setdefault(m.line_number, []).append((number, m))
            for n, here in on_line.items():
                lines[n - 1] = with_mutants(lines[n - 1], here)
            text = '#include "mutant.hpp"\n#line 1\n' + "\n".join(lines)
        path = WORK / "engine" / source.name
        if not path.is_file() or path.read_text() != text:
            path.write_text(text)


def compile_one(source, output, extra=()):
    return subprocess.run([*COMPILER, *FLAGS, *extra, "-c", source, "-o", output], capture_output=True, text=True)


def build(all_mutants, jobs):
    """Builds the program; returns the numbers of the mutants in it."""
    (WORK / "engine").mkdir(parents=True, exist_ok=True)
    left_out = set()
    while True:
        write_sources(all_mutants, left_out)
        errors = ""
        for source in SOURCES:
            result = compile_one(WORK / "engine" / source, WORK / (source + ".o"), [*DEFINED, "-ferror-limit=0"])
            errors += result.stderr if result.returncode else ""
        if not errors:
            break
        bad = {(name, int(n)) for name, n in re.findall(r"(?:^|/)([\w.]+):(\d+)(?::\d+)?:", errors, re.M)}
        more = {number for number, m in enumerate(all_mutants, 1) if (m.file, m.line_number) in bad} - left_out
        if not more:
            print(f"schemata: the engine does not build:\n{errors[:3000]}", file=sys.stderr)
            sys.exit(2)
        left_out |= more
    suite = [p for d in ("properties", "properties/zoo", "corpus", "oracle") for p in sorted((ROOT / d).glob("*.cpp"))
             if not p.name.endswith("_test.cpp")] + [ROOT / "certify" / name for name in CHECKS]
    suite.append(ROOT / "properties/schemata/run.cpp")
    objects = [WORK / (p.parent.name + "-" + p.name + ".o") for p in suite]

    def compile_suite(pair):
        # run.cpp has the engine's headers, too.
        extra = {"meshes.cpp": ["-fdelayed-template-parsing"], "run.cpp": DEFINED}.get(pair[0].name, [])
        return compile_one(*pair, extra)

    with ThreadPoolExecutor(jobs) as pool:
        for result in pool.map(compile_suite, zip(suite, objects)):
            if result.returncode:
                print(f"schemata: the suite does not build:\n{result.stderr[:3000]}", file=sys.stderr)
                sys.exit(2)
    link = subprocess.run([COMPILER[-1], *objects, *(WORK / (s + ".o") for s in SOURCES), "-o", WORK / "schemata", "-lfmt",
                           "-lgmpxx", "-lgmp", "-lmpfr", "-ltinyobjloader", "-lpthread"], capture_output=True, text=True)
    if link.returncode:
        print(f"schemata: the program does not link:\n{link.stderr[:3000]}", file=sys.stderr)
        sys.exit(2)
    return [number for number in range(1, len(all_mutants) + 1) if number not in left_out]


def equivalents(all_mutants):
    """The names of equivalent.txt: reasons begin with #, names follow. Each must be of a mutant."""
    names, explained, reason = {m.name for m in all_mutants}, set(), ""
    for line in EQUIVALENT.read_text().splitlines():
        if not line.strip():
            reason = ""
        elif line.startswith("#"):
            reason += line
        elif line not in names or not reason:
            print(f"schemata: equivalent.txt: {'no reason for' if line in names else 'no such mutant'}: {line}", file=sys.stderr)
            sys.exit(2)
        else:
            explained.add(line)
    return explained


def main():
    parser = argparse.ArgumentParser(description="Kills mutants of the engine")
    parser.add_argument("--seconds", type=float, default=20, help="that a mutant may live (20)")
    parser.add_argument("--shard", default="1/1", help="I/N: every Nth mutant, from the Ith")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only", default="", help="mutants whose name holds this text")
    parser.add_argument("--list", action="store_true", help="show the mutants, run none")
    arguments = parser.parse_args()
    everyone = mutants()
    explained = equivalents(everyone)
    if arguments.list:
        for number, m in enumerate(everyone, 1):
            print(f"{number} {m.name}{' (equivalent)' if m.name in explained else ''}")
        return 0
    index, count = map(int, arguments.shard.split("/"))
    mine = [n for n in build(everyone, arguments.jobs) if n % count == index % count and arguments.only in everyone[n - 1].name]
    results_file = WORK / "results.txt"
    results = dict(line.rsplit("\t", 1) for line in results_file.read_text().splitlines()) if results_file.is_file() else {}
    killed = lambda n: results.get(everyone[n - 1].name, "").startswith("killed")
    program = [str(WORK / "schemata"), str(arguments.seconds)]
    if subprocess.run([*program[:1], "5", "0"], capture_output=True, text=True).stdout.split()[1:2] != ["survived"]:
        print("schemata: the engine without a mutant is killed", file=sys.stderr)
        return 2

    def run(numbers):
        if not numbers:
            return
        with subprocess.Popen([*program, *map(str, numbers)], stdout=subprocess.PIPE, text=True) as process:
            for line in process.stdout:
                number, outcome, by = line.split()
                m = everyone[int(number) - 1]
                results[m.name] = f"{outcome} {by}"
                print(f"{m.name}\t{outcome} {by}", file=out, flush=True)
                if outcome != "killed" and m.name not in explained:
                    print(f"survived: {m.name}", flush=True)

    # One that is explained, and has outlived the suite once, need not do so again.
    wanted = [n for n in mine if not killed(n) and not (everyone[n - 1].name in explained and everyone[n - 1].name in results)]
    with ThreadPoolExecutor(arguments.jobs) as pool, open(results_file, "a") as out:
        list(pool.map(run, [wanted[i::arguments.jobs] for i in range(arguments.jobs)]))
    wrong = [n for n in mine if killed(n) and everyone[n - 1].name in explained]
    for n in wrong:
        print(f"not equivalent, {results[everyone[n - 1].name]}: {everyone[n - 1].name}")
    dead = sum(map(killed, mine))
    equal = sum(not killed(n) and everyone[n - 1].name in explained for n in mine)
    survivors = len(mine) - dead - equal
    print(f"{len(mine)} mutants, {dead} killed, {equal} explained as equivalent, {survivors} unexplained survivors")
    return 1 if survivors or wrong else 0


if __name__ == "__main__":
    sys.exit(main())
