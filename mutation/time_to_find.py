#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How soon the fuzzers find planted faults (faults.py): CPU seconds until the first finding, the median over seeds, each run
capped. Without the corpus: every run begins with one plain input, or the seeds would find most at once.

usage: mutation/time_to_find.py [--seeds 3] [--cap 60] [--engine ENGINE ...] [--jobs N] [--markdown FILE] [FAULT ...]

Works in build/time-to-find: a copy of the tree gets one fault at a time, and the target that is to find it is built of it, for
libFuzzer (address and undefined sanitizers) and, for AFL++, without sanitizers. The engines: custom (libFuzzer with the
project's mutator and crossover), plain (libFuzzer's own mutator), afl (AFL++), seeded (custom, with the seeds of the
corpus). Exit 1 if `custom` leaves a fault unfound, 2 if one cannot be built.
"""
import argparse
import concurrent.futures
import os
import pathlib
import resource
import shutil
import statistics
import subprocess
import sys
import time

import faults

LONGEST = 3600  # seconds, by the clock; the cap is one of CPU time
ENGINES = ("custom", "plain", "afl", "seeded")

ROOT = faults.ROOT
WORK = ROOT / "build" / "time-to-find"


def build(kind, target):
    """Builds a target of the copy of the tree, for libFuzzer or AFL++; the folder of the programs."""
    directory = WORK / f"build-{kind}"
    compilers = ("afl-clang-fast", "afl-clang-fast++") if kind == "afl" else ("clang-19", "clang++-19")
    sanitizers = "" if kind == "afl" else "address,undefined"
    environment = dict(os.environ, AFL_QUIET="1")
    with open(WORK / f"build-{kind}.log", "w") as log:
        for command in (["cmake", "-S", WORK / "src", "-B", directory, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=RelWithDebInfo",
                         f"-DCMAKE_C_COMPILER={compilers[0]}", f"-DCMAKE_CXX_COMPILER={compilers[1]}",
                         f"-DSUREFILL_SANITIZE={sanitizers}", "-DSUREFILL_FUZZ=ON"],
                        ["cmake", "--build", directory, "--target", target]):
            if subprocess.run(command, stdout=log, stderr=subprocess.STDOUT, env=environment).returncode != 0:
                print(f"time_to_find: the build failed, see {log.name}", file=sys.stderr)
                sys.exit(2)
    return directory / "fuzz"


def build_all(chosen, engines):
    """For each fault and kind of engine, the target that is to find it, in WORK/programs; the seeds of the sound engine."""
    kinds = sorted({"afl" if engine == "afl" else "libfuzzer" for engine in engines})
    shutil.rmtree(WORK / "programs", ignore_errors=True)
    (WORK / "programs").mkdir(parents=True)
    if "seeded" in engines:
        faults.refresh_copy(WORK / "src")
        shutil.copytree(build("libfuzzer", "surefill_fuzz") / "seeds", WORK / "programs" / "seeds")
    for fault in chosen:
        faults.plant(fault, WORK / "src")
        for kind in kinds:
            program = build(kind, f"{fault.target}_fuzz") / f"{fault.target}_fuzz"
            shutil.copy2(program, WORK / "programs" / f"{kind}-{fault.name}")


def plain_input(target):
    """What every run begins with."""
    if target == "reader":
        return (b"surefill-scene 1\ntarget 8 8\n\ndraw\n  vertex 1 1 0.5 1\n  vertex 7 2 0.5 1\n  vertex 3 6 0.5 1\n"
                b"  triangle 0 1 2\nend\n")
    return bytes(range(64)) * 2 if target == "arguments" else bytes(64)


def cpu_of_children(before):
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def run(task):
    """CPU seconds until the finding for each seed, or None. The rest of the seeds are left out once the median is known to
    be above the cap. One process a call, so that its children's time is its own."""
    engine, fault, seeds, cap = task
    times = []
    for seed in range(1, seeds + 1):
        if 2 * times.count(None) > seeds:
            times.append(None)
        else:
            times.append(run_seed(engine, fault, seed, cap))
    return times


