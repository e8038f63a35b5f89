#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""cairo's fill without antialiasing under test.
  surefill certify --command "/usr/bin/python3 examples/rivals/cairo_fill.py"            (Debian's package python3-cairo)
"""
import pathlib, sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "python/surefill"))  # where the package is not installed
import cairo
import numpy as np

from serving import each_triangle, serve


@each_triangle
def draw(xy, height, width):
    surface = cairo.ImageSurface(cairo.FORMAT_A8, width, height)
    context = cairo.Context(surface)
    context.set_antialias(cairo.ANTIALIAS_NONE)
    for point in xy:
        context.line_to(*point)
    context.fill()
    return np.frombuffer(surface.get_data(), np.uint8).reshape(height, surface.get_stride())[:, :width]


serve(draw, name="cairo, ANTIALIAS_NONE", version=cairo.cairo_version_string())
