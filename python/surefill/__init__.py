# SPDX-License-Identifier: Apache-2.0
"""Surefill: an exact triangle rasterizer, for NumPy arrays.

    import numpy as np, surefill
    positions = surefill.to_pixel(clip, size=(height, width))     # (V, 4) float32, clip space to pixels
    raster = surefill.rasterize(positions, triangles, (height, width))
    colours = surefill.interpolate(vertex_colours, raster)        # (height, width, C) float32
    packed = raster.packed()                                      # (height, width, 4), as nvdiffrast lays it out

Coverage is decided on the given float32 values as real numbers; depth, barycentrics and attributes are the real value,
rounded once. The same bits on every machine. docs/semantics.md says what they are.

Arrays are used where they lie, never copied: they must be C-contiguous and of the dtype that is asked for. What is not
raises TypeError (dtype, not an array), ValueError (shape, size, option) or IndexError (triangles); the message begins
with the argument's name. The GIL is released while triangles are drawn.

`serve` puts a rasterizer of yours under `surefill certify`: a function from a scene of arrays to images (serving.py).
"""

from __future__ import annotations

import dataclasses
import numbers
from typing import Optional, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

from . import _surefill
from ._words import WORDS
from .serving import Attribute, Draw, Scene, Unsupported, each_triangle, serve

__version__: str = _surefill.version
__all__ = ["NO_TRIANGLE", "Raster", "coverage", "interpolate", "rasterize", "to_pixel",
           "Attribute", "Draw", "Scene", "Unsupported", "each_triangle", "serve"]

NO_TRIANGLE: int = 0xFFFFFFFF
"""The index of a sample that no triangle covers."""


@dataclasses.dataclass(frozen=True)
class Raster:
    """What `rasterize` returns. With several samples a pixel, every array has one more axis, of the samples, after
    (height, width)."""

    index: NDArray[np.uint32]
    """(height, width): the visible triangle, NO_TRIANGLE where there is none."""
    depth: NDArray[np.float32]
    """(height, width): its depth Z/W; +inf (-inf for depth_test="greater") or the initial depth where there is none."""
    barycentrics: NDArray[np.float32]
    """(height, width, 3): its perspective-correct weights, one for each vertex; 0 where there is none."""
    _call: dict = dataclasses.field(repr=False)

    def packed(self) -> NDArray[np.float32]:
        """(height, width, 4) float32 as nvdiffrast's rasterize has it: the weights of vertices 0 and 1, depth, and the
        triangle's index + 1; all 0 where there is none. Row 0 is the top one, as everywhere here. ValueError where an
        index is too large for a float32 (from 2^24 - 1)."""
        hit = self.index != NO_TRIANGLE
        if hit.any() and int(self.index[hit].max()) + 1 > 1 << 24:
            raise ValueError("index: too large for a float32")
        out = np.zeros(self.index.shape + (4,), np.float32)
        out[..., 0:2] = self.barycentrics[..., 0:2]
        out[..., 2][hit] = self.depth[hit]
        out[..., 3][hit] = self.index[hit].astype(np.float32) + np.float32(1)
        return out


def _array(name: str, value: object, dtypes: Tuple[type, ...], shape: Tuple[Optional[int], ...]) -> np.ndarray:
    """`value` itself, if it is a C-contiguous array of one of the dtypes and of the shape (None: any length)."""
    if not isinstance(value, np.ndarray):
        raise TypeError(f"{name}: a NumPy array is needed, not {type(value).__name__}")
    if value.dtype not in dtypes:
        raise TypeError(f"{name}: dtype {' or '.join(np.dtype(d).name for d in dtypes)} is needed, not {value.dtype}")
    if value.ndim != len(shape) or any(n is not None and n != m for n, m in zip(shape, value.shape)):
        wanted = ", ".join("any" if n is None else str(n) for n in shape)
        raise ValueError(f"{name}: shape ({wanted}) is needed, not {value.shape}")
    if not value.flags.c_contiguous:
        raise ValueError(f"{name}: the array is not C-contiguous (numpy.ascontiguousarray makes a copy that is)")
    return value


