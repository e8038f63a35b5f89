#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Recomputes what the files of this folder expect, and says where they differ. `check.py [FILE.json ...]`

Written from docs/semantics.md and the layout of the files alone, before any other code of the project was read. It has
no dependency: whole numbers and fractions do all of it. The letters in the comments (C3, G1, ...) are rules of that page.
"""
import json
import math
import pathlib
import struct
import sys
from fractions import Fraction

LOCATIONS = {  # S4, in 1/16 pixel
    1: [(8, 8)],
    2: [(12, 12), (4, 4)],
    4: [(6, 2), (14, 6), (2, 10), (10, 14)],
    8: [(9, 5), (7, 11), (13, 9), (5, 3), (3, 13), (1, 7), (11, 15), (15, 1)],
    16: [(9, 9), (7, 5), (5, 10), (12, 7), (3, 6), (10, 13), (13, 11), (11, 3), (6, 14), (8, 1), (4, 2), (2, 12), (0, 8),
         (15, 4), (14, 15), (1, 0)],
}
FILL_RULES = {  # C3: sign of the x shift, sign of the y shift, whether x dominates
    "top_left": (1, 1, True), "top_right": (-1, 1, True), "bottom_left": (1, -1, True), "bottom_right": (-1, -1, True),
    "southwards": (1, 1, False), "southwards_west": (-1, 1, False),
    "northwards": (1, -1, False), "northwards_west": (-1, -1, False),
}
EMPTY = 0xFFFFFFFF
LARGEST = Fraction((2**24 - 1) * 2**104)


# ---------------------------------------------------------------- numbers
def from_bits(text):
    return struct.unpack(">f", bytes.fromhex(text))[0]


def to_bits(number):
    return struct.pack(">f", number).hex()


def store(real):
    """I4: the finite float32 nearest to a Fraction, zero as +0."""
    size = abs(real)
    if size == 0:
        return 0.0
    exponent = size.numerator.bit_length() - size.denominator.bit_length()
    if size < Fraction(2) ** exponent:
        exponent -= 1
    step = Fraction(2) ** (max(exponent, -126) - 23)
    rounded = min(round(size / step) * step, LARGEST)  # round() takes ties to even
    return float(rounded if real > 0 else -rounded) if rounded else 0.0


def sign(number):
    return (number > 0) - (number < 0)


def unroll(runs):
    return [value for run, value in zip(runs[::2], runs[1::2]) for _ in range(run)]


def tie(a, b, rule):
    """C3: what the perturbation adds to a value that is 0 and changes by a along x and by b along y."""
    x, y, x_dominates = FILL_RULES[rule]
    first, second = (x * a, y * b) if x_dominates else (y * b, x * a)
    return sign(first or second)


def cross(u, v):
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def dot(u, v):
    return sum(a * b for a, b in zip(u, v))


# ---------------------------------------------------------------- a triangle
class Triangle:
    """A sample is (x, y, w): the point (x / w, y / w), whole numbers, w > 0."""

    def __init__(self, vertices, attributes, draw):
        self.attributes, self.draw, self.grid = attributes, draw, draw.get("grid")
        exact = [[Fraction(number) for number in vertex] for vertex in vertices]
        scale = max(number.denominator for vertex in exact for number in vertex)
        self.vertices = [[int(number * scale) for number in vertex] for vertex in exact]  # X, Y, Z, W times one number
        self.m = [(x, y, w) for x, y, _, w in self.vertices]
        self.edges = [cross(self.m[1], self.m[2]), cross(self.m[2], self.m[0]), cross(self.m[0], self.m[1])]
        self.d = dot(self.m[0], self.edges[0])
        self.polygon = self.clipped() if self.grid and not self.holds_eye() else []
        if self.grid:
            self.snapped = [self.snap(corner) for corner in self.polygon]
            depths = [Fraction(z, w) for _, _, z, w in self.polygon] or [Fraction(0)]
            self.nearest, self.farthest = min(depths), max(depths)

    def holds_eye(self):
        """Whether the closed hull of m0, m1, m2 contains the origin."""
        if self.d:
            return False
        n = self.edges
        pairs = [(self.m[1], self.m[2], n[0]), (self.m[2], self.m[0], n[1]), (self.m[0], self.m[1], n[2])]
        if any(not any(normal) and dot(u, v) <= 0 for u, v, normal in pairs):
            return True
        return dot(n[0], n[1]) > 0 and dot(n[1], n[2]) > 0 and dot(n[2], n[0]) > 0

    def clipped(self):
        """G1: the path v0 v1 v2 v0 cut to the guard band, one half-space after another."""
        path = self.vertices
        for axis in (0, 1):
            for side in (1, -1):
                height = [(2**14 + 1) * corner[3] - side * corner[axis] for corner in path]
                cut = []
                for k, corner in enumerate(path):
                    following, h, g = path[(k + 1) % len(path)], height[k], height[(k + 1) % len(path)]
                    if h >= 0:
                        cut.append(corner)
                    if h * g < 0:
                        cut.append([abs(g) * a + abs(h) * b for a, b in zip(corner, following)])
                path = cut
        return path

    def snap(self, corner):
        """Section 6: where a corner goes, in units of 2^-(bits + 4) pixels."""
        scale, place = 2 ** self.grid["bits"], []
        for axis in (0, 1):
            offset = self.grid["offset"][axis]
            steps = Fraction(corner[axis], corner[3]) * scale - Fraction(offset, 16)
            rounding = self.grid["rounding"]
            k = round(steps) if rounding == "nearest_even" else \
                math.floor(steps + Fraction(1, 2)) if rounding == "nearest_up" else math.trunc(steps)
            place.append(16 * k + offset)
        return place

    def at(self, p):
        return [dot(edge, p) for edge in self.edges]

    def facing(self, p):
        """Sign of the cover of p: 0 if it is not covered (C1 to C3; under Grid the winding number of G1)."""
        rule = self.draw["fill_rule"]
        if not self.grid:
            covered = self.d and all(sign(value or tie(edge[0], edge[1], rule)) == sign(self.d)
                                     for edge, value in zip(self.edges, self.at(p)))
            return sign(self.d) if covered else 0
        scale, winding = 2 ** (self.grid["bits"] + 4), 0
        x, y = p[0] * scale // p[2], p[1] * scale // p[2]
        for k, (ax, ay) in enumerate(self.snapped):
            bx, by = self.snapped[(k + 1) % len(self.snapped)]
            above = (y - ay or tie(0, 1, rule)) > 0, (y - by or tie(0, 1, rule)) > 0
            turn = sign((bx - ax) * (y - ay) - (x - ax) * (by - ay)) or tie(ay - by, bx - ax, rule)
            if above[0] != above[1]:
                winding += (above == (True, False) and turn > 0) - (above == (False, True) and turn < 0)
        return winding

    def depth(self, p):
        """I1, G2: the real depth, before clip and clamp."""
        if self.grid:
            if self.d == 0:
                return self.nearest
            return min(max(self.plane(p), self.nearest), self.farthest)
        return self.plane(p)

    def plane(self, p):
        return Fraction(sum(v[2] * e for v, e in zip(self.vertices, self.at(p))), self.d * p[2])

    def weights(self, p):
        """The E_i that count (G2), divided by p's w."""
        values = [Fraction(e, p[2]) for e in self.at(p)]
        return [e if e * self.d > 0 else Fraction(0) for e in values] if self.grid else values

    def place(self, samples, number, by_centroid):
        """M1: where the attributes of the pixel's sample `number` are evaluated."""
        p = samples[number]
        if len(samples) == 1 or (self.grid and self.d == 0):
            return p
        centre = (p[0] // 16 * 16 + 8, p[1] // 16 * 16 + 8, 16)
        if not by_centroid and sum(self.weights(centre)) * self.d > 0:
            return centre
        if self.facing(centre):
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

    def barycentrics(self, p):
        return [self.interpolate(p, [Fraction(i == k) for i in range(3)], "perspective") for k in range(3)]

    # M4
    def conservatively(self, x, y, mode):
        if self.d == 0:
            return False
        square = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)]
        for a, b, c in self.edges:
            height = [(a * px + b * py + c) * sign(self.d) for px, py in square]
            if mode == "inner" and min(height) < 0:
                return False
            cut = []
            for k, (point, h) in enumerate(zip(square, height)):
                following, g = square[(k + 1) % len(square)], height[(k + 1) % len(square)]
                if h >= 0:
                    cut.append(point)
                if h * g < 0:
                    t = Fraction(h) / (h - g)
                    cut.append(tuple(u + t * (v - u) for u, v in zip(point, following)))
            square = cut
        return bool(square)


