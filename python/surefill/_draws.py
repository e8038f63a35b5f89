# SPDX-License-Identifier: Apache-2.0
"""What is drawn, and how."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from . import _library as c
from ._arrays import choice, floats, number, whole, whole_numbers, wholes

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

Interpolations = Union[str, Sequence[str]]


class Grid(NamedTuple):
    """Positions are snapped to multiples of 2^-bits pixels first, as GPUs do."""

    bits: int
    """0..12; GPUs have 8."""
    rounding: str = "nearest_even"
    """"nearest_even", "nearest_up" or "truncate"."""
    offset: Tuple[int, int] = (0, 0)
    """x and y, 0..15, in 2^-(bits + 4) pixels."""


class Draw:
    """Triangles, lines or points in one state: what `render` takes a list of, and `rasterize` makes of its arguments.

    positions    (V, 4) float32, pixel-homogeneous: (X, Y, Z, W) is seen at pixel position (X/W, Y/W), x to the right, y down,
                 with depth Z/W. Any sign of W. `to_pixel` and the cameras make them. (N, V, 4): a batch of N images.
    triangles    (T, 3) whole numbers: rows of positions; (T, 2) where `primitive` is "lines", (T, 1) or (T,) where it is "points".
    attributes   (V, C), or (N, V, C) for a batch: a row for each vertex, any number of columns. (V,): one column, without an axis.
    interpolation  "perspective", "noperspective" or "flat" (the value of vertex 0), or a sequence of words, one a column.
    ranges       (N, 2) whole numbers: image k shows triangles from ranges[k, 0] on, ranges[k, 1] of them.
    identifiers  (T,) whole numbers, unique, none NO_TRIANGLE: what `index` holds instead of the row of triangles.
    first_index  what `index` holds for row 0, and so on. None: the triangles are numbered on from those of the draws before.
    fill_rule    who owns a sample exactly on an edge: top_left, top_right, bottom_left, bottom_right, ..., closed, open.
    front_face   "clockwise" or "counter_clockwise", on the screen; cull: "none", "front" or "back".
    depth_mode   outside 0 <= depth <= 1: "none" (all is kept), "clip" or "clamp".
    depth_write  False: seen where it is nearer, and hides nothing.
    depth_bias   (constant, slope): depth is Z/W + constant + slope m, m the steeper of the depth's slopes a pixel.
    conservative  whole pixels in place of samples: "over" those that a triangle touches, "inner" those that lie in it, "overlap"
                 those that share an area with it, "touched" those that it touches though it be a line or a point.
    scissor      (x0, y0, x1, y1), half-open, in pixels; grid: a Grid, or its bits.
    culling_box  (8, 4): corners whose hull contains the draw, so that it can be skipped as a whole.
    primitive    "triangles", "lines" or "points"; width: of lines, or the side of a point's square, in pixels, above 0. None: points
                 of 1 pixel, and thin lines, which cover the samples whose diamond they leave; these need one sample a pixel.
    convert      True: numbers of positions, attributes and culling_box that float32 does not hold are rounded to nearest.

    Arrays of the right dtype that are C-contiguous are used where they lie; others are converted where float32 or uint32 holds
    each value, and refused otherwise."""

    __slots__ = ("_positions", "_triangles", "_attributes", "_single", "_interpolation", "_ranges", "_identifiers",
                 "_first_index", "_state", "_depth_write", "_scissor", "_grid", "_culling_box", "_depth_bias", "_batch",
                 "_primitive", "_width")

    def __init__(self, positions: ArrayLike, triangles: ArrayLike, *, attributes: Optional[ArrayLike] = None,
                 interpolation: Interpolations = "perspective", ranges: Optional[ArrayLike] = None,
                 identifiers: Optional[ArrayLike] = None, first_index: Optional[int] = None, fill_rule: str = "top_left",
                 front_face: str = "clockwise", cull: str = "none", depth_mode: str = "none", depth_write: bool = True,
                 depth_bias: Optional[Tuple[float, float]] = None, conservative: str = "none",
                 scissor: Optional[Sequence[int]] = None, grid: Union[None, int, Grid] = None,
                 culling_box: Optional[ArrayLike] = None, primitive: str = "triangles", width: Optional[float] = None,
                 convert: bool = False) -> None:
        shape = np.shape(positions) if isinstance(positions, np.ndarray) else ()
        if len(shape) in (2, 3) and shape[-1] == 3:
            raise ValueError("positions: shape (any, 4) is needed, with W as the last column; a camera makes it of points "
                             "(surefill.opencv, opengl, orthographic), and of pixels and depth "
                             "numpy.column_stack([positions, numpy.ones(len(positions), numpy.float32)]) does")
        self._positions = floats("positions", positions, (None, 4), (None, None, 4), convert=convert)
        self._primitive = choice("primitive", primitive)
        self._width = None if width is None else number("width", width)
        if self._width is not None and not self._width > 0:
            raise ValueError(f"width: a number above 0 is needed, not {width!r}")
        corners = 3 - self._primitive
        shapes: List[Tuple[Optional[int], ...]] = [(None, corners), (None,)] if corners == 1 else [(None, corners)]
        self._triangles = whole_numbers("triangles", triangles, *shapes, error=IndexError).reshape(-1, corners)
        self._batch: Optional[int] = self._positions.shape[0] if self._positions.ndim == 3 else None
        self._ranges: Optional[List[Tuple[int, int]]] = None
        if ranges is not None:
            rows = whole_numbers("ranges", ranges, (self._batch, 2)).tolist()
            if any(first + many > len(self._triangles) for first, many in rows):
                raise ValueError(f"ranges: a range ends beyond the {len(self._triangles)} triangles")
            self._ranges, self._batch = [(first, many) for first, many in rows], len(rows)
        self._identifiers = None if identifiers is None else whole_numbers("identifiers", identifiers,
                                                                             (len(self._triangles),))
        self._first_index = None if first_index is None else whole("first_index", first_index, 0, 0xFFFFFFFF)
        self._state = tuple(choice(name, word) for name, word in (
            ("fill_rule", fill_rule), ("front_face", front_face), ("cull", cull), ("depth_mode", depth_mode),
            ("conservative", conservative)))
        self._depth_write = bool(depth_write)
        self._depth_bias: Optional[Tuple[float, float]] = None
        if depth_bias is not None:
            if not isinstance(depth_bias, (tuple, list)) or len(depth_bias) != 2:
                raise TypeError("depth_bias: a pair (constant, slope) is needed")
            self._depth_bias = (number("depth_bias", depth_bias[0]), number("depth_bias", depth_bias[1]))
        self._scissor = None if scissor is None else wholes("scissor", scissor, 4, -2**31, 2**31 - 1, "(x0, y0, x1, y1)")
        self._grid: Optional[Tuple[int, ...]] = None
        if grid is not None:
            grid = grid if isinstance(grid, Grid) else Grid(grid)
            self._grid = (whole("grid", grid.bits, 0, 12), *wholes("grid", grid.offset, 2, 0, 15, "an offset (x, y)"),
                          choice("grid", grid.rounding, "grid_rounding"))
        self._culling_box = None if culling_box is None else floats("culling_box", culling_box, (8, 4), convert=convert)
        self._set_attributes(attributes, interpolation, convert)

    def _set_attributes(self, attributes: Optional[ArrayLike], interpolation: Interpolations, convert: bool) -> None:
        self._attributes: Optional[NDArray[np.float32]] = None
        self._single, self._interpolation = False, [0]
        if attributes is None:
            words = [interpolation] if isinstance(interpolation, str) else list(interpolation)
        else:
            number_of = self._positions.shape[-2]
            values = floats("attributes", attributes, *self._attribute_shapes(number_of), convert=convert)
            self._single = values.ndim == 1
            self._attributes = values.reshape(-1, 1) if self._single else values
            columns = self._attributes.shape[-1]
            if columns == 0:
                raise ValueError("attributes: at least one column is needed")
            words = [interpolation] * columns if isinstance(interpolation, str) else list(interpolation)
            if len(words) != columns:
                raise ValueError(f"interpolation: one word, or {columns}, one for each column, are needed, not {len(words)}")
        self._interpolation = [choice("interpolation", word) for word in words]

    def _attribute_shapes(self, vertices: int) -> List[Tuple[Optional[int], ...]]:
        shapes: List[Tuple[Optional[int], ...]] = [(vertices, None), (vertices,)]
        return shapes if self._batch is None else [*shapes, (self._batch, vertices, None)]

    def _with(self, attributes: ArrayLike, interpolation: Interpolations, convert: bool) -> "Draw":
        """The same triangles with other attributes."""
        other = self._shallow()
        corners, shape = self._triangles.size, np.shape(attributes)
        if attributes is None:
            raise TypeError("attributes: a NumPy array is needed, not NoneType")
        if shape[:1] == (corners,) and corners != self._positions.shape[-2]:
            raise ValueError(f"attributes: {self._positions.shape[-2]} rows, one for each vertex, are needed, not {corners}; for "
                             "those of each triangle's corners draw positions[..., triangles.ravel(), :] with "
                             f"numpy.arange({corners}).reshape(-1, 3)")
        other._set_attributes(attributes, interpolation, convert)
        return other

    def _shallow(self) -> "Draw":
        other = object.__new__(Draw)
        for name in Draw.__slots__:
            setattr(other, name, getattr(self, name))
        return other

    def _own(self) -> "Draw":
        """The same, and no array in it is the caller's; without attributes."""
        other = self._shallow()
        other._attributes = None
        for name in ("_positions", "_triangles", "_identifiers", "_culling_box"):
            array = getattr(self, name)
            if array is not None:
                setattr(other, name, array.copy())
        return other

    def __repr__(self) -> str:
        batch = "" if self._batch is None else f"batch of {self._batch}, "
        columns = "" if self._attributes is None else f", {self._attributes.shape[-1]} columns"
        return f"<surefill.Draw: {batch}{self._positions.shape[-2]} vertices, {len(self._triangles)} triangles{columns}>"


