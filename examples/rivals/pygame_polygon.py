#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""pygame's draw.polygon under test.
  surefill certify --command "/usr/bin/python3 examples/rivals/pygame_polygon.py"            (Debian's package python3-pygame)
Its pixels lie at whole numbers; it takes whole numbers alone, so positions are rounded first. It goes through all rows of a
triangle, those beside the image too; what would take it seconds is declined.
"""
import pathlib, sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "python/surefill"))  # where the package is not installed
import os

import numpy as np

os.environ["PYGAME_HIDE_SUPPORT_PROMPT"] = "1"
import pygame

from serving import Unsupported, each_triangle, serve


@each_triangle
def draw(xy, height, width):
    if np.abs(xy).max() > 1 << 14:
        raise Unsupported("rows far beside the image")
    surface = pygame.Surface((width, height), depth=8)
    pygame.draw.polygon(surface, 1, [(x, y) for x, y in np.rint(xy - 0.5).tolist()])
    return pygame.surfarray.array2d(surface).T


serve(draw, name="pygame draw.polygon", version=pygame.version.ver)