# ---------------------------------------------------------------- models of others (section 11)
def model_answer(triangle, model, p):
    """R5 to R9 with boxes that are points: 1 covered, 0 not covered, None open."""
    x, y, d = Fraction(p[0], p[2]), Fraction(p[1], p[2]), triangle.d
    places = [(Fraction(mx, w), Fraction(my, w)) for mx, my, w in triangle.m if w > 0]
    if len(places) < 3 or any(abs(q) > 2**14 for place in places for q in place):  # R9
        m = triangle.m
        size = sum(abs(m[0][i] * m[1][j] * m[2][k]) for i in range(3) for j in range(3) for k in range(3)
                   if len({i, j, k}) == 3)
        if abs(d) * 2**20 <= size:
            return None
        half = Fraction(1, 16) + Fraction(1, 2 ** model["bits"])
        square = [(x + u, y + v, 1) for u in (-half, half) for v in (-half, half)]
        values = [[dot(edge, q) * sign(d) for q in square] for edge in triangle.edges]
        return 1 if min(map(min, values)) > 0 else 0 if min(map(max, values)) < 0 else None
    (ax, ay), (bx, by), (cx, cy) = path = [tuple(Fraction(round(q * 2 ** model["bits"]), 2 ** model["bits"]) for q in place)
                                           for place in places]
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if sign(area) != sign(d):  # R8: open in the closed hull
        turns = [sign((v[0] - u[0]) * (y - u[1]) - (v[1] - u[1]) * (x - u[0])) for u, v in zip(path, path[1:] + path[:1])]
        inside = all(t * (sign(area) or t) >= 0 for t in turns) if area else not any(turns)
        within = min(q[0] for q in path) <= x <= max(q[0] for q in path) and min(q[1] for q in path) <= y <= max(q[1] for q in path)
        return None if inside and within else 0
    for (ux, uy), (vx, vy) in zip(path, path[1:] + path[:1]):
        value = ((vx - ux) * (y - uy) - (vy - uy) * (x - ux)) * sign(area)
        if (value or tie((uy - vy) * sign(area), (vx - ux) * sign(area), triangle.draw["fill_rule"])) <= 0:
            return 0
    return 1 if area else 0


