# SPDX-License-Identifier: Apache-2.0
"""What users call: rasterize, interpolate, coverage, render."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from ._draws import Draw, Grid, Interpolations, batch_of
from ._frames import OUTPUTS, Context, Executor, Frame, Settings, Statistics, check_draws, draw_frames

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

NO_TRIANGLE: int = 0xFFFFFFFF
"""The index of a sample that no triangle covers."""

_DEFAULT = ("index", "depth", "barycentrics")
_ALL = (*OUTPUTS, "covered", "visible", "statistics")


class Raster:
    """What `rasterize` and `render` return: the images that were asked for, as properties.

    Their shape is (height, width); before it are axes of the batch and of the layers, after it those of the samples of a pixel and
    of components, each where there is one: (N, layers, height, width, samples, C) at most. `count` and `winding` have no layers.

    What `interpolate` draws again is a copy of the arrays that were given (of copy=False: the arrays themselves)."""

    __slots__ = ("_frame", "_draws", "_settings", "_listed")

    def __init__(self, frame: Frame, draws: Sequence[Draw], settings: Settings, listed: bool) -> None:
        self._frame, self._draws, self._settings, self._listed = frame, draws, settings, listed

    def _output(self, name: str) -> NDArray[Any]:
        if name not in self._frame.outputs:
            raise AttributeError(f"{name}: it was not asked for; outputs=[..., {name!r}] does")
        return self._frame.outputs[name]

    @property
    def index(self) -> NDArray[np.uint32]:
        """The visible triangle, NO_TRIANGLE where there is none."""
        return self._output("index")

    @property
    def mask(self) -> NDArray[np.bool_]:
        """Where a triangle is seen: index != NO_TRIANGLE."""
        return np.not_equal(self.index, NO_TRIANGLE)

    @property
    def depth(self) -> NDArray[np.float32]:
        """Its depth Z/W; +inf (-inf for "greater" and "greater_equal") or the initial depth where there is none."""
        return self._output("depth")

    @property
    def barycentrics(self) -> NDArray[np.float32]:
        """Its perspective-correct weights, one for each vertex (one more axis, of 3); 0 where there is none."""
        return self._output("barycentrics")

    @property
    def count(self) -> NDArray[np.uint32]:
        """How many triangles cover the sample, seen or not."""
        return self._output("count")

    @property
    def winding(self) -> NDArray[np.int32]:
        """Front-facing triangles minus back-facing ones that cover the sample."""
        return self._output("winding")

    @property
    def attributes(self) -> NDArray[np.float32]:
        """The attributes of the visible triangle (one more axis, of C, if they have columns); 0 where there is none."""
        if self._frame.attributes is None:
            raise AttributeError("attributes: none were given; rasterize(..., attributes=...) or interpolate(..., raster) does")
        return _columns(self._frame.attributes, self._draws)

    def _per_triangle(self, name: str) -> Any:
        if name not in self._frame.per_triangle:
            raise AttributeError(f"{name}: it was not asked for; outputs=[..., {name!r}] does")
        arrays = self._frame.per_triangle[name]
        found = [array if self._settings.batch is not None else array[0] for array in arrays]
        return found if self._listed else found[0]

    @property
    def covered(self) -> Any:
        """(T,) uint64: at how many samples each triangle is counted; of `render`, a list, of an array for each draw."""
        return self._per_triangle("covered")

    @property
    def visible(self) -> Any:
        """The same: at how many samples each triangle is the visible one, in the end."""
        return self._per_triangle("visible")

    @property
    def statistics(self) -> Any:
        """What became of the triangles: Statistics; of a batch, a list."""
        if not self._frame.statistics:
            raise AttributeError("statistics: they were not asked for; outputs=[..., 'statistics'] does")
        return self._frame.statistics[0] if self._settings.batch is None else self._frame.statistics

    def packed(self) -> NDArray[np.float32]:
        """(..., height, width, 4) float32 as nvdiffrast's rasterize has it: the weights of vertices 0 and 1, depth, and the
        triangle's index + 1; all 0 where there is none. Row 0 is the top one, as everywhere here. ValueError where an
        index is too large for a float32 (from 2^24 on)."""
        hit = self.mask
        if hit.any() and int(self.index[hit].max()) >= 1 << 24:
            raise ValueError("index: too large for a float32")
        out = np.zeros(self.index.shape + (4,), np.float32)
        out[..., 0:2] = self.barycentrics[..., 0:2]
        out[..., 2][hit] = self.depth[hit]
        out[..., 3][hit] = self.index[hit].astype(np.float32) + np.float32(1)
        return out

    def __repr__(self) -> str:
        s = self._settings
        axes = [f"{n} {what}" for n, what in ((s.batch, "images"), (s.layers, "layers")) if n is not None]
        axes += [f"{s.samples} samples"] if s.samples > 1 else []
        names = [*self._frame.outputs, *(["attributes"] if self._frame.attributes is not None else []), *self._frame.per_triangle,
                 *(["statistics"] if self._frame.statistics else [])]
        return f"<surefill.Raster {s.height} x {s.width}{''.join(', ' + axis for axis in axes)}: {', '.join(names)}>"


def _columns(values: NDArray[np.float32], draws: Sequence[Draw]) -> NDArray[np.float32]:
    return values[..., 0] if draws and draws[0]._single else values


def _outputs(outputs: Union[str, Sequence[str]]) -> Tuple[str, ...]:
    names = (outputs,) if isinstance(outputs, str) else tuple(outputs)
    for name in names:
        if name not in _ALL:
            raise ValueError(f"outputs: of {', '.join(_ALL)}, not {name!r}")
    return names


def _render(draws: List[Draw], settings: Settings, outputs: Union[str, Sequence[str]], copy: bool, out: Optional[Raster],
            listed: bool) -> Raster:
    if out is not None and not isinstance(out, Raster):
        raise TypeError("out: a raster of an earlier call is needed")
    given: Dict[str, NDArray[Any]] = {}
    if out is not None:
        given = dict(out._frame.outputs)
        if out._frame.attributes is not None:
            given["attributes"] = out._frame.attributes
    frame = draw_frames(draws, settings, _outputs(outputs), given)
    kept = [draw._own() for draw in draws] if copy else draws
    return Raster(frame, kept, settings.own() if copy else settings.kept(), listed)


def render(draws: Sequence[Draw], size: Sequence[int], *, outputs: Union[str, Sequence[str]] = _DEFAULT, samples: int = 1,
           depth_test: str = "less", layers: Optional[int] = None, origin: Sequence[int] = (0, 0),
           sample_locations: Optional[Sequence[Sequence[int]]] = None, initial_depth: Optional[ArrayLike] = None,
           attribute_location: str = "centre", threads: int = 1, path: str = "automatic", context: Optional[Context] = None,
           executor: Optional[Executor] = None, copy: bool = True, out: Optional[Raster] = None) -> Raster:
    """Draws a list of `Draw`, each in its own state, in order, each onto the image of those before it.

    size         (height, width) in pixels, 1..16384 each.
    outputs      of "index", "depth", "barycentrics", "count", "winding", "covered", "visible", "statistics": what is to be had;
                 no more is computed. Attributes are had where draws have them.
    samples      a pixel: 1, 2, 4, 8 or 16, at the standard places, or at sample_locations: (x, y) of each, in 1/16 pixel.
    depth_test   "less" or "greater"; the later one of equal depths is seen with "less_equal" and "greater_equal".
    layers       the nearest 1..16 fragments of each sample, with an axis of their own.
    origin       (x, y): the pixel of space that is pixel (0, 0), up to 4194304 in magnitude: for tiles.
    initial_depth  (height, width) float32 that a triangle must beat.
    attribute_location  in a pixel of several samples: "centre" or "centroid".
    threads      1..256; the result does not depend on it. executor: a ThreadPoolExecutor whose threads work; not called from one of them.
    path         "automatic" or "reference", the slow one; both give the same bits. context: see Context.
    copy         True: a buffer of yours that is used again changes nothing in the raster. The copy costs 16 bytes a vertex, 12 a
                 triangle, and initial_depth. False: the raster refers to your arrays; leave them as they are while you interpolate.
    out          a raster whose images are written over, where the shape is the same: saves the memory's allocation.

    A triangle with a NaN or an infinity, also among its attributes, is dropped."""
    listed = check_draws(draws)
    settings = Settings(size, samples=samples, depth_test=depth_test, layers=layers, origin=origin,
                        sample_locations=sample_locations, initial_depth=initial_depth, attribute_location=attribute_location,
                        threads=threads, path=path, context=context, executor=executor, batch=batch_of(listed))
    return _render(listed, settings, outputs, copy, out, True)


def rasterize(positions: ArrayLike, triangles: ArrayLike, size: Sequence[int], *,
              outputs: Union[str, Sequence[str]] = _DEFAULT, attributes: Optional[ArrayLike] = None,
              interpolation: Interpolations = "perspective", ranges: Optional[ArrayLike] = None,
              identifiers: Optional[ArrayLike] = None, samples: int = 1, fill_rule: str = "top_left",
              front_face: str = "clockwise", cull: str = "none", depth_test: str = "less", depth_mode: str = "none",
              depth_bias: Optional[Tuple[float, float]] = None, conservative: str = "none",
              scissor: Optional[Sequence[int]] = None, grid: Union[None, int, Grid] = None, primitive: str = "triangles",
              width: Optional[float] = None, layers: Optional[int] = None,
              origin: Sequence[int] = (0, 0), sample_locations: Optional[Sequence[Sequence[int]]] = None,
              initial_depth: Optional[ArrayLike] = None, attribute_location: str = "centre", threads: int = 1,
              context: Optional[Context] = None, executor: Optional[Executor] = None, convert: bool = False,
              copy: bool = True, out: Optional[Raster] = None) -> Raster:
    """Draws triangles and returns who is seen at each sample.

    positions    (V, 4) float32, pixel-homogeneous: (X, Y, Z, W) is seen at pixel position (X/W, Y/W), x to the right, y down,
                 with depth Z/W. (N, V, 4): a batch of N images, which each output has as its first axis.
    triangles    (T, 3) whole numbers, rows of positions; (T, 2) for primitive="lines", (T, 1) or (T,) for "points".
    size         (height, width) in pixels, 1..16384 each.
    outputs      what is to be had; no more is computed: "index", "depth", "barycentrics", "count", "winding", ...
    attributes   (V, C) float32, any number of columns: `raster.attributes` then has them, in the same pass.

    The other arguments are those of `Draw` and `render`: help(surefill.Draw), help(surefill.render)."""
    draw = Draw(positions, triangles, attributes=attributes, interpolation=interpolation, ranges=ranges,
                identifiers=identifiers, fill_rule=fill_rule, front_face=front_face, cull=cull, depth_mode=depth_mode,
                depth_bias=depth_bias, conservative=conservative, scissor=scissor, grid=grid, primitive=primitive, width=width, convert=convert)
    settings = Settings(size, samples=samples, depth_test=depth_test, layers=layers, origin=origin,
                        sample_locations=sample_locations, initial_depth=initial_depth, attribute_location=attribute_location,
                        threads=threads, context=context, executor=executor, batch=draw._batch)
    if conservative != "none" and outputs is _DEFAULT:
        outputs = ("index",)
    return _render([draw], settings, outputs, copy, out, False)


def interpolate(attributes: Any, raster: Raster, *, interpolation: Interpolations = "perspective",
                convert: bool = False) -> NDArray[np.float32]:
    """Attributes of the visible triangles: (V, C) float32, a row for each row of positions, to (height, width, C).

    Each number is the real value at the sample, correctly rounded: not a sum over rounded barycentrics, so the triangles are
    drawn once more, all columns in one pass (64 at a time); `rasterize(..., attributes=...)` spares that. Of a batch, attributes
    are (V, C), for all images, or (N, V, C). Of a raster by `render`, a list, with an array for each draw. (V,) gives (height, width).
    interpolation is "perspective", "noperspective" or "flat" (the value of vertex 0), or a sequence of words, one for each
    column. 0 where nothing is seen. A triangle with a NaN or an infinity among its attributes is dropped."""
    if not isinstance(raster, Raster):
        raise TypeError(f"raster: what rasterize returned is needed, not {type(raster).__name__}")
    if raster._listed:
        if not isinstance(attributes, (list, tuple)) or len(attributes) != len(raster._draws):
            raise ValueError(f"attributes: a list of {len(raster._draws)} arrays, one for each draw, is needed")
        draws = [draw._with(values, interpolation, convert) for draw, values in zip(raster._draws, attributes)]
    else:
        draws = [raster._draws[0]._with(attributes, interpolation, convert)]
    if not draws:
        raise ValueError("attributes: nothing was drawn")
    values = draw_frames(draws, raster._settings, ()).attributes
    assert values is not None
    return _columns(values, draws)


def coverage(positions: ArrayLike, triangles: ArrayLike, size: Sequence[int], *, samples: int = 1,
             fill_rule: str = "top_left", front_face: str = "clockwise", cull: str = "none", depth_mode: str = "none",
             conservative: str = "none", ranges: Optional[ArrayLike] = None, scissor: Optional[Sequence[int]] = None,
             grid: Union[None, int, Grid] = None, origin: Sequence[int] = (0, 0),
             sample_locations: Optional[Sequence[Sequence[int]]] = None, threads: int = 1,
             context: Optional[Context] = None, executor: Optional[Executor] = None,
             convert: bool = False) -> NDArray[np.uint32]:
    """How many triangles cover each sample, seen or not: (height, width) uint32. Arguments as for `rasterize`.

    conservative counts whole pixels instead of samples: "over" those that the triangle touches, "inner" those that lie in it,
    "overlap" those that share an area with it, "touched" those that it touches though it be a line or a point."""
    return rasterize(positions, triangles, size, outputs="count", samples=samples, fill_rule=fill_rule,
                     front_face=front_face, cull=cull, depth_mode=depth_mode, conservative=conservative, ranges=ranges,
                     scissor=scissor, grid=grid, origin=origin, sample_locations=sample_locations, threads=threads,
                     context=context, executor=executor, convert=convert, copy=False).count


__all__ = ["NO_TRIANGLE", "Raster", "Statistics", "coverage", "interpolate", "rasterize", "render"]
