#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Pillow's ImageDraw.polygon under test.
  surefill certify --command "/usr/bin/python3 examples/rivals/pillow.py"            (Debian's package python3-pil)
Pixel (i, j) is from (i, j) to (i + 1, j + 1), as its manual says (Concepts, "Coordinate System").
"""
import pathlib, sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "python/surefill"))  # where the package is not installed
import numpy as np
import PIL
from PIL import Image, ImageDraw

from serving import each_triangle, serve


@each_triangle
def draw(xy, height, width):
    image = Image.new("L", (width, height))
    ImageDraw.Draw(image).polygon([tuple(p) for p in xy], fill=1)
    return np.asarray(image)


serve(draw, name="Pillow ImageDraw.polygon", version=PIL.__version__)