def granted(function, p, model):
    """R11: the least and the largest value within the model's distance of p, on both axes."""
    within = Fraction(*model["within"])
    values = [function((Fraction(p[0], p[2]) + u, Fraction(p[1], p[2]) + v, 1))
              for u in (-within, within) for v in (-within, within)]
    return min(values), max(values)


# ---------------------------------------------------------------- frames
def read_triangles(draw, statistics):
    """B1, V2: (triangle, index) of those that are drawn; statistics are M11's."""
    vertices = [[from_bits(text) for text in vertex] for vertex in draw["vertices"]["bits"]]
    for vertex, decimals in zip(vertices, draw["vertices"]["decimal"]):
        assert [to_bits(n) for n in vertex] == [to_bits(float(d)) for d in decimals] or any(map(math.isnan, vertex))
    arrays = [[[from_bits(text) for text in vertex] for vertex in array["bits"]] for array in draw.get("attributes", [])]
    drawn = []
    for position, corners in enumerate(draw["triangles"]):
        numbers = [n for k in corners for n in vertices[k] + [u for array in arrays for u in array[k]]]
        if not all(map(math.isfinite, numbers)):
            statistics["dropped"] += 1
            continue
        values = [[[Fraction(array[k][c]) for k in corners] for c in range(len(array[0]))] for array in arrays]
        triangle = Triangle([vertices[k] for k in corners], values, draw)
        culled = draw["cull"] != "none" and not draw.get("grid") and culls(draw, sign(triangle.d))
        degenerate = triangle.holds_eye() if draw.get("grid") else triangle.d == 0
        statistics["degenerate" if degenerate else "culled" if culled else "rasterized"] += 1
        identifiers = draw.get("identifiers")
        drawn.append((triangle, identifiers[position] if identifiers else position + draw.get("first_index", 0)))
    return drawn


