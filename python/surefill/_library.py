# SPDX-License-Identifier: Apache-2.0
"""The C interface, engine/include/surefill/surefill.h, for ctypes: structs, functions, and statuses as exceptions.

Here is nothing but what stands there, under the same names; the other modules check types and shapes."""

from __future__ import annotations

import ctypes
import os
import pathlib
import struct
import sys
from ctypes import POINTER, c_char_p, c_float, c_int32, c_size_t, c_uint32, c_uint64, c_void_p
from typing import Any, Sequence, Tuple

_NAMES = {"win32": "surefill.dll", "darwin": "libsurefill.dylib"}


def _load() -> ctypes.CDLL:
    """The library in the package, or the one that SUREFILL_LIBRARY names."""
    path = os.environ.get("SUREFILL_LIBRARY") or str(pathlib.Path(__file__).with_name(_NAMES.get(sys.platform, "libsurefill.so")))
    try:
        return ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(f"surefill: its library cannot be loaded: {error}. `pip install` the wheel, or name a built library "
                          "in SUREFILL_LIBRARY (docs/python.md)") from None


LIBRARY = _load()

MAX_SIZE, MAX_ATTRIBUTES, MAX_COMPONENTS, MAX_THREADS, MAX_ORIGIN, MAX_LAYERS = 16384, 16, 4, 256, 4194304, 16

OK, OUT_OF_MEMORY = 0, 1
DRAW_INDEX_OUT_OF_RANGE, DRAW_IDENTIFIERS, BAD_BUILD = 16, 17, 33

# The argument of the Python functions that each status is about; those that can be seen by the types and shapes of arrays alone
# are checked before the call, and have no row.
_ARGUMENTS = {
    2: "size", 3: "samples", 9: "initial_depth", 10: "out", 11: "depth_test", 12: "attribute_location", 14: "positions",
    15: "triangles", 16: "triangles", 17: "identifiers", 18: "first_index", 19: "attributes", 20: "interpolation",
    21: "fill_rule", 22: "front_face", 23: "cull", 24: "depth_mode", 25: "conservative", 26: "grid", 27: "depth_range",
    28: "threads", 30: "boxes", 31: "answers", 34: "clip", 35: "outputs", 36: "origin", 37: "sample_locations", 38: "layers",
    39: "outputs", 40: "depth_bias", 41: "outputs", 42: "outputs",
    43: "primitive", 44: "width", 47: "points", 48: "meshes", 49: "positions",
}


class Viewport(ctypes.Structure):
    _fields_ = [("x", c_float), ("y", c_float), ("width", c_float), ("height", c_float), ("near_depth", c_float),
                ("far_depth", c_float), ("clip_depth_minus_one", c_uint32), ("clip_y_down", c_uint32)]


class Scissor(ctypes.Structure):
    _fields_ = [("x0", c_int32), ("y0", c_int32), ("x1", c_int32), ("y1", c_int32)]


class Grid(ctypes.Structure):
    _fields_ = [("bits", c_int32), ("offset_x", c_int32), ("offset_y", c_int32), ("rounding", c_uint32)]


class DepthBias(ctypes.Structure):
    _fields_ = [("constant", c_float), ("slope", c_float)]


class AttributeArray(ctypes.Structure):
    _fields_ = [("values", c_void_p), ("value_count", c_size_t), ("components", c_uint32), ("stride", c_uint32),
                ("interpolation", c_uint32)]


class Draw(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("vertices", c_void_p), ("vertex_count", c_size_t), ("indices", c_void_p),
                ("index_count", c_size_t), ("identifiers", c_void_p), ("identifier_count", c_size_t),
                ("attributes", POINTER(AttributeArray)), ("attribute_count", c_size_t), ("first_index", c_uint32),
                ("fill_rule", c_uint32), ("front_face", c_uint32), ("cull", c_uint32), ("depth_mode", c_uint32),
                ("conservative", c_uint32), ("depth_write_off", c_uint32), ("scissor", POINTER(Scissor)),
                ("grid", POINTER(Grid)), ("culling_box", c_void_p), ("vertex_stride", c_size_t),
                ("depth_bias", POINTER(DepthBias)), ("covered", c_void_p), ("covered_count", c_size_t),
                ("visible", c_void_p), ("visible_count", c_size_t),
                ("primitive", c_uint32), ("width", c_float)]


class AttributeTarget(ctypes.Structure):
    _fields_ = [("values", c_void_p), ("value_count", c_size_t), ("components", c_uint32), ("stride", c_uint32)]


class Target(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("width", c_int32), ("height", c_int32), ("samples", c_int32),
                ("depth_test", c_uint32), ("count", c_void_p), ("count_count", c_size_t), ("index", c_void_p),
                ("index_count", c_size_t), ("depth", c_void_p), ("depth_count", c_size_t), ("barycentrics", c_void_p),
                ("barycentrics_count", c_size_t), ("attributes", POINTER(AttributeTarget)), ("attribute_count", c_size_t),
                ("initial_depth", c_void_p), ("initial_depth_count", c_size_t), ("attribute_location", c_uint32),
                ("layers", c_uint32), ("origin_x", c_int32), ("origin_y", c_int32), ("sample_locations", c_void_p),
                ("sample_location_count", c_size_t), ("winding", c_void_p), ("winding_count", c_size_t)]


TASK = ctypes.CFUNCTYPE(None, c_void_p, c_size_t)
EXECUTOR = ctypes.CFUNCTYPE(None, c_void_p, c_size_t, TASK, c_void_p)


class Options(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("threads", c_int32), ("path", c_uint32), ("context", c_void_p),
                ("executor", EXECUTOR), ("executor_context", c_void_p)]


