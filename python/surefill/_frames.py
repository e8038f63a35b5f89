# SPDX-License-Identifier: Apache-2.0
"""Frames: draws to images."""

from __future__ import annotations

import concurrent.futures
import ctypes
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from . import _library as c
from ._arrays import choice, floats, size_of, whole, wholes
from ._draws import Draw, Groups, Interpolations, _pointer, batch_of, column_groups, draw_structs

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

Executor = concurrent.futures.ThreadPoolExecutor

OUTPUTS: Dict[str, Tuple[type, int]] = {"index": (np.uint32, 1), "depth": (np.float32, 1), "barycentrics": (np.float32, 3),
                                        "count": (np.uint32, 1), "winding": (np.int32, 1)}
_LAYERED = ("index", "depth", "barycentrics")
_PER_TRIANGLE = ("covered", "visible")
BLOCK = np.dtype({"names": ["draw", "triangle", "x", "y", "sample", "mask"],
                  "formats": [np.uint32, np.uint32, np.int32, np.int32, np.int32, np.uint64],
                  "offsets": [getattr(c.Block, name).offset for name in ("draw", "triangle", "x", "y", "sample", "mask")],
                  "itemsize": ctypes.sizeof(c.Block)})


class Context:
    """Working memory that outlives calls: what one has allocated, the next ones with the same context use again."""

    def __init__(self) -> None:
        self._handle = c.context_create()
        if not self._handle:
            raise MemoryError("context: out of memory")

    def __del__(self) -> None:
        if getattr(self, "_handle", None):
            c.context_destroy(self._handle)

    def __repr__(self) -> str:
        return "<surefill.Context>"


class Statistics(NamedTuple):
    """What the triangles of a frame were; each counts once, as the first that fits."""

    triangles: int
    dropped: int
    """A NaN or an infinity."""
    degenerate: int
    culled: int
    rasterized: int
    path: str
    """What drew the frame: "reference", or an instruction set."""


class Settings:
    """The target and the options of a call, checked."""

    def __init__(self, size: Sequence[int], *, samples: int = 1, depth_test: str = "less", layers: Optional[int] = None,
                 origin: Sequence[int] = (0, 0), sample_locations: Optional[Sequence[Sequence[int]]] = None,
                 initial_depth: Optional[ArrayLike] = None, attribute_location: str = "centre", threads: int = 1,
                 path: str = "automatic", context: Optional[Context] = None, executor: Optional[Executor] = None,
                 batch: Optional[int] = None) -> None:
        self.height, self.width = size_of(size)
        if whole("samples", samples, 1, 16) not in (1, 2, 4, 8, 16):
            raise ValueError(f"samples: 1, 2, 4, 8 or 16 is needed, not {samples}")
        self.samples, self.batch = int(samples), batch
        self.depth_test = choice("depth_test", depth_test)
        self.layers = None if layers is None else whole("layers", layers, 1, c.MAX_LAYERS)
        self.origin = wholes("origin", origin, 2, -c.MAX_ORIGIN, c.MAX_ORIGIN, "a pair (x, y)")
        self.sample_locations: Optional[NDArray[np.int32]] = None
        if sample_locations is not None:
            places = [wholes("sample_locations", place, 2, 0, 15, "a place (x, y) in 1/16 pixel for each sample")
                      for place in sample_locations]
            if len(places) != self.samples:
                raise ValueError(f"sample_locations: {self.samples} places are needed, not {len(places)}")
            self.sample_locations = np.array(places, np.int32)
        self.attribute_location = choice("attribute_location", attribute_location)
        self.initial_depth = None
        if initial_depth is not None:
            shapes = [self.image] if batch is None else [self.image, (batch, *self.image)]
            self.initial_depth = floats("initial_depth", initial_depth, *shapes)
        self.threads = whole("threads", threads, 1, c.MAX_THREADS)
        if path not in ("automatic", "reference"):
            raise ValueError(f"path: one of automatic, reference is needed, not {path!r}")
        self.path = int(path == "reference")
        if context is not None and not isinstance(context, Context):
            raise TypeError("context: a surefill.Context is needed")
        if executor is not None and not isinstance(executor, Executor):
            raise TypeError("executor: a concurrent.futures.ThreadPoolExecutor is needed")
        self.context, self.executor = context, executor

    @property
    def image(self) -> Tuple[int, ...]:
        """The shape of one image of one layer."""
        return (self.height, self.width) if self.samples == 1 else (self.height, self.width, self.samples)

    def shape(self, layered: bool, components: int) -> Tuple[int, ...]:
        """Of an output, of all images of the batch."""
        shape = self.image if self.layers is None or not layered else (self.layers, *self.image)
        shape = shape if self.batch is None else (self.batch, *shape)
        return shape if components == 1 else (*shape, components)

    def target(self, image: int) -> c.Target:
        target = c.Target(struct_size=ctypes.sizeof(c.Target), width=self.width, height=self.height, samples=self.samples,
                          depth_test=self.depth_test, attribute_location=self.attribute_location,
                          layers=self.layers or 0, origin_x=self.origin[0], origin_y=self.origin[1])
        if self.sample_locations is not None:
            target.sample_locations = self.sample_locations.ctypes.data
            target.sample_location_count = self.samples
        if self.initial_depth is not None:
            depth = self.initial_depth if self.initial_depth.shape == self.image else self.initial_depth[image]
            target.initial_depth, target.initial_depth_count = _pointer(depth), depth.size
        return target

    def kept(self) -> "Settings":
        """For a raster: without what belongs to the call alone."""
        other = object.__new__(Settings)
        other.__dict__.update(self.__dict__, context=None, executor=None)
        return other

    def own(self) -> "Settings":
        other = self.kept()
        other.initial_depth = None if self.initial_depth is None else self.initial_depth.copy()
        return other