def culls(draw, facing):
    front = (facing > 0) == (draw["front_face"] == "clockwise")  # F1
    return draw["cull"] == ("front" if front else "back")


def fragments(drawn, draw, model, samples, number):
    """M2 at one sample: (depth, index, position, triangle) of each triangle that is counted, and how many are open."""
    p, found, opened = samples[number], [], 0
    pixel = p[0] // 16, p[1] // 16
    left, top, right, bottom = draw.get("scissor") or (*pixel, pixel[0] + 1, pixel[1] + 1)
    if not (left <= pixel[0] < right and top <= pixel[1] < bottom):
        return found, opened
    for position, (triangle, index) in enumerate(drawn):
        if draw["conservative"] != "none":
            facing = sign(triangle.d) if triangle.conservatively(*pixel, draw["conservative"]) else 0
        elif model:
            answer = model_answer(triangle, model, p)
            opened += answer is None
            facing = sign(triangle.d) if answer else 0
        else:
            facing = triangle.facing(p)
        if not facing or culls(draw, facing):
            continue
        depth = 0.0
        if draw["conservative"] == "none" and not model:
            real = triangle.depth(p)
            if draw["depth"] == "clip" and not 0 <= real <= 1:  # I5
                continue
            depth = store(min(max(real, 0), 1) if draw["depth"] == "clamp" else real)
        found.append((depth, index, position, triangle))
    return found, opened


def visible(found, draw, kept, greater):
    """V1, M5: the fragment that a draw leaves at a sample, or None. `kept` is the depth before, None if anything beats it."""
    order = -1 if greater else 1
    passing = [f for f in found if kept is None or (f[0] > kept if greater else f[0] < kept)]
    if not passing:
        return None
    if not draw["depth_write"]:
        return max(passing, key=lambda f: (f[1], f[2]))
    return min(passing, key=lambda f: (order * f[0], f[1], f[2]))


