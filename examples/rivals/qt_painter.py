#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Qt's QPainter without antialiasing under test.
  surefill certify --command "/usr/bin/python3 examples/rivals/qt_painter.py"            (Debian's package python3-pyqt5)
"""
import pathlib, sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "python/surefill"))  # where the package is not installed
import numpy as np
from PyQt5.QtCore import QT_VERSION_STR, QPointF, Qt
from PyQt5.QtGui import QImage, QPainter, QPolygonF

from serving import each_triangle, serve


@each_triangle
def draw(xy, height, width):
    image = QImage(width, height, QImage.Format_ARGB32_Premultiplied)
    image.fill(0)
    painter = QPainter(image)
    painter.setPen(Qt.NoPen)
    painter.setBrush(Qt.white)
    painter.drawPolygon(QPolygonF([QPointF(x, y) for x, y in xy.tolist()]))
    painter.end()
    pixels = np.frombuffer(image.constBits().asarray(image.sizeInBytes()), np.uint32)
    return pixels.reshape(height, width).copy()  # the memory ends with the image


serve(draw, name="Qt QPainter, not antialiased", version=QT_VERSION_STR)
