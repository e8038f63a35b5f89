# SPDX-License-Identifier: Apache-2.0
"""Surefill: an exact triangle rasterizer, for NumPy arrays.

    import numpy as np, surefill
    positions = surefill.opencv(points, K, R, t)                  # or to_pixel, opengl, orthographic, top_down
    raster = surefill.rasterize(positions, triangles, (height, width))
    raster.index, raster.depth, raster.barycentrics               # (height, width) uint32, float32; (height, width, 3) float32
    colours = surefill.interpolate(vertex_colours, raster)        # (height, width, C) float32
    metric = surefill.interpolate(positions[:, 3], raster)        # linear depth, in the points' units, of a camera with intrinsics K
    packed = raster.packed()                                      # (height, width, 4), as nvdiffrast lays it out

Coverage is decided on the given float32 values as real numbers; depth, barycentrics and attributes are the real value,
rounded once. The same bits on every machine. docs/semantics.md says what they are; docs/python.md has recipes.

Arrays of the right dtype that are C-contiguous are used where they lie. Others are converted where that changes no value (int64
triangles, float64 that float32 holds), or on request (convert=True). What is refused raises TypeError (dtype, not an array),
ValueError (shape, size, option) or IndexError (triangles); the message begins with the argument's name. The GIL is released
while triangles are drawn.

`serve` puts a rasterizer of yours under `surefill certify`: a function from a scene of arrays to images (serving.py).
"""

from . import _library
from ._cameras import opencv, opengl, orthographic, to_pixel, top_down
from ._draws import Draw, Grid
from ._frames import BLOCK, Context, Statistics, visit_coverage
from ._occlusion import OccluderMesh, OcclusionBuffer, SafeOcclusionBuffer
from ._library import sample_locations
from ._raster import NO_TRIANGLE, Raster, coverage, interpolate, rasterize, render
from .serving import Scene, SceneAttribute, SceneDraw, Unsupported, each_triangle, serve

__version__: str = _library.version().decode()
__all__ = ["BLOCK", "NO_TRIANGLE", "Context", "Draw", "Grid", "OccluderMesh", "OcclusionBuffer", "Raster", "SafeOcclusionBuffer",
           "Statistics", "coverage",
           "interpolate", "opencv", "opengl", "orthographic", "rasterize", "render", "sample_locations", "to_pixel", "top_down", "visit_coverage",
           "Scene", "SceneAttribute", "SceneDraw", "Unsupported", "each_triangle", "serve"]
