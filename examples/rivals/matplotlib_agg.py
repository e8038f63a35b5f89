#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Agg without antialiasing, through matplotlib, under test.
  surefill certify --command "/usr/bin/python3 examples/rivals/matplotlib_agg.py"            (Debian's package python3-matplotlib)
"""
import pathlib, sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "python/surefill"))  # where the package is not installed
import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.path import Path
from matplotlib.transforms import Affine2D

from serving import each_triangle, serve


@each_triangle
def draw(xy, height, width):
    renderer = RendererAgg(width, height, 72)
    context = renderer.new_gc()
    context.set_antialiased(False)
    context.set_linewidth(0)
    up = Affine2D(np.array([[1.0, 0, 0], [0, -1, height], [0, 0, 1]]))  # y is up in matplotlib
    renderer.draw_path(context, Path(xy[[0, 1, 2, 0]]), up, (0.0, 0.0, 0.0))
    return np.frombuffer(bytes(renderer.buffer_rgba()), np.uint8).reshape(height, width, 4)[..., 3]


serve(draw, name="Agg in matplotlib, not antialiased", version=matplotlib.__version__)
