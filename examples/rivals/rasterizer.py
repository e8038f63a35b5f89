#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# A rasterizer in plain Python: float64, vertices snapped to 1/256 pixel, top-left rule. Try it with
#   surefill certify --command "python3 examples/rivals/rasterizer.py"     (docs/adapters.md has the messages)
from array import array
import struct
import sys

# Has count, index, depth, one attribute; takes W <= 0. Grid of 8 bits, nearest even, top-left; profile d3d11.
INFO = struct.pack("<64s64s18I", b"plain Python", b"1", 23, 1, 0, 2, 8, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0)

def edge(p, q, s):
    return (q[0] - p[0]) * (s[1] - p[1]) - (q[1] - p[1]) * (s[0] - p[0])

def covers(a, b, c, s):
    if edge(a, b, c) < 0:
        b, c = c, b
    owned = lambda p, q, e: e > 0 or e == 0 and (p[1] > q[1] or p[1] == q[1] and q[0] > p[0])
    return edge(a, b, c) != 0 and all(owned(p, q, edge(p, q, s)) for p, q in ((a, b), (b, c), (c, a)))

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
    word, number, at = array("I", body), array("f", body), 9 + array("I", body)[6]
    width, pixels, parts = word[1], word[1] * word[2], word[9] if word[6] else 0
    count, index = array("I", [0]) * pixels, array("I", [0xFFFFFFFF]) * pixels
    depth, shade = array("f", [float("inf")]) * pixels, array("f", [0]) * (pixels * parts)
    vertices, triangles = word[at:at + 2] if word[7] else (0, 0)
    position = [list(number[at + 26 + 4 * v:at + 30 + 4 * v]) for v in range(vertices)]
    corner, values = at + 26 + 8 * vertices, at + 27 + 8 * vertices + 4 * triangles
    for t in range(triangles):
        three, name = word[corner + 3 * t:corner + 3 * t + 3], word[corner + 3 * triangles + t]
        v = [position[i] for i in three]
        points = [(round(x / w * 256), round(y / w * 256)) for x, y, z, w in clip(v)]
        planes = [(q[1] * r[3] - r[1] * q[3], q[3] * r[0] - r[3] * q[0], q[0] * r[1] - r[0] * q[1])
                  for q, r in ((v[1], v[2]), (v[2], v[0]), (v[0], v[1]))]  # the edge functions E_i
        box = [(min(c), max(c)) for c in zip(*points)]
        for pixel in range(pixels if points else 0):
            s = (pixel % width * 256 + 128, pixel // width * 256 + 128)
            if not all(low <= x <= high for x, (low, high) in zip(s, box)):
                continue
            if not any(covers(points[0], p, q, s) for p, q in zip(points[1:], points[2:])):
                continue
            e = [a * s[0] + b * s[1] + c * 256 for a, b, c in planes]
            mean = lambda u, ones: sum(x * k for x, k in zip(u, e)) / (sum(o * k for o, k in zip(ones, e)) or 1)
            z = array("f", [mean([p[2] for p in v], [p[3] for p in v])])[0]
            count[pixel] += 1
            if (z, name) < (depth[pixel], index[pixel]):
                depth[pixel], index[pixel] = z, name
                for c in range(parts):
                    shade[pixel * parts + c] = mean([number[values + parts * i + c] for i in three], [1, 1, 1])
    return b"".join(image.tobytes() for bit, image in ((1, count), (2, index), (4, depth), (16, shade)) if word[0] & bit)

while header := sys.stdin.buffer.read(8):
    kind, words = struct.unpack("<2I", header)
    body = sys.stdin.buffer.read(4 * words)
    if kind == 3:
        break
    answer = INFO if kind == 1 else draw(body)
    sys.stdout.buffer.write(struct.pack("<2I", 0, len(answer) // 4) + answer)
    sys.stdout.buffer.flush()