def _choice(name: str, value: object) -> int:
    choices = WORDS[name]
    if value not in choices:
        raise ValueError(f"{name}: one of {', '.join(choices)} is needed, not {value!r}")
    return choices.index(value)


def _whole(name: str, value: object, low: int, high: int) -> int:
    if not isinstance(value, numbers.Integral) or isinstance(value, bool):
        raise TypeError(f"{name}: a whole number is needed, not {type(value).__name__}")
    if not low <= value <= high:
        raise ValueError(f"{name}: {value} is outside {low}..{high}")
    return int(value)


def _size(size: object) -> Tuple[int, int]:
    if not isinstance(size, Sequence) or isinstance(size, str) or len(size) != 2:
        raise TypeError("size: a pair (height, width) is needed")
    return (_whole("size", size[0], 1, _surefill.max_size), _whole("size", size[1], 1, _surefill.max_size))


def _draw_arguments(positions, triangles, size, *, samples, identifiers, fill_rule, front_face, cull, depth_test,
                    depth_mode, initial_depth, threads) -> dict:
    height, width = _size(size)
    if _whole("samples", samples, 1, 16) not in (1, 2, 4, 8, 16):
        raise ValueError(f"samples: 1, 2, 4, 8 or 16 is needed, not {samples}")
    shape = (height, width) if samples == 1 else (height, width, samples)
    _array("positions", positions, (np.float32,), (None, 4))
    # The bits of an int32 are taken as uint32: a negative index is out of range like one too large.
    triangles = _array("triangles", triangles, (np.uint32, np.int32), (None, 3)).view(np.uint32)
    if identifiers is not None:
        identifiers = _array("identifiers", identifiers, (np.uint32, np.int32), (len(triangles),)).view(np.uint32)
    if initial_depth is not None:
        _array("initial_depth", initial_depth, (np.float32,), shape)
    return dict(positions=positions, triangles=triangles, height=height, width=width, samples=int(samples),
                identifiers=identifiers, fill_rule=_choice("fill_rule", fill_rule),
                front_face=_choice("front_face", front_face), cull=_choice("cull", cull),
                depth_test=_choice("depth_test", depth_test), depth_mode=_choice("depth_mode", depth_mode),
                initial_depth=initial_depth, threads=_whole("threads", threads, 1, 256))


def _shape(call: dict) -> Tuple[int, ...]:
    shape = (call["height"], call["width"])
    return shape if call["samples"] == 1 else shape + (call["samples"],)


_NOTHING_ELSE = dict(attributes=[], interpolation=0, conservative=0, index=None, depth=None, barycentrics=None,
                     count=None)


def to_pixel(clip: NDArray[np.float32], size: Tuple[int, int], *, depth_range: Tuple[float, float] = (0.0, 1.0),
             clip_depth: str = "zero_to_one", clip_y: str = "up") -> NDArray[np.float32]:
    """Clip space to pixels: (V, 4) float32 (x, y, z, w) to the (V, 4) that `rasterize` takes.

    size is (height, width). clip_depth is "zero_to_one" (Direct3D, Vulkan) or "minus_one_to_one" (OpenGL); clip_y is
    "up" or "down". Each number is the exact real value, rounded once, so shared vertices stay shared."""
    height, width = _size(size)
    _array("clip", clip, (np.float32,), (None, 4))
    try:
        near_depth, far_depth = (float(d) for d in depth_range)
    except (TypeError, ValueError):
        raise TypeError("depth_range: a pair of numbers is needed") from None
    out = np.empty_like(clip, subok=False)
    _surefill.to_pixel(clip, out, width, height, near_depth, far_depth, _choice("clip_depth", clip_depth),
                       _choice("clip_y", clip_y))
    return out