class _Options:
    """The C options of a call, and the failure of what it calls back."""

    def __init__(self, settings: Settings) -> None:
        self.error: Optional[BaseException] = None
        self.struct = c.Options(struct_size=ctypes.sizeof(c.Options), threads=settings.threads, path=settings.path)
        if settings.context is not None:
            self.struct.context = settings.context._handle
        if settings.executor is not None:
            self.struct.executor = c.EXECUTOR(self._run)
        self._pool = settings.executor

    def _run(self, _: Optional[int], items: int, task: Any, argument: Optional[int]) -> None:
        """Each item is run once, whatever the pool does."""
        futures: List["concurrent.futures.Future[None]"] = []
        try:
            assert self._pool is not None
            for item in range(items):
                futures.append(self._pool.submit(task, argument, item))
        except BaseException as error:
            self.error = self.error or error
        for item in range(items):
            try:
                if item < len(futures) and not futures[item].cancelled():
                    futures[item].result()
                    continue
            except concurrent.futures.CancelledError:
                pass
            except BaseException as error:
                self.error = self.error or error
                concurrent.futures.wait([futures[item]])
                continue
            task(argument, item)

    def guarded(self, function: Callable[[NDArray[Any]], object]) -> Any:
        def visit(_: Optional[int], blocks: Any, number: int) -> None:
            if self.error is None:
                try:
                    address = ctypes.addressof(blocks.contents)
                    memory = (ctypes.c_char * (number * BLOCK.itemsize)).from_address(address)
                    function(np.frombuffer(memoryview(memory), BLOCK).copy())
                except BaseException as error:
                    self.error = error

        return c.VISITOR(visit)

    def check(self, status: int) -> None:
        c.check(status)
        if self.error is not None:
            raise self.error


def _statistics(struct: c.Statistics) -> Statistics:
    return Statistics(struct.triangles, struct.dropped, struct.degenerate, struct.culled, struct.rasterized,
                      struct.path.decode() if struct.path else "")


class Frame(NamedTuple):
    """What a call has drawn."""

    outputs: Dict[str, NDArray[Any]]
    attributes: Optional[NDArray[np.float32]]
    per_triangle: Dict[str, List[NDArray[np.uint64]]]
    statistics: List[Statistics]


def _allocate(settings: Settings, outputs: Sequence[str], given: Mapping[str, NDArray[Any]]) -> Dict[str, NDArray[Any]]:
    arrays = {}
    for name in outputs:
        dtype, components = OUTPUTS[name]
        shape = settings.shape(name in _LAYERED, components)
        old = given.get(name)
        arrays[name] = old if old is not None and old.shape == shape else np.empty(shape, dtype)
    return arrays