def _pointer(array: Optional[NDArray[Any]]) -> Optional[int]:
    return None if array is None or array.size == 0 else array.ctypes.data


class Groups(NamedTuple):
    """Columns [first, last) that go into one attribute image, of up to four components."""

    first: int
    last: int


def column_groups(draws: Sequence[Draw]) -> List[Groups]:
    """The fewest groups whose columns are interpolated alike in each draw."""
    groups: List[Groups] = []
    columns = len(draws[0]._interpolation)
    first = 0
    for last in range(1, columns + 1):
        if (last == columns or last - first == c.MAX_COMPONENTS or
                any(d._interpolation[last] != d._interpolation[first] for d in draws)):
            groups.append(Groups(first, last))
            first = last
    return groups


def draw_structs(draws: Sequence[Draw], image: int, groups: Sequence[Groups],
                 numbers: Sequence[Tuple[Optional[NDArray[np.uint64]], Optional[NDArray[np.uint64]]]]) -> Tuple[Any, List[Any]]:
    """The C list of draws of one image of a batch, and what has to live as long. numbers: covered and visible of each draw."""
    structs, alive, following = c.array_of(c.Draw, []), [], 0
    if len(draws) > 1:
        structs = (c.Draw * len(draws))()
    for draw, struct, (covered, visible) in zip(draws, structs, numbers):
        positions = draw._positions if draw._positions.ndim == 2 else draw._positions[image]
        first, many = (0, len(draw._triangles)) if draw._ranges is None else draw._ranges[image]
        triangles = draw._triangles[first:first + many]
        struct.struct_size = ctypes.sizeof(c.Draw)
        struct.vertices, struct.vertex_count = _pointer(positions), positions.shape[0]
        struct.indices, struct.index_count = _pointer(triangles), triangles.size
        start = following if draw._first_index is None else draw._first_index
        struct.first_index = start + first
        following = start + len(draw._triangles)
        if draw._identifiers is not None:
            struct.identifiers, struct.identifier_count = _pointer(draw._identifiers[first:first + many]), many
            struct.first_index = 0
        (struct.fill_rule, struct.front_face, struct.cull, struct.depth_mode, struct.conservative) = draw._state
        struct.depth_write_off = not draw._depth_write
        struct.primitive = draw._primitive
        if draw._width is not None:
            c.set_float(struct, width=draw._width)
        if draw._scissor is not None:
            struct.scissor = ctypes.pointer(c.Scissor(*draw._scissor))
        if draw._grid is not None:
            struct.grid = ctypes.pointer(c.Grid(*draw._grid))
        if draw._depth_bias is not None:
            bias = c.DepthBias()
            c.set_float(bias, constant=draw._depth_bias[0], slope=draw._depth_bias[1])
            struct.depth_bias = ctypes.pointer(bias)
        struct.culling_box = _pointer(draw._culling_box)
        for name, array in (("covered", covered), ("visible", visible)):
            if array is not None:
                part = array[first:first + many]
                setattr(struct, name, _pointer(part))
                setattr(struct, name + "_count", part.size)
        if groups and draw._attributes is not None:
            values = draw._attributes if draw._attributes.ndim == 2 else draw._attributes[image]
            rows, columns = values.shape
            arrays = c.array_of(c.AttributeArray, [
                c.AttributeArray(None if rows == 0 else values.ctypes.data + 4 * g.first,
                                 0 if rows == 0 else values.size - g.first, g.last - g.first, columns,
                                 draw._interpolation[g.first]) for g in groups])
            struct.attributes, struct.attribute_count = arrays, len(groups)
            alive.append(arrays)
        alive.append((positions, triangles))
    return structs, alive


def batch_of(draws: Sequence[Draw]) -> Optional[int]:
    """The number of images, None where there is but one."""
    sizes = {draw._batch for draw in draws if draw._batch is not None}
    if len(sizes) > 1:
        raise ValueError(f"draws: batches of one size are needed, not of {' and '.join(map(str, sorted(sizes)))}")
    return sizes.pop() if sizes else None