def run_seed(engine, fault, seed, cap):
    target = fault.target
    work = WORK / f"{engine}-{fault.name}-{seed}"
    shutil.rmtree(work, ignore_errors=True)
    (work / "in").mkdir(parents=True)
    (work / "in" / "plain").write_bytes(plain_input(target))
    program = WORK / "programs" / f"{'afl' if engine == 'afl' else 'libfuzzer'}-{fault.name}"
    dictionary = ROOT / "fuzz" / f"{target}.dict"
    environment = dict(os.environ)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(work / "log", "w") as log:
        if engine == "afl":
            environment.update(AFL_SKIP_CPUFREQ="1", AFL_I_DONT_CARE_ABOUT_MISSING_CRASHES="1", AFL_NO_UI="1",
                               AFL_NO_AFFINITY="1", AFL_BENCH_UNTIL_CRASH="1", AFL_SKIP_CRASHES="1")
            command = ["afl-fuzz", "-i", work / "in", "-o", work / "out", "-s", str(seed), *(["-x", dictionary] if dictionary.is_file() else []), "-V", str(LONGEST), "--", program]
        else:
            if engine == "plain":
                environment["SUREFILL_FUZZ_PLAIN"] = "1"
            command = [program, f"-seed={seed}", f"-max_total_time={LONGEST}", "-detect_leaks=0", "-max_len=4096",
                       f"-artifact_prefix={work}/", *([f"-dict={dictionary}"] if dictionary.is_file() else []), work / "in"]
            if engine == "seeded":
                command.append(WORK / "programs" / "seeds" / target)
        process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, env=environment,
                                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (cap + 2, cap + 2)) if engine != "afl" else None)
        found = watch(process, cap, engine, work)
    return cpu_of_children(before) if found else None


def watch(process, cap, engine, work):
    """Waits for the process; stops it when it and its children have used the cap. Did it find the fault?"""
    ticks = os.sysconf("SC_CLK_TCK")
    while process.poll() is None:
        time.sleep(0.02)
        try:
            fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        except (FileNotFoundError, ProcessLookupError):
            break
        used = sum(int(fields[i]) for i in (11, 12, 13, 14)) / ticks
        if engine == "afl":  # the running child is not counted until it ends; it lives for the whole run
            children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
            for child in children:
                used += cpu_of_tree(child, ticks)
        if used > cap:
            process.terminate()
            process.wait()
            return False
    if engine == "afl":
        return any((work / "out").glob("*/crashes/id*"))
    return any(work.glob("crash-*"))


def cpu_of_tree(pid, ticks):
    try:
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
        children = pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    except (FileNotFoundError, ProcessLookupError):
        return 0
    return sum(int(fields[i]) for i in (11, 12, 13, 14)) / ticks + sum(cpu_of_tree(child, ticks) for child in children)


def text_of(times, cap):
    """The median, where a run that found nothing took longer than all others."""
    median = statistics.median(time if time is not None else float("inf") for time in times)
    return f"> {cap}" if median == float("inf") else f"{median:.1f}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--cap", type=int, default=60)
    parser.add_argument("--engine", action="append", choices=ENGINES)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--markdown", help="write the table there, too")
    parser.add_argument("fault", nargs="*")
    options = parser.parse_args()
    engines = options.engine or ["custom", "plain", "afl"]
    chosen = faults.named(options.fault)
    build_all(chosen, engines)
    tasks = [(engine, fault, options.seeds, options.cap) for fault in chosen for engine in engines]
    lines = [f"| fault | target | {' | '.join(engines)} |", f"| --- | --- |{' ---: |' * len(engines)}"]
    print("\n".join(lines), flush=True)
    unfound = []
    with concurrent.futures.ProcessPoolExecutor(options.jobs, max_tasks_per_child=1) as pool:
        results = pool.map(run, tasks)
        for fault in chosen:
            cells = []
            for engine in engines:
                cells.append(text_of(next(results), options.cap))
                if engine == "custom" and cells[-1].startswith(">"):
                    unfound.append(fault.name)
            lines.append(f"| {fault.what} (`{fault.name}`) | {fault.target} | {' | '.join(cells)} |")
            print(lines[-1], flush=True)
    if options.markdown:
        pathlib.Path(options.markdown).write_text("\n".join(lines) + "\n")
    if unfound:
        print(f"not found by custom: {', '.join(unfound)}", file=sys.stderr)
    return 1 if unfound else 0


if __name__ == "__main__":
    sys.exit(main())
