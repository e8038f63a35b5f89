#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""scikit-image's draw.polygon under test.
  surefill certify --command "/usr/bin/python3 examples/rivals/scikit_image.py"            (Debian's package python3-skimage)
Its pixels lie at whole numbers, and rows come before columns.
"""
import pathlib, sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "python/surefill"))  # where the package is not installed
import numpy as np
import skimage
from skimage.draw import polygon

from serving import each_triangle, serve


@each_triangle
def draw(xy, height, width):
    image = np.zeros((height, width), np.uint8)
    image[polygon(xy[:, 1] - 0.5, xy[:, 0] - 0.5, image.shape)] = 1
    return image


serve(draw, name="scikit-image draw.polygon", version=skimage.__version__)
