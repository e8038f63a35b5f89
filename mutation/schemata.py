#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Mutates the engine's sources mechanically and sees which mutants the suite kills.

All mutants of a path are compiled into one program (mutation/schemata/mutant.hpp, vector_mutant.hpp) and chosen by number
at run time. The suite is every check of `surefill certify` but the large meshes; against the fast path, the frames of
engine/tests/path_cases.hpp and the corpus, too. A mutant's run stops at its first kill, or after --seconds.

reference: every mutant is killed, or mutation/schemata/equivalent.txt says why it changes nothing that can be seen. Results
  are kept in build/schemata/reference/results.txt: an interrupted run goes on, and shards may be run apart and their files
  put together. Exit 0 if all are killed or explained, 1 if one is not.
fast: a probe of an hour. A sample is drawn by --seed; killed and not killed are counted, and those that live are named.
  Many of them change nothing but speed, and nobody keeps a list of those. Exit 0.

usage: mutation/schemata.py [--path reference|fast] [--seconds S] [--jobs N] [--only TEXT,...] [--list]
                            [--shard I/N]               (reference)
                            [--sample N] [--seed S]     (fast; 200 mutants, seed 1)
Exit 2 if the program cannot be built.
"""
import argparse
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parent.parent
ENGINE = ROOT / "engine/src"
SCHEMATA = ROOT / "mutation/schemata"
COMPILER = [*(["ccache"] if shutil.which("ccache") else []), os.environ.get("CXX", "clang++-19")]
# What a mutant does must not be the optimizer's choice: variables that a dropped statement leaves unset are 0, and an index
# out of an array's bounds ends the process.
UNDEFINED = "bounds,float-cast-overflow,signed-integer-overflow,integer-divide-by-zero,shift"
DEFINED = ["-ftrivial-auto-var-init=zero", "-fstrict-flex-arrays=3", f"-fsanitize={UNDEFINED}", f"-fsanitize-trap={UNDEFINED}"]
FLAGS = ["-std=c++20", "-O2", "-ffp-contract=off", "-w", f'-DSUREFILL_CORPUS="{ROOT}/corpus"',
         f"-I{ROOT}", f"-I{ROOT}/engine/include", f"-I{SCHEMATA}"]
# What the suite is made of: all of these folders, without their tests, and the checks of certify.
FOLDERS = ["properties/machinery", "properties/generators", "properties/theorems", "corpus", "oracle", "engine/tests"]
CHECKS = ["argument_check.cpp", "checks.cpp", "contract_checks.cpp", "judge.cpp", "mesh_checks.cpp"]
LIBRARIES = ["-lfmt", "-lgmpxx", "-lgmp", "-lmpfr", "-ltinyobjloader", "-lpthread"]

SKIPPED = re.compile(r"constexpr|static_assert|template|#|using |operator|requires|case |Statistics|Rungs|Diagnostics|count\(rungs")
OPERATOR = re.compile(r"(?<=[\w)\]]) (\+|-|\*|<|<=|>|>=|==|!=) (?=[\w(\-!&*])")
LITERAL = re.compile(r"(?<=[ (])(\d+)()(?=[),;]| [-+*<>=?:])")
STATEMENT = re.compile(r"^(\s+)([a-z_]\w*(?:(?:\.|->|\[|\().*| [-+*|&]?= .*)|\+\+\w.*|break|continue);$")
RETURN = re.compile(r"^\s+return (true|false);$")
CONDITION = re.compile(r"^(\s*(?:\} else )?if) \((.*)\) (\{|return .*;|continue;|break;)$")

# The fast path has bit sets, wider literals and statements of several lines, and calls that stand for vector operations.
FAST_OPERATOR = re.compile(r"(?<=[\w)\]]) (\+|-|\*|<|<=|>|>=|==|!=|&|\||<<|>>) (?!nullptr)(?=[\w(\-!&*~])")
FAST_LITERAL = re.compile(r"(?<=[ (\[~])(\d+)(\.0f?|u|)(?=[),;\]}]| [-+*/<>=?:&|%])")
FAST_STATEMENT = re.compile(r"^(\s+)((?:[a-z_]\w*(?:\.|->|\[|\(| [-+*|&]?= )|\+\+\w|[A-Z]\w*(?:<\w+>)?\((?!\))|hn::\w*Store\().*"
                            r"|break;|continue;)$")
LOGIC = re.compile(r"(?<=[\w)\]]) (&&|\|\|)(?= |$)")
ARRAY = re.compile(r"^\s*(?:alignas\([^=;]*|(?:const )?[\w:]+(?:<[\w()]+>)?(?: \*?const|\*)? (?:\w+(?: = \w+)?, )*\w+\[[^=;]*)|\(&\w+\)\[\d\]")
VECTOR = re.compile(r"\bhn::(\w+)(?:<(\d+)>)?(?=\()")
VECTOR_MUTANTS = set("Abs Add AllFalse And AndNot Ceil Combine Div Eq Floor Ge Gt IfThenElse IfThenElseZero IfThenZeroElse "
                     "InterleaveLower InterleaveUpper Le Lt Max MaxOfLanes Min MinOfLanes Mul Ne Neg Not Or Round ShiftLeft "
                     "Sub Xor".split())
COUNTERS = re.compile(r"(?:values|signs)_by_\w+ \+=")  # how many values each rung has settled: nothing is drawn by them


class Path:
    """A path through the engine: what is mutated, and how it is built."""

    def __init__(self, name, files, sources, flags):
        self.name, self.files, self.sources = name, files, sources
        self.work = ROOT / "build/schemata" / name
        self.flags = [*FLAGS, *flags]
        self.fast = name == "fast"
        self.active = {}  # of each file, the lines that the compiler sees


ALWAYS = ["arguments.cpp", "build_check.cpp", "exact/exact_draw.cpp", "exact/grid.cpp", "exact/line.cpp", "exact/occluder.cpp",
          "fast/draw_patches.cpp", "fragments.cpp", "occluder_mesh.cpp", "occlusion.cpp", "patches.cpp", "reference.cpp",
          "safe_occlusion.cpp", "statistics.cpp", "surefill.cpp", "viewport.cpp"]
VECTOR_FILES = sorted(f"fast/{p.name}" for p in (ENGINE / "fast").glob("*-inl.hpp"))
PATHS = {
    # What defines the engine's answers, and what the fast path falls back on.
    "reference": Path("reference", ["arguments.cpp", "exact/bounds.hpp", "exact/conservative.hpp", "exact/edge.hpp", "exact/exact.hpp",
                                    "exact/exact_draw.cpp", "exact/exact_draw.hpp", "exact/grid.cpp", "exact/grid.hpp", "exact/line.cpp",
                                    "exact/line.hpp", "exact/point.hpp", "exact/approximation.hpp",
                                    "exact/triangle.hpp", "facts.hpp", "fragments.cpp", "fragments.hpp", "overlap.hpp", "reference.cpp", "statistics.cpp",
                                    "viewport.cpp"],
                      ALWAYS,
                      ["-DSUREFILL_REFERENCE_ONLY"]),
    # The vector code for one instruction set whose vectors do not hold a whole cell, so that each loop is one.
    "fast": Path("fast", [*VECTOR_FILES, *(f"fast/{name}" for name in ("culling.hpp", "frame.cpp", "lists.hpp", "record.hpp", "store.hpp", "team.hpp", "tile.hpp"))],
                 [*ALWAYS, "lines.cpp", "streamed.cpp", "fast/frame.cpp", "fast/kernels.cpp"],
                 ["-DHWY_COMPILE_ONLY_STATIC", "-march=x86-64-v3", "-maes", "-mpclmul"]),
}


class Mutant:
    def __init__(self, file, line_number, line, kind, start, end, replacement):
        self.file, self.line_number, self.line, self.kind = file, line_number, line, kind
        self.start, self.end, self.replacement = start, end, replacement
        marked = line[:start] + "«" + line[start:end] + "»" + line[end:]
        self.name = f"{os.path.basename(file)}: {' '.join(marked.split())}"  # for ever, unless the line itself changes
        self.function = ""


ALIVE = "surefill::mutant::alive<{N}>()"


def candidates(line, fast, begins):
    """(kind, start, end, replacement with {N}) of the mutants of one line. begins: a statement may begin with it."""
    code = re.sub(r'"[^"]*"', lambda m: "_" * len(m[0]), line).split("//")[0].rstrip()  # no mutants within texts
    if SKIPPED.search(code) or not code.strip() or fast and COUNTERS.search(code):
        return
    if fast:  # sizes and alignments are constants of the compiler
        code = ARRAY.sub(lambda m: "_" * len(m[0]), code)
    if not re.search(r"^\s*(?:const |static |inline )?[\w:<>]+[&*]? \w+\(.*\{$", code):  # the head of a function
        for m in (FAST_OPERATOR if fast else OPERATOR).finditer(code):
            yield "operator", m.start(1), m.end(1), f"{m[1]} Marked<{{N}}>{{}} {m[1]}"
        for m in (FAST_LITERAL if fast else LITERAL).finditer(code):
            yield "literal", m.start(), m.end(), f"({ALIVE} ? {int(m[1]) + 1}{m[2]} : {m[0]})"
    if fast:
        for m in LOGIC.finditer(code):
            yield "logic", m.start(1), m.end(1), f"{m[1]} {'!' if m[1] == '&&' else ''}{ALIVE} {m[1]}"
        for m in VECTOR.finditer(code):
            if m[1] in VECTOR_MUTANTS:
                yield "vector", m.start(), m.end(), f"surefill::mutant::{m[1]}<{{N}}{', ' + m[2] if m[2] else ''}>"
    m = CONDITION.match(code)
    if m and ";" not in m[2] and " = " not in m[2]:
        depth = end = 0
        for end, letter in enumerate(m[2]):
            depth += (letter == "(") - (letter == ")")
            if depth < 0:
                break
        end = m.start(2) + end + (depth == 0)
        yield "negated", m.start(2), end, f"{ALIVE} != bool({line[m.start(2):end]})"
    m = (FAST_STATEMENT if fast else STATEMENT).match(code)
    if m and begins and not re.match(r"(const|auto|static|return|if|for|while|switch) ", m[2]):
        end = m.end(2) - (m[2][-1] == ";")
        yield "dropped", m.start(2), end, f"if (!{ALIVE}) " + line[m.start(2):end]
    m = RETURN.match(code)
    if m:
        yield "flipped", m.start(1), m.end(1), f"{ALIVE} != {m[1]}"


def find_active(path):
    """Which lines of the sources the compiler sees, for this instruction set."""
    for source in path.sources:
        file, number = "", 0
        result = run_compiler(path, [f"-I{ENGINE}", "-E", ENGINE / source])
        if result.returncode:
            fail(f"{source} is not preprocessed by {COMPILER[-1]}:\n{result.stderr[:3000]}")
        for line in result.stdout.splitlines():
            marker = re.match(r'# (\d+) "(.*)"', line)
            if marker:
                file, number = marker[2].rpartition("/engine/src/")[2] if "/engine/src/" in marker[2] else "", int(marker[1])
                continue
            if line.strip() and file:
                path.active.setdefault(file, set()).add(number)
            number += 1


def mutants(path):
    """All of them, in order."""
    find_active(path)
    everyone = []
    for file in path.files:
        before, function = ";", ""
        for n, line in enumerate((ENGINE / file).read_text().split("\n"), 1):
            code = line.split("//")[0].rstrip()
            head = re.match(r"(?:  )?(?:[A-Za-z_][\w:<>&*, ]* )?[&*~]?(\w+)\(", code)
            if head and not code.endswith(";"):
                function = head[1]
            if n in path.active.get(file, ()):
                for change in candidates(line, path.fast, not path.fast or before[-1] in ";{})"):
                    everyone.append(Mutant(file, n, line, *change))
                    everyone[-1].function = function
            before = code or before
    times = Counter()
    for m in everyone:
        times[m.name] += 1
        if times[m.name] > 1:
            m.name += f" ({times[m.name]})"  # the same line again
    return everyone


def with_mutants(line, here):
    """The line with all of these (number, mutant) in it; those around a whole condition or statement hold the others."""
    def part(start, end, inside):
        text, at = "", start
        while inside:
            number, m = min(inside, key=lambda pair: (pair[1].start, -pair[1].end))
            within = [pair for pair in inside if pair[1].end <= m.end and pair[1] is not m]
            inside = [pair for pair in inside if pair[1].end > m.end]
            replacement = m.replacement
            if m.kind in ("negated", "dropped"):
                replacement = replacement.replace(line[m.start:m.end], part(m.start, m.end, within), 1)
            text += line[at:m.start] + replacement.replace("{N}", str(number))
            at = m.end
        return text + line[at:end]

    return part(0, len(line), here)


def write_sources(path, all_mutants, left_out):
    """The engine with all mutants but those on lines that do not compile. A line keeps its number."""
    for source in ENGINE.rglob("*.[ch]pp"):
        name, text = source.relative_to(ENGINE).as_posix(), source.read_text()
        if name in path.files:
            lines, on_line = text.split("\n"), {}
            for number, m in enumerate(all_mutants, 1):
                if m.file == name and number not in left_out:
                    on_line.setdefault(m.line_number, []).append((number, m))
            for n, here in on_line.items():
                lines[n - 1] = with_mutants(lines[n - 1], here)
            header = "vector_mutant.hpp" if "-inl" in name else "mutant.hpp"
            text = f'#include "{header}"\n#line 1\n' + "\n".join(lines)
        copy = path.work / "engine" / name
        copy.parent.mkdir(parents=True, exist_ok=True)
        if not copy.is_file() or copy.read_text() != text:
            copy.write_text(text)


def run_compiler(path, arguments):
    try:
        return subprocess.run([*COMPILER, *path.flags, *arguments], capture_output=True, text=True)
    except FileNotFoundError:
        fail(f"no compiler {COMPILER[-1]} (CXX names another)")


def object_of(path, source):
    return path.work / (source.replace("/", "-") + ".o")


def compile_engine(path, source, only_check):
    """With a sanitizer for accesses to memory, where there are pointers to go wrong."""
    address = ["-fsanitize=address"] if path.fast and source in path.files + ["fast/kernels.cpp"] else []
    output = ["-fsyntax-only"] if only_check else ["-o", object_of(path, source)]
    return run_compiler(path, [f"-I{path.work}/engine", *DEFINED, *address, "-ferror-limit=0", "-c",
                               path.work / "engine" / source, *output])


def build(path, all_mutants, jobs):
    """Builds the program; returns the numbers of the mutants in it."""
    left_out = set()
    while True:
        write_sources(path, all_mutants, left_out)
        with ThreadPoolExecutor(jobs) as pool:
            results = list(pool.map(lambda source: compile_engine(path, source, True), path.sources))
        errors = "".join(result.stderr for result in results if result.returncode)
        if not errors:
            break
        # One error may lead to others on lines that are innocent.
        for what in (r"(?!.*(?:no member named|undeclared|no matching|expected '\)')).* error: ", ""):
            bad = {(name, int(n)) for name, n in re.findall(r"/engine/((?:\w+/)?[\w.-]+):(\d+)(?::\d+)?:" + what, errors)}
            more = {number for number, m in enumerate(all_mutants, 1) if (m.file, m.line_number) in bad} - left_out
            if more:
                break
        if not more:
            fail(f"the engine does not build:\n{errors[:3000]}")
        left_out |= more
    suite = [p for folder in FOLDERS for p in sorted((ROOT / folder).glob("*.cpp")) if not p.name.endswith("_test.cpp")]
    suite += [ROOT / "certify/run" / name for name in CHECKS]
    suite.append(SCHEMATA / "run.cpp")
    objects = [path.work / (p.parent.name + "-" + p.name + ".o") for p in suite]

    def compile_suite(pair):
        # run.cpp has the engine's headers, too.
        extra = {"meshes.cpp": ["-fdelayed-template-parsing"], "run.cpp": DEFINED}.get(pair[0].name, [])
        return run_compiler(path, [f"-I{path.work}/engine", *extra, "-c", pair[0], "-o", pair[1]])

    with ThreadPoolExecutor(jobs) as pool:
        results = list(pool.map(lambda source: compile_engine(path, source, False), path.sources))
        results += pool.map(compile_suite, zip(suite, objects))
    for result in results:
        if result.returncode:
            fail(f"the suite does not build:\n{result.stderr[:3000]}")
    link = subprocess.run([COMPILER[-1], *(["-fsanitize=address"] if path.fast else []), *objects,
                           *(object_of(path, source) for source in path.sources), "-o", path.work / "schemata", *LIBRARIES],
                          capture_output=True, text=True)
    if link.returncode:
        fail(f"the program does not link:\n{link.stderr[:3000]}")
    return [number for number in range(1, len(all_mutants) + 1) if number not in left_out]


def fail(text):
    print(f"schemata: {text}", file=sys.stderr)
    sys.exit(2)


def equivalents(all_mutants):
    """The names that are explained: reasons begin with #, names follow, or `FILE: all of FUNCTION()`. Also those among them
    that stand there by their own names."""
    names, functions = {m.name for m in all_mutants}, {}
    for m in all_mutants:
        functions.setdefault(f"{os.path.basename(m.file)}: all of {m.function}()", set()).add(m.name)
    explained, by_name, reason = set(), set(), ""
    for line in (SCHEMATA / "equivalent.txt").read_text().splitlines():
        if not line.strip():
            reason = ""
        elif line.startswith("#"):
            reason += line
        elif not reason or line not in names and line not in functions:
            fail(f"equivalent.txt: {'no reason for' if reason == '' else 'no such mutant'}: {line}")
        elif line in functions:
            explained |= functions[line]
        else:
            by_name.add(line)
    return explained | by_name, by_name


def run_program(path, everyone, numbers, arguments, tell):
    """Has the suite meet these mutants, and calls tell(mutant, outcome, by whom) as each is done."""
    program = [str(path.work / "schemata"), str(arguments.seconds)]
    if subprocess.run([*program[:1], "5", "0"], capture_output=True, text=True).stdout.split()[1:2] != ["survived"]:
        fail("the engine without a mutant is killed")

    def run(share):
        if not share:
            return
        with subprocess.Popen([*program, *map(str, share)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              text=True) as process:
            for line in process.stdout:
                number, outcome, by = line.split()
                tell(everyone[int(number) - 1], outcome, by)

    with ThreadPoolExecutor(arguments.jobs) as pool:
        list(pool.map(run, [numbers[i::arguments.jobs] for i in range(arguments.jobs)]))


def wanted_by(arguments):
    """Whether a mutant is one of those that --only names."""
    texts = arguments.only.split(",")
    return lambda m: any(text in m.name for text in texts)


def run_reference(path, everyone, arguments):
    explained, by_name = equivalents(everyone)
    if arguments.list:
        for number, m in enumerate(everyone, 1):
            print(f"{number} {m.name}{' (equivalent)' if m.name in explained else ''}")
        return 0
    index, count = map(int, arguments.shard.split("/"))
    in_program = build(path, everyone, arguments.jobs)
    mine = [n for n in in_program if n % count == index % count and wanted_by(arguments)(everyone[n - 1])]
    results_file = path.work / "results.txt"
    results = dict(line.rsplit("\t", 1) for line in results_file.read_text().splitlines()) if results_file.is_file() else {}
    killed = lambda n: results.get(everyone[n - 1].name, "").startswith("killed")
    # One that is explained, and has outlived the suite once, need not do so again.
    wanted = [n for n in mine if not killed(n) and not (everyone[n - 1].name in explained and everyone[n - 1].name in results)]
    with open(results_file, "a") as out:
        def tell(m, outcome, by):
            results[m.name] = f"{outcome} {by}"
            print(f"{m.name}\t{outcome} {by}", file=out, flush=True)
            if outcome != "killed" and m.name not in explained:
                print(f"survived: {m.name}", flush=True)

        run_program(path, everyone, wanted, arguments, tell)
    wrong = [n for n in mine if killed(n) and everyone[n - 1].name in by_name]
    for n in wrong:
        print(f"not equivalent, {results[everyone[n - 1].name]}: {everyone[n - 1].name}")
    dead = sum(map(killed, mine))
    equal = sum(not killed(n) and everyone[n - 1].name in explained for n in mine)
    survivors = len(mine) - dead - equal
    print(f"reference path: {len(mine)} mutants, {dead} killed, {equal} explained as equivalent, "
          f"{survivors} unexplained survivors", flush=True)
    return 1 if survivors or wrong else 0


def run_fast(path, everyone, arguments):
    if arguments.list:
        for number, m in enumerate(everyone, 1):
            print(f"{number} {m.name}")
        return 0
    in_program = [n for n in build(path, everyone, arguments.jobs) if wanted_by(arguments)(everyone[n - 1])]
    sample = sorted(random.Random(arguments.seed).sample(in_program, min(arguments.sample, len(in_program))))
    outcomes = Counter()

    def tell(m, outcome, by):
        outcomes[outcome == "killed"] += 1
        if outcome != "killed":
            print(f"not killed: {m.name}", flush=True)

    run_program(path, everyone, sample, arguments, tell)
    print(f"fast path, sampled, {len(sample)} of {len(in_program)} mutants, seed {arguments.seed}: {outcomes[True]} killed, "
          f"{outcomes[False]} not killed within {arguments.seconds:g} s", flush=True)
    return 0


def run_path(path, arguments):
    return (run_fast if path.fast else run_reference)(path, mutants(path), arguments)


def main():
    parser = argparse.ArgumentParser(description="Sees which mutants of the engine the suite kills")
    parser.add_argument("--path", choices=PATHS, help="of the engine (both)")
    parser.add_argument("--seconds", type=float, default=20, help="that a mutant may live (20)")
    parser.add_argument("--shard", default="1/1", help="I/N: of the reference path every Nth mutant, from the Ith")
    parser.add_argument("--sample", type=int, default=200, help="so many mutants of the fast path (200)")
    parser.add_argument("--seed", type=int, default=1, help="that draws the sample (1)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only", default="", help="mutants whose name holds this text, or one of several with commas between")
    parser.add_argument("--list", action="store_true", help="show the mutants, run none")
    arguments = parser.parse_args()
    return max(run_path(PATHS[name], arguments) for name in ([arguments.path] if arguments.path else PATHS))


if __name__ == "__main__":
    sys.exit(main())
