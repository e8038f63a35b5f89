# SPDX-License-Identifier: Apache-2.0
"""An exact rasterizer as small as they come: edge functions in fractions, any fill rule."""
from fractions import Fraction

RULES = {"top_left": (1, 1, 0), "top_right": (-1, 1, 0), "bottom_left": (1, -1, 0), "bottom_right": (-1, -1, 0),
         "southwards": (1, 1, 1), "southwards_west": (-1, 1, 1), "northwards": (1, -1, 1), "northwards_west": (-1, -1, 1)}


def tie(a, b, rule):
    """On an edge, the sign that counts: of the sample moved by a very small step."""
    if rule in ("closed", "open"):
        return 1 if rule == "closed" else -1
    x, y, y_first = RULES[rule]
    return (y * b or x * a) if y_first else (x * a or y * b)


def covered(vertices, rule, x, y, fault=False):
    """Whether the triangle of three vertices (X, Y, Z, W) covers the centre of pixel (x, y)."""
    rule = "top_left" if fault else rule
    m = [(Fraction(v[0]), Fraction(v[1]), Fraction(v[3])) for v in vertices]
    edges = [(p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])
             for p, q in ((m[1], m[2]), (m[2], m[0]), (m[0], m[1]))]
    d = sum(u * e for u, e in zip(m[0], edges[0]))
    if d == 0:
        return False
    px, py = x + Fraction(1, 2), y + Fraction(1, 2)
    for a, b, c in edges:
        side = a * px + b * py + c
        if side == 0:
            side = tie(a, b, rule) * (1 if d > 0 or rule not in ("closed", "open") else -1)
        if side * d <= 0:
            return False
    return True
