#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the benchmarks on one thread and on two, and prints what was reached beside what is wanted.

usage: table.py BENCHMARK FOLDER [--repetitions N] [--min-time SECONDS] [--reuse]

Ratios of medians within one run; the spread is half the distance of the quartiles, relative to the median. Everything
goes to FOLDER: one.json and two.json (Google Benchmark's), table.txt, table.json, table.svg. --reuse makes the table from
the runs that are there.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys

WORKLOADS = ["W1", "W2", "W3", "W4", "W5", "W6"]


def run(program, file, threads, options):
    environment = dict(os.environ, SUREFILL_BENCH_THREADS=str(threads),
                       LP_NUM_THREADS="0" if threads == 1 else str(threads))
    command = [program, f"--benchmark_out={file}", "--benchmark_out_format=json",
               f"--benchmark_repetitions={options.repetitions}", f"--benchmark_min_time={options.min_time}",
               "--benchmark_enable_random_interleaving=false", "--benchmark_display_aggregates_only=true"]
    show = sys.stderr if sys.stderr.isatty() else subprocess.DEVNULL
    subprocess.run(command, env=environment, check=True, stdout=show, stderr=subprocess.DEVNULL)


def read(file):
    """name -> (median ms, spread) of all benchmarks that ran."""
    times = {}
    with open(file) as text:
        for row in json.load(text)["benchmarks"]:
            if row.get("run_type") == "iteration" and "error_occurred" not in row:
                times.setdefault(row["name"].removesuffix("/real_time"), []).append(row["real_time"])
    result = {}
    for name, values in times.items():
        middle = statistics.median(values)
        quartiles = statistics.quantiles(values, n=4) if len(values) > 1 else [middle] * 3
        result[name] = (middle, (quartiles[2] - quartiles[0]) / 2 / middle)
    return result


def rows(one, two):
    """(what, wanted, workload -> reached, holds) of the table."""
    def ratio(above, below, first=one, second=one):
        return {w: first[f"{w}/{above}"][0] / second[f"{w}/{below}"][0]
                for w in WORKLOADS if f"{w}/{above}" in first and f"{w}/{below}" in second}

    def at_least(what, limits, reached):
        text = ", ".join(sorted({f"{limit:g} x" for limit in limits.values()}))
        return (what, text, {w: f"{r:.1f} x" for w, r in reached.items() if w in limits},
                {w: r >= limits[w] for w, r in reached.items() if w in limits})

    def price(what, limit, reached):
        percent = {w: (r - 1) * 100 for w, r in reached.items()}
        return (what, f"{limit:g} %", {w: f"{p:+.0f} %" for w, p in percent.items()},
                {w: p <= limit for w, p in percent.items()})

    plain = {w: 20 if w in ("W3", "W6") else 10 for w in WORKLOADS}
    eight = dict.fromkeys(WORKLOADS, 8)
    table = [
        at_least("depth, against llvmpipe depth", plain, ratio("depth/llvmpipe", "depth/surefill")),
        at_least("visibility, against llvmpipe depth", eight, ratio("depth/llvmpipe", "visibility/surefill")),
        at_least("visibility + 4 attributes, against llvmpipe depth + colour", eight,
                 ratio("attributes/llvmpipe", "attributes/surefill")),
        price("price of exact coverage", 10, ratio("depth/surefill", "depth/inexact-coverage")),
        price("... snapped to 1/256 pixel", 15, ratio("snapped/depth/surefill", "snapped/depth/inexact-coverage")),
        price("... on pixel centres", 15, ratio("aligned/depth/surefill", "aligned/depth/inexact-coverage")),
        price("price of rounded depth, against float", 60, ratio("depth/surefill", "depth/inexact-depth")),
        at_least("AVX2: share of AVX-512's speed, turned over", {}, {}),
        at_least("two threads against one, depth", {w: 1.6 if w in ("W1", "W4") else 1.8 for w in WORKLOADS},
                 ratio("depth/surefill", "depth/surefill", one, two)),
        at_least("two threads, depth, against llvmpipe on two", plain,
                 ratio("depth/llvmpipe", "depth/surefill", two, two)),
    ]
    wide = ratio("depth/AVX2", "depth/surefill")
    table[7] = ("AVX2, times the AVX-512 time", "1.5 x", {w: f"{r:.2f} x" for w, r in wide.items()},
                {w: r <= 1.5 for w, r in wide.items()})
    return table


def sizes(one):
    return {int(name.split("/")[1]): one[name][0] * 1e6 / int(name.split("/")[1])
            for name in one if name.startswith("small/")}


def text_of(table, one, two):
    lines = [f"{'ratios of medians':60} {'wanted':12} " + " ".join(f"{w:>8}" for w in WORKLOADS)]
    for what, wanted, reached, holds in table:
        cells = [reached.get(w, "") + ("" if holds.get(w, True) else " -") for w in WORKLOADS]
        lines.append(f"{what:60} {wanted:12} " + " ".join(f"{cell:>8}" for cell in cells))
    lines.append("(- behind a number: not what is wanted)")
    lines.append("")
    for output in ("depth", "attributes"):
        spot = {h: one[f"spot/{h}/{output}/llvmpipe"][0] / one[f"spot/{h}/{output}/surefill"][0]
                for h in (135, 270, 540, 1080) if f"spot/{h}/{output}/llvmpipe" in one}
        if spot:
            lines.append(f"spot, {output}, against llvmpipe: " + ", ".join(f"{h} pixels high {r:.1f} x" for h, r in spot.items()))
    for what, above, below in (
            ("Grid of 8 bits, times the time without", "depth/grid", "depth/surefill"),
            ("conservative counts, times the time of counts", "count/conservative", "count/surefill")):
        cells = {w: one[f"{w}/{above}"][0] / one[f"{w}/{below}"][0] for w in WORKLOADS if f"{w}/{above}" in one}
        if cells:
            lines.append(f"{what}: " + ", ".join(f"{w} {r:.2f}" for w, r in cells.items()))
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
    one, two = read(files[1]), read(files[2])
    table = rows(one, two)
    text = text_of(table, one, two)
    with open(os.path.join(options.folder, "table.txt"), "w") as out:
        out.write(text)
    with open(os.path.join(options.folder, "table.json"), "w") as out:
        json.dump({"table": [{"what": what, "wanted": wanted, "reached": reached, "holds": holds}
                             for what, wanted, reached, holds in table],
                   "milliseconds": {"one thread": one, "two threads": two}}, out, indent=1)
    with open(os.path.join(options.folder, "table.svg"), "w") as out:
        out.write(svg_of(one))
    print(text, end="")


if __name__ == "__main__":
    main()
