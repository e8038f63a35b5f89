#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# A rasterizer in plain Python: float64, vertices snapped to 1/256 pixel, top-left rule. Try it with
#   surefill certify --command "python3 examples/rivals/rasterizer.py"     (docs/adapters.md has the messages)
import struct
import sys
from array import array

COUNT, INDEX, DEPTH, ATTRIBUTES, EMPTY, GUARD = 1, 2, 4, 16, 0xFFFFFFFF, 2**14 + 1
INFO = struct.pack("<64s64s18I", b"plain Python", b"1", COUNT | INDEX | DEPTH | ATTRIBUTES, 1, 0,  # 1: W <= 0 is fine
                   2, 8, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0)  # grid of 8 bits, nearest even, top-left, profile d3d11


def edge(p, q, s):
    return (q[0] - p[0]) * (s[1] - p[1]) - (q[1] - p[1]) * (s[0] - p[0])


def covers(a, b, c, s):
    if edge(a, b, c) < 0:
        b, c = c, b
    owned = lambda p, q, e: e > 0 or e == 0 and (p[1] > q[1] or p[1] == q[1] and q[0] > p[0])
    return edge(a, b, c) != 0 and all(owned(p, q, edge(p, q, s)) for p, q in ((a, b), (b, c), (c, a)))


def clip(polygon):  # to |X| <= GUARD W, |Y| <= GUARD W: what is left lies in front of the eye
    for axis, sign in (0, 1), (0, -1), (1, 1), (1, -1):
        inside = [GUARD * v[3] - sign * v[axis] for v in polygon]
        pairs, polygon = list(zip(polygon, inside, polygon[1:] + polygon[:1], inside[1:] + inside[:1])), []
        for v, d, w, e in pairs:
            polygon += [v] * (d >= 0)
            if (d < 0) != (e < 0):
                polygon.append([p + d / (d - e) * (q - p) for p, q in zip(v, w)])
    return [v for v in polygon if v[3] > 0]


def draw_triangle(image, width, height, identifier, vertices, attributes):
    corners = [(round(x / w * 256), round(y / w * 256)) for x, y, z, w in clip(vertices)]
    cross = lambda p, q: (p[1] * q[3] - q[1] * p[3], p[3] * q[0] - q[3] * p[0], p[0] * q[1] - q[0] * p[1])
    planes = [cross(vertices[i - 2], vertices[i - 1]) for i in range(3)]  # the edge functions E_i
    ranges = [(max(0, min(c[k] for c in corners) // 256), min(size, max(c[k] for c in corners) // 256 + 1))
              for k, size in ((0, width), (1, height))] if corners else [(0, 0), (0, 0)]
    for y, x in ((y, x) for y in range(*ranges[1]) for x in range(*ranges[0])):
        sample = (x * 256 + 128, y * 256 + 128)
        if not any(covers(corners[0], corners[i - 1], corners[i], sample) for i in range(2, len(corners))):
            continue
        e = [a * (x + 0.5) + b * (y + 0.5) + c for a, b, c in planes]
        mean = lambda values, ones: sum(v * k for v, k in zip(values, e)) / (sum(o * k for o, k in zip(ones, e)) or 1)
        depth = array("f", [mean([v[2] for v in vertices], [v[3] for v in vertices])])[0]
        at = y * width + x
        image[COUNT][at] += 1
        if (depth, identifier) < (image[DEPTH][at], image[INDEX][at]):
            image[DEPTH][at], image[INDEX][at] = depth, identifier
            for k, values in enumerate(attributes):
                for c in range(len(values[0])):
                    image[ATTRIBUTES][k][at * len(values[0]) + c] = mean([v[c] for v in values], [1, 1, 1])


def draw(body):
    word, number, at = array("I", body), array("f", body), 9
    outputs, width, height, components = word[0], word[1], word[2], word[9:9 + word[6]]
    n, at = width * height, at + word[6]
    image = {COUNT: array("I", [0]) * n, INDEX: array("I", [EMPTY]) * n, DEPTH: array("f", [float("inf")]) * n,
             ATTRIBUTES: [array("f", [0]) * (n * c) for c in components]}
    for _ in range(word[7]):
        vertices, triangles, at = word[at], word[at + 1], at + 26
        position = [number[at + 4 * v:at + 4 * v + 4] for v in range(vertices)]
        indices, at = word[at + 8 * vertices:], at + 8 * vertices + 4 * triangles
        values = []
        for c in components:
            values.append([number[at + 1 + c * v:at + 1 + c * v + c] for v in range(vertices)])
            at += 1 + c * vertices
        for t in range(triangles):
            corner = indices[3 * t:3 * t + 3]
            draw_triangle(image, width, height, indices[3 * triangles + t], [list(position[v]) for v in corner],
                          [[v[c] for c in corner] for v in values])
    buffers = [image[bit] for bit in (COUNT, INDEX, DEPTH) if outputs & bit]
    return b"".join(b.tobytes() for b in buffers + (image[ATTRIBUTES] if outputs & ATTRIBUTES else []))


while header := sys.stdin.buffer.read(8):
    kind, words = struct.unpack("<2I", header)
    request = sys.stdin.buffer.read(4 * words)
    if kind == 3:
        break
    answer = INFO if kind == 1 else draw(request)
    sys.stdout.buffer.write(struct.pack("<2I", 0, len(answer) // 4) + answer)
    sys.stdout.buffer.flush()