def draw_frames(draws: Sequence[Draw], settings: Settings, outputs: Sequence[str],
                given: Mapping[str, NDArray[Any]] = {}) -> Frame:
    """Draws each image of the batch, in as many passes as its attributes need."""
    with_attributes = bool(draws) and draws[0]._attributes is not None
    if with_attributes:
        columns = {0 if d._attributes is None else d._attributes.shape[-1] for d in draws}
        if len(columns) != 1:
            raise ValueError(f"attributes: all draws need the same number of columns, not {sorted(columns)}")
    groups = column_groups(draws) if with_attributes else []
    images = 1 if settings.batch is None else settings.batch
    arrays = _allocate(settings, [name for name in outputs if name in OUTPUTS], given)
    per_triangle = {name: [np.zeros((images, len(d._triangles)), np.uint64) for d in draws]
                    for name in _PER_TRIANGLE if name in outputs}
    result = None
    if groups:
        shape = (*settings.shape(True, 1), groups[-1].last)
        old = given.get("attributes")
        result = old if old is not None and old.shape == shape else np.empty(shape, np.float32)
    statistics = []
    passes = [groups[i:i + c.MAX_ATTRIBUTES] for i in range(0, len(groups), c.MAX_ATTRIBUTES)] or [[]]
    for image in range(images):
        for number, some in enumerate(passes):
            target = settings.target(image)
            if number == 0:
                for name, array in arrays.items():
                    of_image = array if settings.batch is None else array[image]
                    setattr(target, name, of_image.ctypes.data)
                    setattr(target, name + "_count", of_image.size)
            if result is not None:
                targets = _attribute_targets(some, result if settings.batch is None else result[image])
                target.attributes, target.attribute_count = c.array_of(c.AttributeTarget, targets), len(targets)
            numbers = [tuple(per_triangle[name][d][image] if number == 0 and name in per_triangle else None
                             for name in _PER_TRIANGLE) for d in range(len(draws))]
            structs, alive = draw_structs(draws, image, some, numbers)  # type: ignore[arg-type]
            told = c.Statistics(struct_size=ctypes.sizeof(c.Statistics)) if "statistics" in outputs and number == 0 else None
            options = _Options(settings)
            options.check(c.render(target, structs, len(draws), options.struct, told))
            del alive
            if told is not None:
                statistics.append(_statistics(told))
    return Frame(arrays, result, per_triangle, statistics)


def _attribute_targets(groups: Sequence[Groups], result: NDArray[np.float32]) -> List[c.AttributeTarget]:
    """For each group its columns of the result, whose rows are samples."""
    columns = result.shape[-1]
    return [c.AttributeTarget(result.ctypes.data + 4 * group.first, result.size - group.first, group.last - group.first, columns)
            for group in groups]


def visit_coverage(draws: Union[Draw, Sequence[Draw]], size: Sequence[int], visitor: Callable[[NDArray[Any]], object], *,
                   samples: int = 1, origin: Sequence[int] = (0, 0),
                   sample_locations: Optional[Sequence[Sequence[int]]] = None, threads: int = 1, path: str = "automatic",
                   context: Optional[Context] = None, executor: Optional[Executor] = None) -> Statistics:
    """Streams coverage instead of storing an image: visitor(blocks) is called for each triangle of a tile of 64 x 64 pixels.

    blocks is a structured array, its own copy: the positions of `draw` and `triangle` in their lists, `x` and `y`, the first
    pixel of 8 x 8, `sample` of each pixel, and `mask`, whose bit 8 j + i is pixel (x + i, y + j). Within a tile the triangles
    of a sample come in order. What the visitor raises ends the visits, and is raised when the call ends."""
    listed = [draws] if isinstance(draws, Draw) else check_draws(draws)
    if batch_of(listed) is not None:
        raise ValueError("draws: no batch is taken here; one image a call")
    settings = Settings(size, samples=samples, origin=origin, sample_locations=sample_locations, threads=threads, path=path,
                        context=context, executor=executor)
    structs, alive = draw_structs(listed, 0, [], [(None, None)] * len(listed))
    told, options = c.Statistics(struct_size=ctypes.sizeof(c.Statistics)), _Options(settings)
    status = c.visit_coverage(settings.target(0), structs, len(listed), options.guarded(visitor), None, options.struct, told)
    del alive
    options.check(status)
    return _statistics(told)


def check_draws(draws: object) -> List[Draw]:
    if not isinstance(draws, (list, tuple)) or not all(isinstance(draw, Draw) for draw in draws):
        raise TypeError("draws: a list of surefill.Draw is needed")
    return list(draws)
