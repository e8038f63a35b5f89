#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Recomputes what the files of this folder expect, and says where they differ: check.py [--every N] [FILE.json ...]

Written from docs/semantics.md and the layout of the files (docs/vectors.md) alone. It needs nothing: whole numbers and
fractions do all of it. The letters in the comments (C3, G1, ...) are the rules of that page.
"""
import json
import math
import pathlib
import struct
import sys
from fractions import Fraction

LOCATIONS = {  # S4, in 1/16 pixel
    1: [(8, 8)], 2: [(12, 12), (4, 4)], 4: [(6, 2), (14, 6), (2, 10), (10, 14)],
    8: [(9, 5), (7, 11), (13, 9), (5, 3), (3, 13), (1, 7), (11, 15), (15, 1)],
    16: [(9, 9), (7, 5), (5, 10), (12, 7), (3, 6), (10, 13), (13, 11), (11, 3), (6, 14), (8, 1), (4, 2), (2, 12), (0, 8),
         (15, 4), (14, 15), (1, 0)]}
FILL_RULES = {  # C3: sign of the x shift, sign of the y shift, whether x dominates. C5 shifts nothing
    "top_left": (1, 1, True), "top_right": (-1, 1, True), "bottom_left": (1, -1, True), "bottom_right": (-1, -1, True),
    "southwards": (1, 1, False), "southwards_west": (-1, 1, False), "northwards": (1, -1, False), "northwards_west": (-1, -1, False)}
EMPTY, LARGEST = 0xFFFFFFFF, Fraction((2**24 - 1) * 2**104)

def from_bits(text):
    return struct.unpack(">f", bytes.fromhex(text))[0]
def to_bits(number):
    return struct.pack(">f", number).hex()
def store(real):
    """I4: the finite float32 nearest to a Fraction, zero as +0."""
    size = abs(real)
    exponent = size.numerator.bit_length() - size.denominator.bit_length()
    exponent -= size < Fraction(2) ** exponent
    step = Fraction(2) ** (max(exponent, -126) - 23)
    rounded = min(round(size / step) * step, LARGEST)  # round() takes ties to even
    return float(rounded if real > 0 else -rounded) if rounded else 0.0

def sign(number):
    return (number > 0) - (number < 0)
def unroll(runs):
    return [value for run, value in zip(runs[::2], runs[1::2]) for _ in range(run)]
def tie(a, b, rule):
    """C3: the sign of a value that is 0 at the sample and changes by a along x and by b along y."""
    x, y, x_dominates = FILL_RULES[rule]
    first, second = (x * a, y * b) if x_dominates else (y * b, x * a)
    return sign(first or second)

def cross(u, v):
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
def dot(u, v):
    return sum(a * b for a, b in zip(u, v))
def cut(path, heights, between):
    """A closed path cut to where the heights are not negative (Sutherland and Hodgman)."""
    result, n = [], len(path)
    for point, h, following, g in ((path[k], heights[k], path[(k + 1) % n], heights[(k + 1) % n]) for k in range(n)):
        result += [point] * (h >= 0) + ([between(point, following, abs(h), abs(g))] if h * g < 0 else [])
    return result

class Triangle:
    """A sample is (x, y, w): the point (x / w, y / w), whole numbers, w > 0."""

    def __init__(self, vertices, attributes, draw, origin):
        self.attributes, self.kinds, self.state = attributes, [a["interpolation"] for a in draw.get("attributes", [])], draw["state"]
        self.rule, self.grid, self.origin = self.state["fill_rule"], self.state.get("grid"), origin
        exact = [[Fraction(number) for number in vertex] for vertex in vertices]
        scale = max(number.denominator for vertex in exact for number in vertex)
        self.vertices = [[int(number * scale) for number in vertex] for vertex in exact]  # X, Y, Z, W times one number
        self.m = [(x, y, w) for x, y, _, w in self.vertices]
        self.edges = [cross(self.m[1], self.m[2]), cross(self.m[2], self.m[0]), cross(self.m[0], self.m[1])]
        self.d = dot(self.m[0], self.edges[0])
        if self.grid:
            polygon = [] if self.holds_eye() else self.clipped()
            self.snapped = [self.snap(corner) for corner in polygon]
            self.depths = [Fraction(z, w) for _, _, z, w in polygon]

    def holds_eye(self):
        """Whether the closed hull of m0, m1, m2 contains the origin."""
        pairs = [(self.m[1], self.m[2], self.edges[0]), (self.m[2], self.m[0], self.edges[1]), (self.m[0], self.m[1], self.edges[2])]
        if self.d == 0 and any(not any(normal) and dot(u, v) <= 0 for u, v, normal in pairs):
            return True
        return self.d == 0 and all(dot(self.edges[i], self.edges[i - 1]) > 0 for i in range(3))

    def clipped(self):
        """G1: the path v0 v1 v2 v0 in the guard band."""
        path = self.vertices
        for axis, side in ((0, 1), (0, -1), (1, 1), (1, -1)):
            path = cut(path, [(2**14 + 1 + side * self.origin[axis]) * corner[3] - side * corner[axis] for corner in path],
                       lambda a, b, h, g: [g * u + h * v for u, v in zip(a, b)])
        return path

    def snap(self, corner):
        """Section 6: where a corner goes, in units of 2^-(bits + 4) pixels."""
        bits, offsets, rounding, place = self.grid[0], self.grid[1:3], self.grid[3], []
        for axis in (0, 1):
            steps = Fraction(corner[axis], corner[3]) * 2**bits - Fraction(offsets[axis], 16)
            k = round(steps) if rounding == "nearest_even" else math.trunc(steps) if rounding == "truncate" else \
                math.floor(steps + Fraction(1, 2))
            place.append(16 * k + offsets[axis])
        return place

    def at(self, p):
        return [dot(edge, p) for edge in self.edges]
    def facing(self, p):
        """1 or -1 where p is covered, else 0: C1 to C3, C5; under Grid the winding number of G1."""
        if not self.grid:
            values = [e * sign(self.d) for e in self.at(p)]
            if self.rule not in FILL_RULES:
                return sign(self.d) if self.d and all(e >= 0 if self.rule == "closed" else e > 0 for e in values) else 0
            values = [e or tie(a, b, self.rule) * sign(self.d) for e, (a, b, _) in zip(values, self.edges)]
            return sign(self.d) if self.d and min(values) > 0 else 0
        scale, winding = 2 ** (self.grid[0] + 4), 0
        x, y = p[0] * scale // p[2], p[1] * scale // p[2]
        for k, (ax, ay) in enumerate(self.snapped):
            bx, by = self.snapped[(k + 1) % len(self.snapped)]
            below_a, below_b = ((y - v or tie(0, 1, self.rule)) > 0 for v in (ay, by))
            turn = sign((bx - ax) * (y - ay) - (x - ax) * (by - ay)) or tie(ay - by, bx - ax, self.rule)
            winding += (below_a and not below_b and turn > 0) - (below_b and not below_a and turn < 0)
        return winding

    def plane(self, p):
        """I1."""
        return Fraction(sum(v[2] * e for v, e in zip(self.vertices, self.at(p)))) / (self.d * p[2])

    def depth(self, p):
        """I1, G2: the real depth, before clip and clamp."""
        if not self.grid:
            return self.plane(p)
        return min(max(self.plane(p), min(self.depths)), max(self.depths)) if self.d else min(self.depths)

    def bias(self):
        """I8."""
        constant, slope = (Fraction(from_bits(text)) for text in self.state.get("depth_bias", ("00000000", "00000000")))
        planes = [sum(v[2] * edge[axis] for v, edge in zip(self.vertices, self.edges)) for axis in (0, 1)]
        return constant + (slope * Fraction(max(map(abs, planes)), abs(self.d)) if self.d else 0)

    def weights(self, p):
        """The E_i that count (G2), divided by p's w."""
        values = [Fraction(e) / p[2] for e in self.at(p)]
        return [e if e * self.d > 0 else Fraction(0) for e in values] if self.grid else values

    def place(self, samples, number, by_centroid):
        """M1: where the attributes of the pixel's sample `number` are evaluated."""
        p = samples[number]
        if len(samples) == 1 or (self.grid and self.d == 0):
            return p
        centre = (p[0] // 16 * 16 + 8, p[1] // 16 * 16 + 8, 16)
        if (not by_centroid and sum(self.weights(centre)) * self.d > 0) or self.facing(centre):
            return centre
        return next(sample for sample in samples if self.facing(sample))

    def interpolate(self, p, values, kind):
        """I2, G2."""
        w = self.weights(p)
        if kind == "noperspective":
            w = [e * vertex[3] for e, vertex in zip(w, self.vertices)]
        total = self.d if kind == "noperspective" and not self.grid else sum(w)
        if kind == "flat" or total == 0 or (self.grid and self.d == 0):
            return values[0]
        return sum(e * u for e, u in zip(w, values)) / total

    def meets_square(self, x, y, mode):
        """M4, M4a, M4b."""
        between = lambda p, q, h, g: tuple((g * u + h * v) / (g + h) for u, v in zip(p, q))
        square = [(Fraction(u), Fraction(v)) for u, v in ((x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1))]
        for a, b, c in self.edges if self.d else ():
            heights = [(a * u + b * v + c) * sign(self.d) for u, v in square]
            if mode == "inner" and min(heights) < 0:
                return False
            square = cut(square, heights, between)
        if self.d:
            area = sum(p[0] * q[1] - p[1] * q[0] for p, q in zip(square, square[1:] + square[:1]))
            return area != 0 if mode == "overlap" else bool(square)
        met = False
        for k in range(3 if mode == "touched" else 0):  # S of an edge: where W > 0
            path = [tuple(map(Fraction, m)) for m in (self.m[k], self.m[k - 1])]
            for height in (lambda m: m[0] - x * m[2], lambda m: (x + 1) * m[2] - m[0], lambda m: m[1] - y * m[2], lambda m: (y + 1) * m[2] - m[1]):
                path = cut(path, [height(m) for m in path], between)
            met = met or any(m[2] > 0 for m in path)
        return met

def model_answer(triangle, bits, p):
    """R5 to R9 for a grid of so many bits, nearest-even, slivers open: 1 covered, 0 not covered, None open."""
    x, y, d, m = Fraction(p[0], p[2]), Fraction(p[1], p[2]), triangle.d, triangle.m
    places = [(Fraction(mx, w), Fraction(my, w)) for mx, my, w in m if w > 0]
    if len(places) < 3 or any(abs(q) > 2**14 for place in places for q in place):  # R9
        terms = sum(abs(m[0][i] * m[1][j] * m[2][k]) for i, j, k in ((0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)))
        half = Fraction(1, 16) + Fraction(1, 2**bits)
        values = [[dot(edge, (x + u, y + v, 1)) * sign(d) for u in (-half, half) for v in (-half, half)] for edge in triangle.edges]
        return None if abs(d) * 2**20 <= terms else 1 if min(map(min, values)) > 0 else 0 if min(map(max, values)) < 0 else None
    (ax, ay), (bx, by), (cx, cy) = path = [tuple(Fraction(round(q * 2**bits), 2**bits) for q in place) for place in places]
    area = sign((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))
    sides = [((v[0] - u[0]) * (y - u[1]) - (v[1] - u[1]) * (x - u[0]), u[1] - v[1], v[0] - u[0]) for u, v in zip(path, path[1:] + path[:1])]
    if area != sign(d):  # R8: open in the closed hull
        inside = all(e * area >= 0 for e, _, _ in sides) if area else not any(e for e, _, _ in sides)
        return None if inside and all(min(q) <= u <= max(q) for q, u in zip(zip(*path), (x, y))) else 0
    return int(area != 0 and all((e * area or tie(a * area, b * area, triangle.rule)) > 0 for e, a, b in sides))

def interval(function, p, model, most):
    """R11: from the least to the largest value within the model's distance on both axes, and its roundings of `most`."""
    within, slack = Fraction(*model["within"]), Fraction(*model["roundings"]) * most
    values = [function((Fraction(p[0], p[2]) + u, Fraction(p[1], p[2]) + v, 1)) for u in (-within, within) for v in (-within, within)]
    return to_bits(store(min(values) - slack)) + ":" + to_bits(store(max(values) + slack))

def read_triangles(draw, origin):
    """B1, V2: (triangle, index) of those that are drawn."""
    vertices = [[from_bits(text) for text in vertex] for vertex in draw["vertices"]["bits"]]
    for vertex, decimals in zip(vertices, draw["vertices"]["decimal"]):
        assert [to_bits(n) for n in vertex] == [to_bits(float(d)) for d in decimals] or any(map(math.isnan, vertex)), "decimals"
    arrays = [[[from_bits(text) for text in vertex] for vertex in array["bits"]] for array in draw.get("attributes", [])]
    drawn = []
    for position, corners in enumerate(draw["triangles"]):
        if all(math.isfinite(n) for k in corners for n in vertices[k] + [u for array in arrays for u in array[k]]):
            values = [[[Fraction(array[k][c]) for k in corners] for c in range(len(array[0]))] for array in arrays]
            index = draw["identifiers"][position] if "identifiers" in draw else position + draw["first_index"]
            drawn.append((Triangle([vertices[k] for k in corners], values, draw, origin), index))
    return drawn

def fragments(drawn, state, bits, p):
    """M2 at one sample: (depth, index, position, triangle, front) of each triangle that counts, and how many are open."""
    found, opened, x, y = [], 0, p[0] // 16, p[1] // 16
    left, top, right, bottom = state.get("scissor", (x, y, x + 1, y + 1))
    for position, (triangle, index) in enumerate(drawn if left <= x < right and top <= y < bottom else []):
        if state["conservative"] != "none":
            back = -1 if state["front_face"] == "clockwise" else 1  # as which M4b counts D = 0
            facing = (sign(triangle.d) or back) if triangle.meets_square(x, y, state["conservative"]) else 0
        elif bits:
            answer = model_answer(triangle, bits, p)
            opened, facing = opened + (answer is None), sign(triangle.d) if answer else 0
        else:
            facing = triangle.facing(p)
        front = (facing > 0) == (state["front_face"] == "clockwise")  # F1
        if facing and state["cull"] != ("front" if front else "back"):
            real = triangle.depth(p) if state["conservative"] == "none" and not bits else Fraction(0)
            if state["depth_mode"] != "clip" or 0 <= real <= 1:  # I5
                real += triangle.bias() if "depth_bias" in state and state["conservative"] == "none" else 0
                found.append((store(min(max(real, 0), 1) if state["depth_mode"] == "clamp" else real), index, position, triangle, front))
    return found, opened

def beating(found, kept, test):
    """V1, V5: those that beat a depth; None is beaten by any."""
    order = -1 if test.startswith("greater") else 1
    return [f for f in found if kept is None or order * f[0] < order * kept or (test.endswith("equal") and f[0] == kept)]

def nearness(test):
    """V1, V4, V5: by what fragments are ordered."""
    order, later = -1 if test.startswith("greater") else 1, -1 if test.endswith("equal") else 1
    return lambda f: (order * f[0], *(later * n for n in (*f[5:], *f[1:3])))

def values_of(triangle, place, model, wanted):
    """Depth under a model, barycentrics, attributes, as far as they are wanted."""
    def one(values, kind, unit=False):
        most = 1 if unit else max(map(abs, values[:1] if kind == "flat" else values))
        function = lambda p: triangle.interpolate(p, values, kind)
        return interval(function, place, model, most) if model else to_bits(store(function(place)))
    depth = interval(triangle.plane, place, model, max(abs(Fraction(v[2], v[3])) for v in triangle.vertices)) if model and "depth" in wanted else None
    weights = [one([Fraction(i == k) for i in range(3)], "perspective", True) for k in range(3)] if "barycentrics" in wanted else None
    return depth, weights, [[one(u, k) for u in values] for k, values in zip(triangle.kinds, triangle.attributes if "attributes" in wanted else ())]

def render(test, model):
    """Yields for each frame, of each layer and sample in order: count, open, index, depth, barycentrics, attributes, winding."""
    target, bits, previous = test["target"], (model or {}).get("bits"), None
    compare, wide, number, layers = target["depth_test"], target["width"], target["samples"], target.get("layers", 1)
    (ox, oy), places = target.get("origin", (0, 0)), target.get("sample_locations", LOCATIONS[number])
    x0, y0, x1, y1 = test.get("window", (0, 0, wide, target["height"]))
    nothing = "ff800000:7f800000" if model else "00000000"  # under a model an empty sample's values are open
    for frame in test["frames"]:
        initial = frame.get("initial_depth")
        initial = previous if initial == "previous" else initial and [from_bits(text) for text in unroll(initial)]
        draws = [(draw["state"], read_triangles(draw, (ox, oy))) for draw in frame["draws"]]
        conservative, out = any(state["conservative"] != "none" for state, _ in draws), [[] for _ in range(layers)]
        for y, x, s in ((y, x, s) for y in range(y0, y1) for x in range(x0, x1) for s in range(number)):
            samples = [(16 * (ox + x) + u, 16 * (oy + y) + v, 16) for u, v in places]
            first = kept = initial[(y * wide + x) * number + s] if initial else None
            opened, winner, all_found = 0, None, []
            for n, (state, drawn) in enumerate(draws):
                found, undecided = fragments(drawn, state, bits, samples[s])
                opened, all_found = opened + undecided, all_found + [(*f, n) for f in found]
                passing = beating(found, kept, compare)
                if passing:  # M5
                    winner = min(passing, key=nearness(compare)) if state["depth_write"] else max(passing, key=lambda f: f[1:3])
                    kept = winner[0] if state["depth_write"] else kept
            if conservative:
                winner = min(all_found, key=lambda f: f[1], default=None)  # M4c
            if model and (len(all_found) != 1 or opened):
                winner = None
            ordered = sorted(beating(all_found, first, compare), key=nearness(compare)) if layers > 1 else [winner]
            for layer in range(layers):
                seen = ordered[layer] if layer < len(ordered) else None
                depth = kept if layers == 1 else seen[0] if seen else first
                depth = to_bits((-math.inf if compare.startswith("greater") else math.inf) if depth is None else depth)
                values = (nothing if model else depth, [nothing] * 3, None)
                if seen:
                    place = samples[s] if conservative else seen[3].place(samples, s, target["attribute_location"] == "centroid")
                    modelled, weights, attributes = values_of(seen[3], place, model, frame["expected"])
                    values = (modelled or depth, weights, attributes)
                out[layer].append((len(all_found), opened, seen[1] if seen else EMPTY, *values, sum(1 if f[4] else -1 for f in all_found)))
        previous = [from_bits(sample[3]) for sample in out[0]] if not model else None
        yield out, nothing

def differences(test, model):
    for number, (frame, (out, nothing)) in enumerate(zip(test["frames"], render(test, model))):
        expected, layered = frame["expected"], [sample for layer in out for sample in layer]
        planes = [(name, expected.get(name, [len(out[0]), 0] if name == "open" and "count" in expected else None), [sample[i] for sample in samples])
                  for i, name, samples in ((0, "count", out[0]), (1, "open", out[0]), (2, "index", layered), (3, "depth", layered), (6, "winding", out[0]))]
        planes += [(f"b{k}", runs, [sample[4][k] for sample in layered]) for k, runs in enumerate(expected.get("barycentrics", []))]
        planes += [(f"attribute {k}, component {c}", runs, [sample[5][k][c] if sample[5] else nothing for sample in layered])
                   for k, array in enumerate(expected.get("attributes", [])) for c, runs in enumerate(array)]
        for name, runs, here in planes:
            there = here if runs is None else unroll(runs)
            if there != here:
                at = next((i for i, (a, b) in enumerate(zip(there, here)) if a != b), 0)
                yield f"frame {number}, {name} of sample {at}: {there[at]} in the file, {here[at]} here ({len(there)}, {len(here)} samples)"

def main(names):
    every, names = (int(names[1]), names[2:]) if names[:1] == ["--every"] else (1, names)
    tests = values = wrong = 0
    for name in names or sorted(str(path) for path in pathlib.Path(__file__).resolve().parent.glob("*.json")):
        document = json.loads(pathlib.Path(name).read_text(encoding="utf-8"))
        for test in document["tests"][::every]:
            found = [line for model in test["models"] for line in differences(test, document["models"][model] if model != "exact" else None)]
            tests, wrong = tests + 1, wrong + bool(found)
            values += sum(len(unroll(runs)) for frame in test["frames"] for runs in [frame["expected"].get("count", frame["expected"].get("depth"))])
            print("".join(f"{name}: test {test['id']}: {line}\n" for line in found), end="")
    print(f"{tests} tests, {values} samples: {wrong} tests differ")
    return 1 if wrong or not tests else 0

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
