#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""OpenCV's fillConvexPoly under test.
  surefill certify --command "/usr/bin/python3 examples/rivals/opencv.py"            (Debian's package python3-opencv)
Its pixels lie at whole numbers; positions are given with 8 bits of a pixel (shift), as whole numbers of 32 bits.
"""
import pathlib, sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "python/surefill"))  # where the package is not installed
import cv2
import numpy as np

from serving import Unsupported, each_triangle, serve


@each_triangle
def draw(xy, height, width):
    image = np.zeros((height, width), np.uint8)
    points = np.rint((xy - 0.5) * 256)
    if np.abs(points).max() >= 1 << 31:
        raise Unsupported("positions beyond its whole numbers")
    cv2.fillConvexPoly(image, points.astype(np.int32), 1, cv2.LINE_8, 8)
    return image


serve(draw, name="OpenCV fillConvexPoly", version=cv2.__version__)
