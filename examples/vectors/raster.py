# SPDX-License-Identifier: Apache-2.0
"""An exact rasterizer as small as they come: edge functions in whole numbers, any fill rule."""
from fractions import Fraction

RULES = {"top_left": (1, 1, 0), "top_right": (-1, 1, 0), "bottom_left": (1, -1, 0), "bottom_right": (-1, -1, 0),
         "southwards": (1, 1, 1), "southwards_west": (-1, 1, 1), "northwards": (1, -1, 1), "northwards_west": (-1, -1, 1)}


def tie(a, b, rule):
    """On an edge, the sign that counts: of the sample moved by a very small step."""
    if rule in ("closed", "open"):
        return 1 if rule == "closed" else -1
    x, y, y_first = RULES[rule]
    return (y * b or x * a) if y_first else (x * a or y * b)


def rasterize(vertices, rule, window, fault=False):
    """The pixels (x, y) of the window whose centre the triangle of three vertices (X, Y, Z, W) covers."""
    rule = "top_left" if fault else rule
    exact = [[Fraction(v[i]) for i in (0, 1, 3)] for v in vertices]
    scale = max(number.denominator for vertex in exact for number in vertex)
    m = [[int(number * scale) for number in vertex] for vertex in exact]
    edges = [(p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])
             for p, q in ((m[1], m[2]), (m[2], m[0]), (m[0], m[1]))]
    d = sum(u * e for u, e in zip(m[0], edges[0]))
    turn = (d > 0) - (d < 0)
    edges = [(a * turn, b * turn, c * turn) for a, b, c in edges if turn]
    x0, y0, x1, y1 = window
    for y in range(y0, y1):
        for x in range(x0, x1):
            sides = (a * (2 * x + 1) + b * (2 * y + 1) + 2 * c or tie(a, b, rule) for a, b, c in edges)
            if edges and all(side > 0 for side in sides):
                yield x, y