class Block(ctypes.Structure):
    _fields_ = [("draw", c_uint32), ("triangle", c_uint32), ("x", c_int32), ("y", c_int32), ("sample", c_int32),
                ("mask", c_uint64)]


VISITOR = ctypes.CFUNCTYPE(None, c_void_p, POINTER(Block), c_size_t)


class Statistics(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("triangles", c_uint64), ("dropped", c_uint64), ("degenerate", c_uint64),
                ("culled", c_uint64), ("outside", c_uint64), ("rasterized", c_uint64), ("path", c_char_p)]


def _function(name: str, result: Any, *arguments: Any) -> Any:
    function = getattr(LIBRARY, "surefill_" + name)
    function.restype, function.argtypes = result, arguments
    return function


version = _function("version", c_char_p)
status_text = _function("status_text", c_char_p, ctypes.c_int)
to_pixel = _function("to_pixel", ctypes.c_int, POINTER(Viewport), c_void_p, c_size_t, c_void_p)
sample_location = _function("sample_location", None, c_int32, c_int32, POINTER(c_int32), POINTER(c_int32))
render = _function("render", ctypes.c_int, POINTER(Target), POINTER(Draw), c_size_t, POINTER(Options), POINTER(Statistics))
visit_coverage = _function("visit_coverage", ctypes.c_int, POINTER(Target), POINTER(Draw), c_size_t, VISITOR, c_void_p,
                           POINTER(Options), POINTER(Statistics))
context_create = _function("context_create", c_void_p)
context_destroy = _function("context_destroy", None, c_void_p)
occluder_mesh_create = _function("occluder_mesh_create", ctypes.c_int, c_void_p, c_size_t, c_size_t, c_void_p, c_size_t,
                                 POINTER(c_void_p))
occluder_mesh_destroy = _function("occluder_mesh_destroy", None, c_void_p)
occlusion_draw = _function("occlusion_draw", ctypes.c_int, c_void_p, POINTER(Draw), c_size_t, POINTER(Options),
                           POINTER(Statistics))
safe_occlusion_draw = _function("safe_occlusion_draw", ctypes.c_int, c_void_p, POINTER(c_void_p), POINTER(Draw), c_size_t,
                                POINTER(Options))
for _kind in ("occlusion_", "safe_occlusion_"):  # what both buffers have
    for _name, _result, _types in (
            ("create", ctypes.c_int, (c_int32, c_int32, c_uint32, POINTER(c_void_p))), ("destroy", None, (c_void_p,)),
            ("clear", None, (c_void_p,)), ("query_boxes", ctypes.c_int, (c_void_p, c_void_p, c_size_t, c_void_p)),
            ("query_rectangles", ctypes.c_int, (c_void_p, c_void_p, c_size_t, c_void_p)), ("depth", c_void_p, (c_void_p,)),
            ("set_equal_is_visible", None, (c_void_p, c_int32))):
        globals()[_kind + _name] = _function(_kind + _name, _result, *_types)


def check(status: int) -> None:
    """Raises what a status other than OK means; the message begins with the argument's name."""
    if status == OK:
        return
    text = status_text(status).decode()
    name = _ARGUMENTS.get(status)
    message = text if name is None else f"{name}: {text}"
    if status == OUT_OF_MEMORY:
        raise MemoryError(message)
    if status == DRAW_INDEX_OUT_OF_RANGE:
        raise IndexError("triangles: an index that names no row of positions")
    if status == DRAW_IDENTIFIERS:
        raise ValueError("identifiers: NO_TRIANGLE (-1 as int32) is what an empty sample holds")
    if status == BAD_BUILD:
        raise RuntimeError(message)
    raise ValueError(message)


def float32_bits(number: float) -> int:
    """The float32 nearest to a number, ties to even, as an integer; by whole numbers alone, so that the rounding mode of the caller,
    and whether it flushes subnormal numbers, change nothing. Beyond float32: an infinity."""
    bits: int = struct.unpack("<Q", struct.pack("<d", number))[0]
    sign, exponent, fraction = bits >> 63 << 31, bits >> 52 & 0x7FF, bits & (1 << 52) - 1
    if exponent == 0x7FF:
        return sign | 0x7F800000 | (0x400000 if fraction else 0)
    # The value is fraction 2^(exponent - 1075); that of a float32's last place is 2^(place - 149), with place >= 0.
    fraction, exponent = (fraction | 1 << 52, exponent) if exponent else (fraction, 1)
    place = max(exponent - 1075 + 149 + 29, 0)
    shift = place - 149 - (exponent - 1075)
    whole, rest, half = fraction >> shift, fraction & (1 << shift) - 1, 1 << shift - 1
    whole += rest > half or (rest == half and whole & 1)
    return sign | min((place << 23) + whole, 0x7F800000)  # a whole of 2^23 or more carries into the exponent


def set_float(structure: ctypes.Structure, **members: float) -> None:
    """Writes float32 members bit by bit, rounded to nearest in any state of the thread."""
    for name, number in members.items():
        offset = getattr(type(structure), name).offset
        ctypes.c_uint32.from_buffer(structure, offset).value = float32_bits(number)


def array_of(kind: Any, items: Sequence[Any]) -> Any:
    """A C array of structs."""
    return (kind * max(len(items), 1))(*items)


def sample_locations(samples: int) -> Tuple[Tuple[int, int], ...]:
    """The standard places (x, y) of the samples of a pixel, from its top left corner, in 1/16 pixel: of 1, 2, 4, 8 or 16."""
    x, y, places = c_int32(), c_int32(), []
    for n in range(samples):
        sample_location(samples, n, ctypes.byref(x), ctypes.byref(y))
        places.append((x.value, y.value))
    return tuple(places)