def rasterize(positions: NDArray[np.float32], triangles: NDArray, size: Tuple[int, int], *, samples: int = 1,
              identifiers: Optional[NDArray] = None, fill_rule: str = "top_left", front_face: str = "clockwise",
              cull: str = "none", depth_test: str = "less", depth_mode: str = "none",
              initial_depth: Optional[NDArray[np.float32]] = None, threads: int = 1) -> Raster:
    """Draws triangles and returns who is seen at each sample.

    positions    (V, 4) float32, pixel-homogeneous: (X, Y, Z, W) is seen at pixel position (X/W, Y/W), x to the right, y
                 down, with depth Z/W. Any sign of W. `to_pixel` makes them from clip space.
    triangles    (T, 3) int32 or uint32, rows of positions.
    size         (height, width) in pixels, 1..16384 each.
    samples      a pixel: 1, 2, 4, 8 or 16.
    identifiers  (T,) int32 or uint32, unique, none NO_TRIANGLE: what `index` holds instead of the row of triangles.
    fill_rule    who owns a sample exactly on an edge: top_left, top_right, bottom_left, bottom_right, ...
    front_face   "clockwise" or "counter_clockwise", on the screen; cull: "none", "front" or "back".
    depth_test   "less" or "greater"; depth_mode outside 0..1: "none", "clip" or "clamp".
    initial_depth  (height, width) float32 that a triangle must beat.
    threads      1..256; the result does not depend on it.

    A triangle with a NaN or an infinity is dropped. The arrays are kept by the result, for `interpolate`."""
    call = _draw_arguments(positions, triangles, size, samples=samples, identifiers=identifiers, fill_rule=fill_rule,
                           front_face=front_face, cull=cull, depth_test=depth_test, depth_mode=depth_mode,
                           initial_depth=initial_depth, threads=threads)
    shape = _shape(call)
    index, depth = np.empty(shape, np.uint32), np.empty(shape, np.float32)
    barycentrics = np.empty(shape + (3,), np.float32)
    _surefill.render(**{**_NOTHING_ELSE, **call, "index": index, "depth": depth, "barycentrics": barycentrics})
    return Raster(index, depth, barycentrics, call)


def interpolate(attributes: NDArray[np.float32], raster: Raster, *,
                interpolation: str = "perspective") -> NDArray[np.float32]:
    """Attributes of the visible triangles: (V, C) float32, one row for each row of positions, to (height, width, C).

    Each number is the real value at the sample, correctly rounded: not a sum over rounded barycentrics, so the triangles
    are drawn once more; do not change the arrays given to `rasterize` in between. C is 1..4. interpolation is
    "perspective", "noperspective" or "flat" (the value of vertex 0). 0 where nothing is seen. A triangle with a NaN
    or an infinity among its attributes is dropped."""
    if not isinstance(raster, Raster):
        raise TypeError(f"raster: what rasterize returned is needed, not {type(raster).__name__}")
    call = raster._call
    _array("attributes", attributes, (np.float32,), (len(call["positions"]), None))
    if not 1 <= attributes.shape[1] <= 4:
        raise ValueError(f"attributes: 1 to 4 columns are needed, not {attributes.shape[1]}")
    out = np.empty(_shape(call) + (attributes.shape[1],), np.float32)
    _surefill.render(**{**_NOTHING_ELSE, **call, "attributes": [(attributes, out)],
                        "interpolation": _choice("interpolation", interpolation)})
    return out


def coverage(positions: NDArray[np.float32], triangles: NDArray, size: Tuple[int, int], *, samples: int = 1,
             fill_rule: str = "top_left", front_face: str = "clockwise", cull: str = "none", depth_mode: str = "none",
             conservative: str = "none", threads: int = 1) -> NDArray[np.uint32]:
    """How many triangles cover each sample, seen or not: (height, width) uint32. Arguments as for `rasterize`.

    conservative counts whole pixels instead of samples: "over" those that the triangle touches, "inner" those that lie
    in it; with one sample a pixel and depth_mode "none" only."""
    call = _draw_arguments(positions, triangles, size, samples=samples, identifiers=None, fill_rule=fill_rule,
                           front_face=front_face, cull=cull, depth_test="less", depth_mode=depth_mode,
                           initial_depth=None, threads=threads)
    how = _choice("conservative", conservative)
    if how != 0 and (samples != 1 or depth_mode != "none"):
        raise ValueError("conservative: one sample a pixel and depth_mode none are needed")
    count = np.empty(_shape(call), np.uint32)
    _surefill.render(**{**_NOTHING_ELSE, **call, "conservative": how, "count": count})
    return count
