# SPDX-License-Identifier: Apache-2.0
"""Cameras: points to the pixel-homogeneous positions that `rasterize` takes.

All but to_pixel compute in float64, by sums and products in a fixed order, and round once, so that a vertex that triangles share
stays shared, and every machine gets the same bits."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional, Sequence, Tuple

import numpy as np

from . import _library as c
from ._arrays import any_array, check_shape, choice, floats, number, size_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


def to_pixel(clip: ArrayLike, size: Sequence[int], *, depth_range: Tuple[float, float] = (0.0, 1.0),
             clip_depth: str = "zero_to_one", clip_y: str = "up", convert: bool = False) -> NDArray[np.float32]:
    """Clip space to pixels: (V, 4) or (N, V, 4) float32 (x, y, z, w) to the same shape, which `rasterize` takes.

    size is (height, width). clip_depth is "zero_to_one" (Direct3D, Vulkan) or "minus_one_to_one" (OpenGL); clip_y is
    "up" or "down". Each number is the exact real value, rounded once, so shared vertices stay shared. float64 that float32
    does not hold is refused, or rounded first with convert=True."""
    height, width = size_of(size)
    array = floats("clip", clip, (None, 4), (None, None, 4), convert=convert)
    try:
        near, far = (number("depth_range", depth) for depth in depth_range)
    except (TypeError, ValueError):
        raise TypeError("depth_range: a pair of numbers is needed") from None
    out = np.empty_like(array)
    viewport = c.Viewport(0, 0, width, height)
    viewport.clip_depth_minus_one, viewport.clip_y_down = choice("clip_depth", clip_depth), choice("clip_y", clip_y)
    c.set_float(viewport, near_depth=near, far_depth=far)
    c.check(c.to_pixel(viewport, array.ctypes.data, array.size // 4, out.ctypes.data))
    return out


def _doubles(name: str, value: object, *shapes: Tuple[Optional[int], ...]) -> NDArray[np.float64]:
    array = any_array(name, value)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name}: numbers are needed, not {array.dtype}")
    check_shape(name, array, *shapes)
    return array.astype(np.float64)


def _product(left: NDArray[np.float64], right: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of matrices, or of a matrix and columns; summed from the left."""
    total: Any = left[..., :, 0, None] * right[..., 0, None, :]
    for k in range(1, left.shape[-1]):
        total = total + left[..., :, k, None] * right[..., k, None, :]
    return np.asarray(total)


def _positions(matrix: NDArray[np.float64], points: ArrayLike) -> NDArray[np.float32]:
    """(..., 4, 4) times (V, 3), or (N, V, 3), to (..., V, 4)."""
    columns = np.swapaxes(_doubles("points", points, (None, 3), (None, None, 3)), -1, -2)
    columns = np.concatenate([columns, np.ones_like(columns[..., :1, :])], axis=-2)
    with np.errstate(all="ignore"):
        return np.ascontiguousarray(np.swapaxes(_product(matrix, columns), -1, -2), np.float32)


def _rigid(R: ArrayLike, t: ArrayLike) -> NDArray[np.float64]:
    """[R | t; 0 0 0 1]."""
    rotation = _doubles("R", R, (3, 3), (None, 3, 3))
    shift = _doubles("t", t, (3,), (3, 1), (None, 3), (None, 3, 1))
    shift = shift.reshape(3, 1) if shift.size == 3 and rotation.ndim == 2 else shift.reshape(-1, 3, 1)
    shape = np.broadcast(rotation[..., 0, 0], shift[..., 0, 0]).shape
    matrix = np.zeros((*shape, 4, 4))
    matrix[..., :3, :3], matrix[..., :3, 3:], matrix[..., 3, 3] = rotation, shift, 1
    return matrix


def opencv(points: ArrayLike, K: ArrayLike, R: ArrayLike, t: ArrayLike) -> NDArray[np.float32]:
    """Points as OpenCV's pinhole camera sees them: (V, 3) in the world to (V, 4) positions; R (N, 3, 3) and t (N, 3): (N, V, 4).

    (X, Y, W) = K (R x + t), with X and Y half a pixel further, as OpenCV's pixel (0, 0) has its centre at (0, 0), and here at
    (1/2, 1/2). Z is -1, so that depth Z/W is -1 over the distance along the axis: the nearest is the least, which the depth test
    "less" wants. W is that distance: metric depth is `interpolate(positions[:, 3], raster)`. Lenses are not distorted: undistort
    the image instead (cv2.undistort)."""
    intrinsic = np.zeros((*any_array("K", K).shape[:-2], 4, 4))
    intrinsic[..., :3, :3] = _doubles("K", K, (3, 3), (None, 3, 3))
    intrinsic[..., 3, 3] = 1
    matrix = _product(intrinsic, _rigid(R, t))
    rows = matrix.copy()
    rows[..., 0, :] += 0.5 * matrix[..., 2, :]
    rows[..., 1, :] += 0.5 * matrix[..., 2, :]
    rows[..., 2, :] = (0, 0, 0, -1)
    rows[..., 3, :] = matrix[..., 2, :]
    return _positions(rows, points)


def opengl(points: ArrayLike, matrix: ArrayLike, size: Sequence[int], *, clip_depth: str = "minus_one_to_one",
           depth_range: Tuple[float, float] = (0.0, 1.0)) -> NDArray[np.float32]:
    """Points through a model-view-projection matrix, for columns (clip = matrix @ (x, y, z, 1)), (4, 4) or (N, 4, 4).

    A pyrr, GLM or moderngl matrix for rows is transposed first. clip_depth="zero_to_one" is for Direct3D and Vulkan. Meshes made
    for OpenGL have front_face="counter_clockwise". Row 0 of the images is the top one, where OpenGL has the bottom one."""
    clip = _positions(_doubles("matrix", matrix, (4, 4), (None, 4, 4)), points)
    return to_pixel(clip, size, clip_depth=clip_depth, depth_range=depth_range)


def orthographic(points: ArrayLike, box: Sequence[float], size: Sequence[int], *, R: Optional[ArrayLike] = None,
                 t: Optional[ArrayLike] = None) -> NDArray[np.float32]:
    """Points seen along parallel lines: (x, y) of R p + t within box = (left, top, right, bottom) fills the image, and depth is z.

    With top < bottom y points down, as in OpenCV's camera; give top > bottom where y points up. Without R and t the points are
    in the camera's space already."""
    height, width = size_of(size)
    left, top, right, bottom = (number("box", entry) for entry in box)
    if left == right or top == bottom:
        raise ValueError("box: it has no area")
    matrix = np.zeros((4, 4))
    matrix[0, 0], matrix[0, 3] = width / (right - left), -left * width / (right - left)
    matrix[1, 1], matrix[1, 3] = height / (bottom - top), -top * height / (bottom - top)
    matrix[2, 2] = matrix[3, 3] = 1
    if R is not None or t is not None:
        matrix = _product(matrix, _rigid(np.eye(3) if R is None else R, np.zeros(3) if t is None else t))
    return _positions(matrix, points)


def top_down(points: ArrayLike, bounds: Sequence[float], size: Sequence[int]) -> NDArray[np.float32]:
    """A map: x to the right, y up (to the north), z the height; bounds = (west, south, east, north).

    Depth is -z, so that the highest is seen: heights are -raster.depth, and the correctly rounded ones of the surface."""
    west, south, east, north = (number("bounds", entry) for entry in bounds)
    return orthographic(points, (west, north, east, south), size, R=np.diag([1.0, 1.0, -1.0]))
