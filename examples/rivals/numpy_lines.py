# SPDX-License-Identifier: Apache-2.0
"""Triangles, lines and points of M7 in NumPy, behind version 2 of the adapter: thin lines by diamond exit, wide ones along the minor axis.

    surefill certify --command "python3 examples/rivals/numpy_lines.py"
"""
import numpy as np

import surefill


def thin(a, b, x, y):
    """The part of the line in each sample's open diamond is from `low` to `high` of its way: it leaves that before its end."""
    low, high, meets = np.full(x.shape, -np.inf), np.full(x.shape, np.inf), np.ones(x.shape, bool)
    for sx in (-1, 1):
        for sy in (-1, 1):
            slope, room = sx * (b[0] - a[0]) + sy * (b[1] - a[1]), 0.5 - sx * (a[0] - x) - sy * (a[1] - y)
            if slope == 0:
                meets &= room > 0
            elif slope > 0:
                high = np.minimum(high, room / slope)
            else:
                low = np.maximum(low, room / slope)
    return meets & (low < high) & (high > 0) & (high < 1)


def wide(a, b, x, y, width):
    x_major = abs(b[0] - a[0]) >= abs(b[1] - a[1])
    k = (x - a[0]) / (b[0] - a[0]) if x_major else (y - a[1]) / (b[1] - a[1])
    beside = y - a[1] - k * (b[1] - a[1]) if x_major else x - a[0] - k * (b[0] - a[0])
    return (k > 0) & (k < 1) & (abs(beside) < width / 2)


def covered(draw, v, x, y):
    if draw.primitive == "points":
        return np.maximum(abs(x - v[0, 0]), abs(y - v[0, 1])) < (draw.width or 1) / 2
    if draw.primitive == "lines":
        if (v[0] == v[1]).all():
            return np.zeros(x.shape, bool)
        return wide(v[0], v[1], x, y, draw.width) if draw.width else thin(v[0], v[1], x, y)
    edges = [(v[j, 0] - v[i, 0]) * (y - v[i, 1]) - (v[j, 1] - v[i, 1]) * (x - v[i, 0]) for i, j in ((0, 1), (1, 2), (2, 0))]
    return (np.minimum.reduce(edges) > 0) | (np.maximum.reduce(edges) < 0)


def draw(scene):
    y, x = np.mgrid[0:scene.height, 0:scene.width] + 0.5
    x, y = x + 2.0 ** -30, y + 2.0 ** -45  # C3's shift, small enough for what is drawn here
    image = np.zeros((scene.height, scene.width), np.uint32)
    for one in scene.draws:
        positions = one.positions.astype(np.float64)
        for corners in positions[one.triangles]:
            image += covered(one, corners[:, :2] / corners[:, 3:], x, y)
    return image


surefill.serve(draw, name="NumPy lines", outputs=["count"], primitives=["lines", "points"], features=["widths"])
