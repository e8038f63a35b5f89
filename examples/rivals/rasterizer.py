#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A rasterizer in plain Python, in fifty lines: float64, vertices snapped to 1/256 pixel, top-left rule. Try it with
  surefill certify --command "python3 examples/rivals/rasterizer.py"     (docs/adapters.md has the messages)
It has count, index, depth and one attribute, and takes W <= 0; its profile is d3d11."""
from array import array
import struct, sys

INFO = struct.pack("<64s64s18I", b"plain Python", b"1", 23, 1, 0, 2, 8, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0)

def owns(p, q, s):  # the edge from p to q: what lies to its right, and on it if it is a top or a left one
    e = (q[0] - p[0]) * (s[1] - p[1]) - (q[1] - p[1]) * (s[0] - p[0])
    return e > 0 or e == 0 and (p[1] > q[1] or p[1] == q[1] and q[0] > p[0])

def covers(a, b, c, s):  # whichever way round; no sample if they lie in a line
    sides = (a, b), (b, c), (c, a)
    return all(owns(p, q, s) for p, q in sides) or all(owns(q, p, s) for p, q in sides)

def clip(polygon):  # to |X| <= 16385 W, |Y| <= 16385 W: what is left lies in front of the eye
    for axis, sign in (0, 1), (0, -1), (1, 1), (1, -1):
        sides, polygon = list(zip(polygon, polygon[1:] + polygon[:1])), []
        for v, w in sides:
            d, e = (16385 * p[3] - sign * p[axis] for p in (v, w))
            polygon += [v] * (d >= 0)
            if (d < 0) != (e < 0):
                polygon.append([p + d / (d - e) * (q - p) for p, q in zip(v, w)])
    return [v for v in polygon if v[3] > 0]

def draw(body):
    word, number = array("I", body), array("f", body)
    width, parts, at = word[1], word[9] if word[6] else 0, 35 + word[6]  # at: the vertices
    vertices, triangles = word[at - 26:at - 24] if word[7] else (0, 0)
    corners, values = at + 8 * vertices, at + 8 * vertices + 4 * triangles + 1
    image = [[0, 0xFFFFFFFF, float("inf")] + [0.0] * parts for _ in range(width * word[2])]
    for t in range(triangles):
        three, name = word[corners + 3 * t:corners + 3 * t + 3], word[corners + 3 * triangles + t]
        v = [list(number[at + 4 * i:at + 4 * i + 4]) for i in three]
        points = [(round(x / w * 256), round(y / w * 256)) for x, y, z, w in clip(v)]
        planes = [(q[1] * r[3] - r[1] * q[3], q[3] * r[0] - r[3] * q[0], q[0] * r[1] - r[0] * q[1])
                  for q, r in ((v[1], v[2]), (v[2], v[0]), (v[0], v[1]))]  # the edge functions E_i
        box = [range(min(c), max(c) + 1) for c in zip(*points)]
        for n, pixel in enumerate(image):
            s = (n % width * 256 + 128, n // width * 256 + 128)
            fan = zip(points[1:], points[2:]) if all(x in along for x, along in zip(s, box)) else ()
            if any(covers(points[0], p, q, s) for p, q in fan):
                e = [a * s[0] + b * s[1] + c * 256 for a, b, c in planes]
                mean = lambda u, ones: sum(x * k for x, k in zip(u, e)) / (sum(o * k for o, k in zip(ones, e)) or 1)
                z = array("f", [mean([p[2] for p in v], [p[3] for p in v])])[0]
                pixel[0] += 1
                if (z, name) < (pixel[2], pixel[1]):
                    rows = [number[values + parts * i:values + parts * i + parts] for i in three]
                    pixel[1:] = [name, z] + [mean(u, [1, 1, 1]) for u in zip(*rows)]
    columns = [array(kind, (p[i] for p in image)) for i, kind in enumerate("IIf")]
    columns += [array("f", (u for p in image for u in p[3:]))]
    return b"".join(column.tobytes() for bit, column in zip((1, 2, 4, 16), columns) if word[0] & bit)

while (header := sys.stdin.buffer.read(8)) and header[0] != 3:
    body = sys.stdin.buffer.read(4 * struct.unpack("<2I", header)[1])
    answer = INFO if header[0] == 1 else draw(body)
    sys.stdout.buffer.write(struct.pack("<2I", 0, len(answer) // 4) + answer)
    sys.stdout.buffer.flush()