def render(test, models):
    """Yields what each frame of the test is to look like, as the files write it."""
    target, model, previous = test["target"], models[test["model"]] if test["model"] != "exact" else None, None
    greater, by_centroid = target["depth_test"] == "greater", target["attribute_place"] == "centroid"
    x0, y0, x1, y1 = test.get("window") or (0, 0, target["width"], target["height"])
    for frame in test["frames"]:
        out = {name: [] for name in ("count", "open", "index", "depth", "barycentrics", "attributes")}
        out["statistics"] = dict.fromkeys(("dropped", "degenerate", "culled", "rasterized"), 0)
        initial = frame.get("initial_depth")
        if initial is not None:
            initial = previous if initial == "previous" else [from_bits(text) for text in unroll(initial)]
        draws = [(draw, read_triangles(draw, out["statistics"])) for draw in frame["draws"]]
        for y, x, s in ((y, x, s) for y in range(y0, y1) for x in range(x0, x1) for s in range(target["samples"])):
            samples = [(16 * x + u, 16 * y + v, 16) for u, v in LOCATIONS[target["samples"]]]
            at = ((y * target["width"]) + x) * target["samples"] + s
            kept = None if initial is None else initial[at]
            stored, count, opened, winner, seen = kept, 0, 0, None, []
            for draw, drawn in draws:
                found, undecided = fragments(drawn, draw, model, samples, s)
                count, opened, seen = count + len(found), opened + undecided, seen + found
                best = visible(found, draw, stored, greater)
                if best:
                    winner = best
                    if draw["depth_write"]:
                        stored = best[0]
            out["count"].append(count)
            out["open"].append(opened)
            only = count == 1 and not opened  # R12 leaves more than this to others
            if model:
                winner = seen[0] if only else None
            out["index"].append(winner[1] if winner else EMPTY)
            empty = -math.inf if greater else math.inf
            out["depth"].append(to_bits(empty if stored is None else stored))
            place = winner and winner[3].place(samples, s, by_centroid)
            if model:
                out["depth"][-1] = interval(winner[3].plane, place, model, winner[3]) if winner else None
            out["barycentrics"].append([to_bits(store(b)) for b in winner[3].barycentrics(place)] if winner else ["0" * 8] * 3)
            arrays = winner and winner[3].draw.get("attributes", [])
            out["attributes"].append([[
                attribute(winner[3], place, u, array["interpolation"], model) for u in values]
                for array, values in zip(arrays, winner[3].attributes)] if winner else None)
        previous = [from_bits(text) for text in out["depth"]] if not model else None
        yield out


def interval(function, p, model, triangle):
    low, high = granted(function, p, model)
    slack = model["roundings"] * max(abs(Fraction(v[2], v[3])) for v in triangle.vertices) / 2**23
    return to_bits(store(low - slack)) + ":" + to_bits(store(high + slack))


def attribute(triangle, p, values, kind, model):
    if not model:
        return to_bits(store(triangle.interpolate(p, values, kind)))
    low, high = granted(lambda q: triangle.interpolate(q, values, kind), p, model)
    return to_bits(store(low)) + ":" + to_bits(store(high))


def differences(test, models):
    for number, (frame, got) in enumerate(zip(test["frames"], render(test, models))):
        for name, expected in frame["expected"].items():
            if name == "statistics":
                pairs = [(name, expected, got[name])]
            elif name == "barycentrics":
                pairs = [(name, unroll(runs), [b[k] for b in got[name]]) for k, runs in enumerate(expected)]
            elif name == "attributes":
                pairs = [(name, unroll(runs), [a[k][c] if a else "0" * 8 for a in got[name]])
                         for k, array in enumerate(expected) for c, runs in enumerate(array)]
            else:
                pairs = [(name, unroll(expected), got[name])]
            for label, wanted, have in pairs:
                if wanted != have:
                    at = next((i for i, (a, b) in enumerate(zip(wanted, have)) if a != b), "length") if name != "statistics" else ""
                    yield f"frame {number} {label} {at}: {wanted[at] if at != '' and at != 'length' else wanted} " \
                          f"in the file, {have[at] if at != '' and at != 'length' else have} here"


def main(names):
    folder = pathlib.Path(__file__).resolve().parent
    tests = wrong = samples = 0
    for name in names or sorted(folder.glob("*.json")):
        document = json.loads(pathlib.Path(name).read_text(encoding="utf-8"))
        for test in document["tests"]:
            found = list(differences(test, document.get("models", {})))
            tests, wrong = tests + 1, wrong + bool(found)
            samples += sum(sum(frame["expected"]["count"][::2]) for frame in test["frames"])
            for line in found:
                print(f"{name}: test {test['id']}: {line}")
    print(f"{tests} tests, {samples} samples, {wrong} tests differ")
    return 1 if wrong or not tests else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
