# SPDX-License-Identifier: Apache-2.0
"""Occlusion culling: of one image, and of all larger ones."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, List, Optional, Sequence, Union

import numpy as np

from . import _library as c
from ._arrays import choice, floats, size_of, whole_numbers
from ._draws import Draw, _pointer, batch_of, draw_structs
from ._frames import Context, Executor, Settings, Statistics, _Options, _statistics, check_draws

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


class _Buffer:
    """What both buffers have. `_c` is the beginning of their functions' names."""

    OUTSIDE, HIDDEN, VISIBLE = 0, 1, 2
    _c = ""

    def __init__(self, size: Sequence[int], *, depth_test: str = "less", equal_is_visible: bool = False) -> None:
        self._size = size_of(size)
        self._handle = ctypes.c_void_p()
        c.check(self._call("create", self._size[1], self._size[0], choice("depth_test", depth_test), ctypes.byref(self._handle)))
        self._call("set_equal_is_visible", self._handle, bool(equal_is_visible))

    def _call(self, name: str, *arguments: Any) -> Any:
        return getattr(c, self._c + name)(*arguments)

    def __del__(self) -> None:
        if getattr(self, "_handle", None):
            self._call("destroy", self._handle)

    def __repr__(self) -> str:
        return f"<surefill.{type(self).__name__} {self._size[0]} x {self._size[1]}>"

    def clear(self) -> None:
        """Forgets the occluders."""
        self._call("clear", self._handle)

    def query_boxes(self, boxes: ArrayLike, *, convert: bool = False) -> NDArray[np.uint8]:
        """(B,) answers, OUTSIDE, HIDDEN or VISIBLE, for (B, 8, 4) pixel-homogeneous corners, in any order."""
        return self._query("query_boxes", floats("boxes", boxes, (None, 8, 4), convert=convert))

    def query_rectangles(self, rectangles: ArrayLike, *, convert: bool = False) -> NDArray[np.uint8]:
        """The same for (B, 5): x0, y0, x1, y1 in pixels, and the nearest depth."""
        return self._query("query_rectangles", floats("rectangles", rectangles, (None, 5), convert=convert))

    def _query(self, function: str, asked: NDArray[np.float32]) -> NDArray[np.uint8]:
        answers = np.empty(len(asked), np.uint8)
        c.check(self._call(function, self._handle, _pointer(asked), len(asked), _pointer(answers)))
        return answers

    @property
    def depth(self) -> NDArray[np.float32]:
        """A copy of the stored depth, (height, width)."""
        height, width = self._size
        memory = (ctypes.c_float * (height * width)).from_address(self._call("depth", self._handle))
        stored: NDArray[np.float32] = np.frombuffer(memoryview(memory).cast("B"), np.float32)
        return stored.reshape(height, width).copy()


class OcclusionBuffer(_Buffer):
    """The depth of what hides, which can be asked whether boxes are hidden. If the answer is not VISIBLE, drawing what is in the
    box would not change one sample of an image of this size. A box around an occluder can be hidden by its own face, if that
    is parallel to the screen; not so with equal_is_visible."""

    _c = "occlusion_"

    def draw(self, draws: Union[Draw, Sequence[Draw]], *, threads: int = 1, context: Optional[Context] = None,
             executor: Optional[Executor] = None) -> Statistics:
        """Draws occluders onto those before. No other call may use the buffer meanwhile."""
        listed = [draws] if isinstance(draws, Draw) else check_draws(draws)
        if batch_of(listed) is not None:
            raise ValueError("draws: no batch is taken here; one image a call")
        structs, alive = draw_structs(listed, 0, [], [(None, None)] * len(listed))
        told = c.Statistics(struct_size=ctypes.sizeof(c.Statistics))
        options = _Options(Settings(self._size, threads=threads, context=context, executor=executor))
        status = c.occlusion_draw(self._handle, structs, len(listed), options.struct, told)
        del alive
        options.check(status)
        return _statistics(told)


class OccluderMesh:
    """Triangles that hide, prepared once for all views and safe buffers: which vertices lie at one place, and which triangles
    share an edge there. points: (V, 3), in any space of the model; triangles: (T, 3) rows of points."""

    def __init__(self, points: ArrayLike, triangles: ArrayLike, *, convert: bool = False) -> None:
        places = floats("points", points, (None, 3), convert=convert)
        rows = whole_numbers("triangles", triangles, (None, 3), error=IndexError)
        self._vertices, self._handle = len(places), ctypes.c_void_p()
        c.check(c.occluder_mesh_create(_pointer(places), len(places), 0, _pointer(rows), rows.size, ctypes.byref(self._handle)))

    def __del__(self) -> None:
        if getattr(self, "_handle", None):
            c.occluder_mesh_destroy(self._handle)

    def __repr__(self) -> str:
        return f"<surefill.OccluderMesh of {self._vertices} vertices>"


class SafeOcclusionBuffer(_Buffer):
    """The depth that occluders have at least in each pixel's whole square: a small buffer that is right about every larger picture
    of the same view. Make it a power of two smaller than the picture. If the answer is not VISIBLE, drawing what is in the
    box would not change one sample of any of them."""

    _c = "safe_occlusion_"

    def draw(self, meshes: Union[OccluderMesh, Sequence[OccluderMesh]], positions: Union[ArrayLike, Sequence[ArrayLike]], *,
             fill_rule: str = "top_left", front_face: str = "clockwise", cull: str = "none", depth_mode: str = "none",
             threads: int = 1, executor: Optional[Executor] = None) -> None:
        """Draws a mesh at its (V, 4) positions in this view, or a list of meshes at a list of positions, onto those before. The
        state is that in which they are drawn to the picture. No other call may use the buffer meanwhile."""
        one = isinstance(meshes, OccluderMesh)
        listed: List[OccluderMesh] = [meshes] if one else list(meshes)  # type: ignore[list-item, arg-type]
        places: List[Any] = [positions] if one else list(positions)  # type: ignore[arg-type]
        if not all(isinstance(mesh, OccluderMesh) for mesh in listed):
            raise TypeError("meshes: a surefill.OccluderMesh or a list of them is needed")
        if len(listed) != len(places):
            raise ValueError(f"positions: one array for each of the {len(listed)} meshes is needed, not {len(places)}")
        none = np.empty((0, 3), np.uint32)
        draws = [Draw(p, none, fill_rule=fill_rule, front_face=front_face, cull=cull, depth_mode=depth_mode) for p in places]
        if batch_of(draws) is not None:
            raise ValueError("positions: no batch is taken here; one image a call")
        structs, alive = draw_structs(draws, 0, [], [(None, None)] * len(draws))
        for struct, mesh in zip(structs, listed):
            struct.indices, struct.index_count = None, 0
            if struct.vertex_count != mesh._vertices:
                raise ValueError(f"positions: one for each of the mesh's {mesh._vertices} vertices is needed, not {struct.vertex_count}")
        handles = (ctypes.c_void_p * max(len(listed), 1))(*(mesh._handle.value for mesh in listed))
        options = _Options(Settings(self._size, threads=threads, executor=executor))
        status = c.safe_occlusion_draw(self._handle, handles, structs, len(listed), options.struct)
        del alive
        options.check(status)
