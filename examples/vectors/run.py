#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds raster.py against vectors/ties.json: every test is right, or the fault is named. run.py ties.json [--fault]"""
import json
import math
import struct
import sys

import raster


def unroll(runs):
    return [value for run, value in zip(runs[::2], runs[1::2]) for _ in range(run)]


def counts(test, fault):
    """How often each sample of the window is covered."""
    target, frame = test["target"], test["frames"][0]
    x0, y0, x1, y1 = test.get("window", (0, 0, target["width"], target["height"]))
    result = [0] * ((x1 - x0) * (y1 - y0))
    for draw in frame["draws"]:
        vertices = [[struct.unpack(">f", bytes.fromhex(bits))[0] for bits in vertex] for vertex in draw["vertices"]["bits"]]
        for corners in draw["triangles"]:
            triangle = [vertices[k] for k in corners]
            if all(math.isfinite(number) for vertex in triangle for number in vertex):
                for x, y in raster.rasterize(triangle, draw["state"]["fill_rule"], (x0, y0, x1, y1), fault):
                    result[(y - y0) * (x1 - x0) + x - x0] += 1
    return result


def main(path, *options):
    with open(path, encoding="utf-8") as file:
        document = json.load(file)
    failed = set()
    for test in document["tests"]:
        if counts(test, "--fault" in options) != unroll(test["frames"][0]["expected"]["count"]):
            failed.add(test["id"])
    print(f"{len(document['tests'])} tests, {len(failed)} wrong")
    scores = []
    for name in document["notes"]:
        shown = {test["id"] for test in document["tests"] if name in test["kills"]}
        scores.append((len(shown & failed) / len(shown | failed), name))
    if failed:
        name = max(scores)[1]
        print(f"likely: {name}: {document['notes'][name]['bug']}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
