#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the benchmarks on one thread and on two, and prints what was reached beside what is wanted.

usage: table.py BENCHMARK FOLDER [--repetitions N] [--min-time SECONDS] [--reuse]

Depth is clipped in every row but "unclipped", in both rasterizers. Ratios of medians within one run, of one thread by processor time; the spread is half the distance of the quartiles, relative to the median. Everything
goes to FOLDER: one.json and two.json (Google Benchmark's), table.txt, table.json, table.svg. --reuse makes the table from
the runs that are there.
"""
import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys

WORKLOADS = ["W1", "W2", "W3", "W4", "W5", "W6"]
MESHES = ["knot/50000", "knot/1000000"]
COLUMNS = WORKLOADS + MESHES


def goals(*values):
    """Of each workload; the last is that of both meshes."""
    return dict(zip(COLUMNS, (*values, values[-1])))


def run(program, file, threads, options):
    environment = dict(os.environ, SUREFILL_BENCH_THREADS=str(threads),
                       LP_NUM_THREADS="0" if threads == 1 else str(threads))
    command = [program, f"--benchmark_out={file}", "--benchmark_out_format=json",
               f"--benchmark_repetitions={options.repetitions}", f"--benchmark_min_time={options.min_time}",
               "--benchmark_enable_random_interleaving=false", "--benchmark_display_aggregates_only=true"]
    show = sys.stderr if sys.stderr.isatty() else subprocess.DEVNULL
    subprocess.run(command, env=environment, check=True, stdout=show, stderr=subprocess.DEVNULL)


def read(file, clock):
    """name -> (median ms, spread) of all benchmarks that ran. clock: real_time, or cpu_time, which is that of the calling thread."""
    times = {}
    with open(file) as text:
        for row in json.load(text)["benchmarks"]:
            if row.get("run_type") == "iteration" and "error_occurred" not in row:
                times.setdefault(row["name"].removesuffix("/real_time"), []).append(row[clock])
    result = {}
    for name, values in times.items():
        middle = statistics.median(values)
        quartiles = statistics.quantiles(values, n=4) if len(values) > 1 else [middle] * 3
        result[name] = (middle, (quartiles[2] - quartiles[0]) / 2 / middle)
    return result


def rows(one, one_on_wall, two):
    """(what, must, wanted, column -> reached, column -> holds) of the table; a row without goals always holds."""
    def ratio(above, below, first=one, second=one):
        return {w: first[f"{w}/{above}"][0] / second[f"{w}/{below}"][0]
                for w in COLUMNS if f"{w}/{above}" in first and f"{w}/{below}" in second}

    def at_least(what, must, wanted, reached):
        span = lambda limits: " ".join(f"{limits[w]:g}" for w in COLUMNS[:7] if limits.get(w))
        return (what, span(must), span(wanted), {w: f"{r:.1f} x" for w, r in reached.items()},
                {w: r >= must.get(w, 0) for w, r in reached.items()})

    def at_most(what, limit, reached, digits=2):
        return (what, "", f"{limit:g}", {w: f"{r:.{digits}f} x" for w, r in reached.items()},
                {w: r <= limit for w, r in reached.items()})

    depth = (goals(5, 4.5, 14, 3, 6, 23, 3.3), goals(8, 7, 22, 5.5, 8.5, 32, 5))
    seen = (goals(4, 4, 11, 3, 5.5, 20, 2.8), goals(7, 6.5, 16, 5, 8, 28, 4))
    shaded = (goals(0, 0, 0, 0, 0, 0, 0), goals(4, 3.5, 6, 3, 5, 15, 2.5))
    table = [
        at_least("depth, against llvmpipe depth", *depth, ratio("depth/llvmpipe", "depth/surefill")),
        at_least("visibility, against llvmpipe depth", *seen, ratio("depth/llvmpipe", "visibility/surefill")),
        at_least("visibility + 4 attributes, against llvmpipe depth + colour", *shaded,
                 ratio("attributes/llvmpipe", "attributes/surefill")),
        at_least("AVX2: depth", *depth, ratio("depth/llvmpipe", "depth/AVX2")),
        at_least("AVX2: visibility", *seen, ratio("depth/llvmpipe", "visibility/AVX2")),
        at_least("AVX2: visibility + 4 attributes", *shaded, ratio("attributes/llvmpipe", "attributes/AVX2")),
        at_most("depth clipped, times unclipped", 1.05, ratio("depth/surefill", "depth/unclipped")),
        ("depth without a context, times with", "", "", {w: f"{r:.2f} x" for w, r in ratio("depth/alone", "depth/surefill").items()}, {}),
        at_most("visibility, times depth", 1.25, ratio("visibility/surefill", "depth/surefill")),
        at_most("counts, times depth", 1.1, ratio("count/surefill", "depth/surefill")),
        at_most("Grid of 8 bits, times the time without", 1.25, ratio("depth/grid", "depth/surefill")),
        at_most("conservative counts, times counts", 1.4, ratio("count/conservative", "count/surefill")),
        at_most("exact coverage, times rounded", 1.1, ratio("depth/surefill", "depth/inexact-coverage")),
        at_most("... snapped to 1/256 pixel", 1.15, ratio("snapped/depth/surefill", "snapped/depth/inexact-coverage")),
        at_most("... on pixel centres", 1.15, ratio("aligned/depth/surefill", "aligned/depth/inexact-coverage")),
        at_most("rounded depth, times float", 1.6, ratio("depth/surefill", "depth/inexact-depth")),
        at_least("two threads against one, depth", {}, goals(1.7, 1.7, 1.7, 1.7, 1.7, 1.7, 1.7),
                 ratio("depth/surefill", "depth/surefill", one_on_wall, two)),
        at_least("two threads, depth, against llvmpipe on two", *depth, ratio("depth/llvmpipe", "depth/surefill", two, two)),
    ]
    return table


def context_of(file):
    """The machine, as the run saw it."""
    with open(file) as text:
        context = json.load(text)["context"]
    return f"{context.get('processor', 'unknown processor')}, {context.get('instruction_set', '?')}"


def instructions(program):
    """name -> instructions of one drawing, by valgrind, which no neighbour disturbs; nothing where it is not installed or cannot run
    the program, as on processors with instructions that it does not know."""
    if shutil.which("valgrind") is None:
        return {}

    def count(name, times):
        command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, "--draw", name, str(times)]
        run = subprocess.run(command, capture_output=True, text=True)
        if run.returncode != 0:
            raise ValueError(f"{' '.join(command)} ended with {run.returncode}")
        return int(re.search(r"Collected : (\d+)", run.stderr)[1])
    try:
        return {name: count(name, 2) - count(name, 1) for name in ("small/1000", "spot/270")}
    except ValueError as error:
        print(f"table: instructions are not counted: {error}", file=sys.stderr)
        return {}


def sizes(one):
    return {int(name.split("/")[1]): one[name][0] * 1e6 / int(name.split("/")[1])
            for name in one if name.startswith("small/") and name.endswith("/depth/surefill")}


def text_of(table, one, two, machine, counted):
    lines = [f"of {machine}; depth is clipped", "",
             f"{'ratios of medians':60} {'must':22} {'wanted':24} " + " ".join(f"{w.replace('000000', 'M').replace('0000', '0k'):>10}" for w in COLUMNS)]
    for what, must, wanted, reached, holds in table:
        cells = [reached.get(w, "") + ("" if holds.get(w, True) else " -") for w in COLUMNS]
        lines.append(f"{what:60} {must:22} {wanted:24} " + " ".join(f"{cell:>10}" for cell in cells))
    lines.append("(- behind a number: not what must be, or what is wanted where nothing must)")
    lines.append("")
    for output in ("depth", "attributes"):
        spot = {h: one[f"spot/{h}/{output}/llvmpipe"][0] / one[f"spot/{h}/{output}/surefill"][0]
                for h in (135, 270, 540, 1080) if f"spot/{h}/{output}/llvmpipe" in one}
        if spot:
            lines.append(f"spot, {output}, against llvmpipe: " + ", ".join(f"{h} pixels high {r:.1f} x" for h, r in spot.items()))
    for name, instructions_of in counted.items():
        lines.append(f"instructions of a drawing, {name}, depth, by valgrind: {instructions_of:,}")
    if "small/1000/depth/alone" in one and "memory/depth/written" in one:
        written = one["memory/depth/written"][0]
        lines.append(f"1000 triangles, depth: {one['small/1000/depth/surefill'][0] / written:.1f} times the time to write the output, "
                     f"{one['small/1000/depth/alone'][0] / written:.1f} without a context")
    per = sizes(one)
    if per:
        lines.append("ns a triangle of 10 pixels: " + ", ".join(f"{n:,}: {ns:.0f}" for n, ns in sorted(per.items())))
    if "memory/depth/limit" in one:
        limit = one["memory/depth/limit"][0]
        lines.append(f"one full-screen layer of depth, read, compared, written: {limit:.2f} ms; W3's depth takes "
                     f"{one['W3/depth/surefill'][0] / limit:.1f} times that")
    lines.append("")
    lines.append(f"{'milliseconds (spread)':32} {'one thread':>18} {'two threads':>18}")
    for name in sorted(set(one) | set(two)):
        cell = lambda run: f"{run[name][0]:10.2f} (±{run[name][1] * 100:3.0f} %)" if name in run else ""
        lines.append(f"{name:32} {cell(one):>18} {cell(two):>18}")
    return "\n".join(lines) + "\n"


def svg_of(one):
    """Bars on a logarithmic scale: milliseconds a frame, one thread."""
    import math
    series = [("depth/surefill", "Surefill, depth", "#1b6ca8"), ("visibility/surefill", "Surefill, visibility", "#5fa8d3"),
              ("attributes/surefill", "Surefill, 4 attributes", "#a9d6e5"), ("depth/llvmpipe", "llvmpipe, depth", "#d1603d"),
              ("attributes/llvmpipe", "llvmpipe, 4-float colour", "#f0a58f")]
    left, top, height, bar, gap = 60, 40, 300, 16, 26
    group = bar * len(series) + gap
    width = left + group * len(WORKLOADS) + 20
    y = lambda ms: top + height * (1 - math.log10(max(ms, 1)) / 4)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{top + height + 60}" '
           'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="white"/>',
           f'<text x="{left}" y="20" font-size="14">Milliseconds a frame, 1920 x 1080, one thread (logarithmic)</text>']
    for power in range(5):
        out.append(f'<line x1="{left}" x2="{width - 10}" y1="{y(10 ** power):.1f}" y2="{y(10 ** power):.1f}" stroke="#ccc"/>'
                   f'<text x="{left - 8}" y="{y(10 ** power) + 4:.1f}" text-anchor="end">{10 ** power}</text>')
    for i, workload in enumerate(WORKLOADS):
        x = left + gap / 2 + i * group
        for k, (name, _, color) in enumerate(series):
            if f"{workload}/{name}" not in one:
                continue
            ms = one[f"{workload}/{name}"][0]
            out.append(f'<rect x="{x + k * bar:.1f}" y="{y(ms):.1f}" width="{bar - 2}" '
                       f'height="{top + height - y(ms):.1f}" fill="{color}"><title>{ms:.1f} ms</title></rect>')
        out.append(f'<text x="{x + bar * len(series) / 2:.1f}" y="{top + height + 18}" text-anchor="middle">{workload}</text>')
    for k, (_, label, color) in enumerate(series):
        x = left + k * 125
        out.append(f'<rect x="{x}" y="{top + height + 32}" width="10" height="10" fill="{color}"/>'
                   f'<text x="{x + 14}" y="{top + height + 41}" font-size="10">{label}</text>')
    return "\n".join(out + ["</svg>"]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("benchmark")
    parser.add_argument("folder")
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("--min-time", type=float, default=0.1)
    parser.add_argument("--reuse", action="store_true")
    options = parser.parse_args()
    os.makedirs(options.folder, exist_ok=True)
    files = {threads: os.path.join(options.folder, name) for threads, name in ((1, "one.json"), (2, "two.json"))}
    for threads, file in files.items():
        if not options.reuse:
            run(options.benchmark, file, threads, options)
    # One thread is measured by its processor time, which neighbours disturb little; two against one by that on the wall.
    one, one_on_wall, two = read(files[1], "cpu_time"), read(files[1], "real_time"), read(files[2], "real_time")
    table = rows(one, one_on_wall, two)
    text = text_of(table, one, two, context_of(files[1]), instructions(options.benchmark))
    with open(os.path.join(options.folder, "table.txt"), "w") as out:
        out.write(text)
    with open(os.path.join(options.folder, "table.json"), "w") as out:
        json.dump({"table": [{"what": what, "must": must, "wanted": wanted, "reached": reached, "holds": holds}
                             for what, must, wanted, reached, holds in table],
                   "milliseconds": {"one thread": one, "two threads": two}}, out, indent=1)
    with open(os.path.join(options.folder, "table.svg"), "w") as out:
        out.write(svg_of(one))
    print(text, end="")


if __name__ == "__main__":
    main()
