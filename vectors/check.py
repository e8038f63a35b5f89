#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Recomputes every expected value of the test vectors: check.py [--every N] [FILE...].

An independent reader in whole numbers and fractions, written from docs/semantics.md alone; the letters are the rules of that page. It has
no tolerance, no shortcut and no code of the project. Exit status 0: no difference; 1: differences, a line each.
"""
import argparse, itertools, json, math, operator, pathlib, struct, sys, time
from fractions import Fraction

LARGEST = (2**24 - 1) * 2**104
PLACES = {len(word) // 2: [(int(x, 16), int(y, 16)) for x, y in zip(word[::2], word[1::2])]  # S4: x and y in 1/16 pixel, a digit each
          for word in ("88", "cc44", "62e62aae", "957bd9533d17bff1", "99755ac736addbb36e81422c08f4ef10")}
SHIFTS = {  # C3: the signs of the shifts along x and y, and whether x dominates
    "top_left": (1, 1, True), "top_right": (-1, 1, True), "bottom_left": (1, -1, True), "bottom_right": (-1, -1, True),
    "southwards": (1, 1, False), "southwards_west": (-1, 1, False), "northwards": (1, -1, False), "northwards_west": (-1, -1, False)}
ROUNDINGS = {"nearest_even": round, "nearest_up": lambda real: math.floor(real + Fraction(1, 2)), "truncate": math.trunc}

def number(bits):
    return struct.unpack(">f", bytes.fromhex(bits))[0]

def nearest(real):
    """The bits of the finite float32 nearest to a real number, ties to even; zero is +0 (I4)."""
    real = max(-LARGEST, min(LARGEST, Fraction(real)))
    exponent = max(abs(real.numerator).bit_length() - real.denominator.bit_length() - 1, -126)
    exponent += abs(real) >= Fraction(2) ** (exponent + 1)
    return struct.pack(">f", math.ldexp(round(real / Fraction(2) ** (exponent - 23)), exponent - 23)).hex()

def sign(real):
    return (real > 0) - (real < 0)

def dot(u, v):
    return sum(x * y for x, y in zip(u, v))

def edge_function(u, v):
    """a, b and c of E(p) = det(u, v, p) = a px + b py + c (section 2)."""
    return u[1] * v[3] - u[3] * v[1], u[3] * v[0] - u[0] * v[3], u[0] * v[1] - u[1] * v[0]

def clip(path, x0, y0, x1, y1):
    """A closed path of (X, Y, Z, W), cut to x0 W <= X <= x1 W and y0 W <= Y <= y1 W, one half-space after another (G1)."""
    for axis, bound, inwards in (0, x0, 1), (0, x1, -1), (1, y0, 1), (1, y1, -1):
        before, path = path, []
        for here, there in zip(before, before[1:] + before[:1]):
            f, g = (inwards * (v[axis] - bound * v[3]) for v in (here, there))
            if f >= 0:
                path.append(here)
            if f * g < 0:
                path.append(tuple(abs(g) * x + abs(f) * y for x, y in zip(here, there)))
    return path

class Triangle:
    """A triangle under the state of its draw. Samples and places are (x, y, 16): where they are in space, in 1/16 pixel."""

    def __init__(self, state, vertices, origin=(0, 0)):
        self.state, self.m = state, vertices  # (X, Y, Z, W), whole numbers: a factor that all vertices share changes nothing
        self.grid, self.rule, self.conservative = state.get("grid"), state["fill_rule"], state["conservative"]
        self.front = 1 if state["front_face"] == "clockwise" else -1
        self.edges = [edge_function(vertices[i - 2], vertices[i - 1]) for i in range(3)]
        self.d = dot([v[3] for v in vertices], [c for _, _, c in self.edges])
        self.side = sign(self.d)
        self.plane = [dot([v[2] for v in vertices], coefficients) for coefficients in zip(*self.edges)]  # of z D (I1)
        self.corners, self.range = [], (0, 0)
        eye_axis = [v[3] for v in clip(vertices, 0, 0, 0, 0)]
        if self.grid and not (eye_axis and min(eye_axis) <= 0 <= max(eye_axis)):  # the hull does not contain the eye (G1)
            self.snap(*origin)
        constant, slope = (Fraction(number(bits)) for bits in state.get("depth_bias", ("00000000", "00000000")))
        self.bias = constant + (slope * max(map(abs, self.plane[:2])) / abs(self.d) if self.d else 0)  # I8

    def snap(self, x, y):
        """The snapped corners, in 2^-(bits + 4) pixels, and the range of the depth (G1, G2, S6)."""
        (bits, *offset, rounding), g = self.grid, 2**14 + 1
        polygon = clip(self.m, x - g, y - g, x + g, y + g)
        for v in polygon:
            exact = [Fraction(v[axis] * 2**bits, v[3]) - Fraction(offset[axis], 16) for axis in (0, 1)]
            self.corners.append([16 * ROUNDINGS[rounding](k) + shift for k, shift in zip(exact, offset)])
        depths = [Fraction(v[2], v[3]) for v in polygon] or [0]
        self.range = min(depths), max(depths)

    def winding(self, p):
        """N of G1: edges across the ray from the perturbed sample towards +x; those that go towards +y count 1, the others -1."""
        x, y = (c * 2 ** self.grid[0] for c in p[:2])
        turns = 0
        for (x0, y0), (x1, y1) in zip(self.corners, self.corners[1:] + self.corners[:1]):
            starts_below, ends_below = ((end - y or -SHIFTS[self.rule][1]) > 0 for end in (y0, y1))
            a, b = y0 - y1, x1 - x0
            side = sign(a * (x - x0) + b * (y - y0)) or self.tie(a, b)
            turns += side if starts_below != ends_below and side == (1 if ends_below else -1) else 0
        return turns

    def tie(self, a, b):
        """The sign that an edge function takes where it is 0 (C3, C5)."""
        if self.rule in ("closed", "open"):
            return self.side if self.rule == "closed" else -self.side
        x, y, x_dominates = SHIFTS[self.rule]
        return sign((a * x or b * y) if x_dominates else (b * y or a * x))

    def weights(self, p):
        """The edge functions, positive where they have the sign of D; under Grid, 0 where they have not (G2)."""
        return [max(w, 0) if self.grid else w for w in (self.side * dot(edge, p) for edge in self.edges)]

    def turn(self, p):
        """1 or -1 where the triangle covers p, the way in which it turns there, or 0 (C1 to C5, G1)."""
        if self.grid or self.conservative != "none":
            return self.winding(p) if self.grid else self.turn_of_square(p[0] // 16, p[1] // 16)
        return self.side * all(w > 0 or w == 0 and self.side == self.tie(*edge[:2]) for w, edge in zip(self.weights(p), self.edges))

    def turn_of_square(self, x, y):
        """The same of a pixel in a conservative draw (M4, M4a, M4b)."""
        part = [v for v in clip(self.m, x, y, x + 1, y + 1) if v[3] > 0]
        if self.d == 0:
            return -self.front if part and self.conservative == "touched" else 0
        if self.conservative == "inner":
            return self.side * all(min(self.weights((x + i, y + j, 1))) >= 0 for i in (0, 1) for j in (0, 1))
        if self.conservative == "overlap":
            return self.side * any(dot((v[0], v[1], v[3]), edge_function(part[0], u)) for u, v in zip(part, part[1:]))
        return self.side * bool(part)

    def facing(self, p):
        """1 where a front face is drawn, -1 where a back face is, else 0 (F1, F2, M3)."""
        x, y = p[0] // 16, p[1] // 16
        x0, y0, x1, y1 = self.state.get("scissor", (x, y, x + 1, y + 1))
        face = self.front * self.turn(p) if x0 <= x < x1 and y0 <= y < y1 else 0
        return 0 if face == {"none": 0, "front": 1, "back": -1}[self.state["cull"]] else face

    def stored_depth(self, p):
        """The bits of the depth at p, or None if it is clipped (I1, I4, I5, I8, G2)."""
        z = Fraction(dot(self.plane, p), 16 * self.d) if self.d else self.range[0]
        if self.grid:
            z = max(self.range[0], min(self.range[1], z))
        if self.state["depth_mode"] == "clip" and not 0 <= z <= 1:
            return None
        return nearest(max(0, min(1, z + self.bias)) if self.state["depth_mode"] == "clamp" else z + self.bias)

    def values(self, p, attributes):
        """Attributes at p, each of them given as its interpolation and the values of the vertices (I2, I3, G2)."""
        weights = self.weights(p)
        by_w = [w * v[3] for w, v in zip(weights, self.m)]
        linear = by_w, sum(by_w) if self.grid else 16 * abs(self.d)
        for interpolation, u in attributes:
            factors, total = linear if interpolation == "noperspective" else (weights, sum(weights))
            yield u[0] if interpolation == "flat" or total == 0 else dot(u, factors) / Fraction(total)

    def place(self, p, target):
        """Where the attributes of a sample are taken (M1)."""
        if target["samples"] == 1:
            return p
        x, y = p[0] // 16 * 16, p[1] // 16 * 16
        centre = x + 8, y + 8, 16
        if sum(self.weights(centre)) > 0 if target["attribute_location"] == "centre" else self.turn(centre):
            return centre
        return next(place for i, j in target["sample_locations"] if self.turn(place := (x + i, y + j, 16)))

def runs(words):
    return [value for length, value in zip(words[::2], words[1::2]) for _ in range(length)]

def triangles_of(draw, target):
    """The triangles that are not dropped (B1), with index, position, barycentrics and attributes."""
    vertices = [[number(bits) for bits in vertex] for vertex in draw["vertices"]["bits"]]
    arrays = [(array["interpolation"], [[number(bits) for bits in row] for row in array["bits"]]) for array in draw.get("attributes", [])]
    for position, corners in enumerate(draw["triangles"]):
        rows = [[rows[k] for k in corners] for rows in [vertices] + [rows for _, rows in arrays]]
        if not all(math.isfinite(u) for u in itertools.chain(*itertools.chain(*rows))):
            continue
        whole = [[int(Fraction(u) * 2**149) for u in row] for row in rows[0]]
        factor = math.gcd(*itertools.chain(*whole)) or 1
        triangle = Triangle(draw["state"], [tuple(u // factor for u in row) for row in whole], target["origin"])
        triangle.index = draw["identifiers"][position] if "identifiers" in draw else draw["first_index"] + position
        triangle.position = position
        triangle.attributes = [("perspective", [int(i == j) for j in range(3)]) for i in range(3)]
        for (interpolation, _), used in zip(arrays, rows[1:]):
            triangle.attributes += [(interpolation, list(map(Fraction, component))) for component in zip(*used)]
        yield triangle

def samples_of(test):
    """The samples of the window: the number in the whole target, and the place in space."""
    target = test["target"]
    (x0, y0, x1, y1), (ox, oy) = test["window"], target["origin"]
    for y, x, (s, (i, j)) in itertools.product(range(y0, y1), range(x0, x1), list(enumerate(target["sample_locations"]))):
        yield (y * target["width"] + x) * target["samples"] + s, (16 * (ox + x) + i, 16 * (oy + y) + j, 16)

def draw_sample(target, draws, p, initial):
    """Count, winding and layers of a sample; a layer is its depth and its triangle, or None (V1 to V5, M2, M4c, M5, M9)."""
    nearer = 1 if target["depth_test"].startswith("less") else -1
    later, beats = (-1, operator.le) if target["depth_test"].endswith("equal") else (1, operator.lt)
    faces, fragments, depth, visible = [], [], initial, None
    for n, triangles in enumerate(draws):
        drawn = [(t, t.stored_depth(p)) for t in triangles if t.facing(p)]
        drawn = [(number(z) * nearer, n * later, t.index * later, t.position * later, z, t) for t, z in drawn if z]
        faces += [fragment[-1] for fragment in drawn]
        fragments += [fragment for fragment in drawn if beats(fragment[0], number(initial) * nearer)]
        passing = [fragment for fragment in drawn if beats(fragment[0], number(depth) * nearer)]
        if passing and passing[0][-1].state["depth_write"]:
            depth, visible = min(passing)[-2:]
        elif passing:
            visible = max((fragment[-1] for fragment in passing), key=lambda t: (t.index, t.position))
    layers = [(depth, visible)]
    if target["layers"] > 1:
        layers = [fragment[-2:] for fragment in sorted(fragments)] + [(initial, None)] * target["layers"]
    if any(t.conservative != "none" for triangles in draws for t in triangles):
        layers = [(depth, min(faces, key=lambda t: t.index, default=None))]
    return len(faces), sum(t.facing(p) for t in faces), layers

def exact(test, frame, before):
    """What the exact model gives: {output: its values}, barycentrics and components of attributes under their numbers."""
    target, given = test["target"], frame.get("initial_depth")
    draws = [list(triangles_of(draw, target)) for draw in frame["draws"]]
    numbers, spots = zip(*samples_of(test))
    cleared = ["7f800000" if target["depth_test"].startswith("less") else "ff800000"] * len(numbers)
    initial = before["depth"] if given == "previous" else [runs(given)[n] for n in numbers] if given else cleared
    samples = [draw_sample(target, draws, p, z) for p, z in zip(spots, initial)]
    layers = [(p, *s[2][n]) for n in range(target["layers"]) for p, s in zip(spots, samples)]
    found = {"count": [s[0] % 2**32 for s in samples], "winding": [(s[1] + 2**31) % 2**32 - 2**31 for s in samples],
             "depth": [z for _, z, _ in layers], "index": [t.index if t else 2**32 - 1 for _, _, t in layers], "open": [0] * len(samples)}
    if "barycentrics" in frame["expected"]:
        nothing = [0] * (3 + sum(map(len, frame["expected"].get("attributes", []))))
        rows = [t.values(t.place(p, target), t.attributes) if t else nothing for p, _, t in layers]
        found |= enumerate(map(list, zip(*(map(nearest, row) for row in rows))))
    return found

def answer(t, snapped, p, bits):
    """1 where a grid model says that the triangle covers p, 0 where it does not, None where it leaves that open (R7 to R9)."""
    if snapped:
        x, y = Fraction(p[0], 16), Fraction(p[1], 16)
        return abs(snapped.turn(p)) if snapped.side == t.side else None if clip(snapped.m, x, y, x, y) else 0
    if abs(t.d) * 2**20 <= sum(abs(u[0] * v[1] * w[3]) for u, v, w in itertools.permutations(t.m)):
        return None
    reach = 1 + Fraction(16, 2**bits)
    square = [t.weights((p[0] + i * reach, p[1] + j * reach, 16)) for i in (-1, 1) for j in (-1, 1)]
    return 1 if min(map(min, square)) > 0 else 0 if any(max(w) < 0 for w in zip(*square)) else None

def intervals(t, p, within, roundings):
    """What a grid model grants to depth, barycentrics and attributes (R11)."""
    attributes = [("noperspective", [Fraction(v[2], v[3]) for v in t.m])] + t.attributes
    square = [(p[0] + i * 16 * within, p[1] + j * 16 * within, 16) for i in (-1, 1) for j in (-1, 1)]
    for column, (interpolation, u) in zip(zip(*(t.values(corner, attributes) for corner in square)), attributes):
        known = interpolation != "perspective" or all(sum(t.weights(corner)) > 0 for corner in square)
        margin = roundings * max(map(abs, u[:1] if interpolation == "flat" else u))
        yield f"{nearest(min(column) - margin)}:{nearest(max(column) + margin)}" if known else "ff800000:7f800000"

def snapping(test, frame, model):
    """What a grid model gives; values are known where one triangle covers a sample and no other one may (R5, R12)."""
    bits, within, roundings = model["bits"], Fraction(*model["within"]), Fraction(*model["roundings"])
    pairs, rows = [], []
    for t in (t for draw in frame["draws"] for t in triangles_of(draw, test["target"])):
        near = all(v[3] > 0 and max(abs(v[0]), abs(v[1])) <= 2**14 * v[3] for v in t.m)
        corners = [(*(round(Fraction(v[axis] << bits, v[3])) for axis in (0, 1)), 0, 1 << bits) for v in t.m if near]
        pairs.append((t, near and Triangle(t.state, corners)))
    for _, p in samples_of(test):
        answers = [(answer(t, snapped, p, bits), t) for t, snapped in pairs]
        drawn = [t for said, t in answers if said != 0]
        opened = sum(said is None for said, _ in answers)
        known = "depth" in frame["expected"] and len(drawn) == 1 and not opened
        rows.append([len(drawn) - opened, opened, *(intervals(drawn[0], p, within, roundings) if known else ["ff800000:7f800000"] * 99)])
    return dict(zip(["count", "open", "depth", *range(96)], zip(*rows)))

def differences(test, models):
    """A line for each output that differs, of each model under which the test is owed."""
    target = {"origin": (0, 0), "layers": 1, "sample_locations": PLACES[test["target"]["samples"]]} | test["target"]
    test = {"window": (0, 0, target["width"], target["height"])} | test | {"target": target}
    for model in test["models"]:
        found = {}
        for n, frame in enumerate(test["frames"]):
            found = exact(test, frame, found) if model == "exact" else snapping(test, frame, models[model])
            expected = dict(frame["expected"])
            values = expected.pop("barycentrics", []) + sum(expected.pop("attributes", []), [])
            expected = {"open": [len(found["count"]), 0]} | expected | dict(enumerate(values))
            for draw in frame["draws"]:
                pairs = zip(*(itertools.chain(*draw["vertices"][form]) for form in ("bits", "decimal")))
                if any(struct.pack(">f", float(decimal)).hex() != bits for bits, decimal in pairs if decimal != "nan"):
                    yield f"test {test['id']}, frame {n}: decimals that are not the bits"
            for output, words in expected.items():
                pairs = list(enumerate(itertools.zip_longest(runs(words), found[output], fillvalue="nothing")))
                wrong = [f"number {s} is {owed}, here {here}" for s, (owed, here) in pairs if owed != here]
                if wrong:
                    yield f"test {test['id']} under {model}, frame {n}, output {output}: {len(wrong)} values differ, the first, {wrong[0]}"

def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--every", type=int, default=1, metavar="N", help="each Nth test alone")
    parser.add_argument("files", nargs="*", type=pathlib.Path, default=sorted(pathlib.Path(__file__).parent.glob("*.json")))
    options = parser.parse_args()
    tests = wrong = 0
    for path in options.files:
        subject = json.loads(path.read_text())
        chosen = subject["tests"][:: options.every]
        lines = [line for test in chosen for line in differences(test, subject["models"])]
        print(f"{path.name}: {len(chosen)} tests, {len(lines)} differences", *lines, sep="\n  ")
        tests, wrong = tests + len(chosen), wrong + len(lines)
    print(f"{tests} tests, {wrong} differences, {time.process_time() / 60:.1f} minutes of a processor")
    return 0 if tests and not wrong else 1

if __name__ == "__main__":
    sys.exit(main())
