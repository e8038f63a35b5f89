# SPDX-License-Identifier: Apache-2.0
"""Puts a rasterizer that Python can call under `surefill certify`: a function from a scene of arrays to images.

    import numpy as np, surefill

    def draw(scene):                                      # counts, for each pixel: how many triangles cover it
        image = np.zeros((scene.height, scene.width), np.uint32)
        for draw in scene.draws:
            for corners in draw.positions[draw.triangles]:            # (3, 4): X, Y, Z, W of each vertex
                image += my_rasterizer(corners[:, :2] / corners[:, 3:], scene.height, scene.width)
        return image

    surefill.serve(draw, name="mine", outputs=["count"])

    $ surefill certify --command "python3 mine.py"

This file needs NumPy and nothing else, and may be copied. docs/adapters.md has the rules, and the messages that it speaks.
"""

from __future__ import annotations

import dataclasses
import os
import struct
import sys
import traceback
from typing import TYPE_CHECKING, Any, Callable, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Scene", "SceneAttribute", "SceneDraw", "Unsupported", "each_triangle", "serve"]

EMPTY = 0xFFFFFFFF

_OUTPUTS = ("count", "index", "depth", "barycentrics", "attributes")
_FEATURES = ("behind", "draws", "samples", "cull", "scissor", "depth_clip", "depth_clamp", "depth_greater",
             "depth_read_only", "initial_depth", "identifiers", "noperspective", "flat", "centroid", "over", "inner",
             "fill_rules", "grids", "non_finite", "closed_and_open", "widths")
_PRIMITIVES = ("triangles", "lines", "points")
_FILL_RULES = ("top_left", "top_right", "bottom_left", "bottom_right", "southwards", "southwards_west", "northwards",
               "northwards_west", "closed", "open")
# The sides that own their samples under each of them, in the bits of certify/adapter2.h.
_OWNED = (0x55, 0xA6, 0x59, 0xAA, 0x35, 0x36, 0xC9, 0xCA, 0xFF, 0)
_ROUNDINGS = ("nearest_even", "nearest_up", "truncate")
_PROFILES = ("exact", "d3d11", "vulkan", "opengl")
_LIMITS = ("width", "height", "vertices", "triangles", "attributes", "components")
_OPEN, _DRAW, _CLOSE, _MODEL = 1, 2, 3, 4
_OK, _UNSUPPORTED, _FAILED = 0, 1, 2


class Unsupported(Exception):
    """Raised by a draw function: this scene is not for me. It is never a finding."""


@dataclasses.dataclass(frozen=True)
class SceneAttribute:
    values: NDArray[np.float32]
    """(V, C), a row for each vertex."""
    interpolation: str
    """"perspective", "noperspective" or "flat"."""


@dataclasses.dataclass(frozen=True)
class SceneDraw:
    """Triangles, or lines or points, in one state. What is not among the features that were claimed has its default."""

    positions: NDArray[np.float32]
    """(V, 4), pixel-homogeneous: (X, Y, Z, W) is seen at (X/W, Y/W), x to the right, y down, with depth Z/W; pixel (i, j)
    is from (i, j) to (i + 1, j + 1)."""
    clip: NDArray[np.float32]
    """(V, 4), the same vertices in clip space, which `viewport` maps to `positions`."""
    clip_is_exact: bool
    viewport: Tuple[float, float, float, float, float, float]
    """x, y, width, height, near, far; y is up in clip space."""
    triangles: NDArray[np.uint32]
    """(T, 3), rows of positions; (T, 2) of lines, (T, 1) of points."""
    identifiers: NDArray[np.uint32]
    """(T,), what the output "index" shows."""
    attributes: Sequence[SceneAttribute]
    fill_rule: str
    front_face: str
    cull: str
    depth_mode: str
    depth_write: bool
    conservative: str
    scissor: Optional[Tuple[int, int, int, int]]
    """x0, y0, x1, y1, half-open, in pixels from the top left; None: all."""
    grid: Optional[Tuple[int, str, int, int]]
    """Bits, rounding, offset of x and y in 2^-(bits + 4) pixels; None: none."""
    primitive: str = "triangles"
    """"triangles", or "lines" or "points" where they are claimed."""
    width: Optional[float] = None
    """Of lines, or the side of points, in pixels; None: thin lines, points of one pixel."""


@dataclasses.dataclass(frozen=True)
class Scene:
    width: int
    height: int
    samples: int
    depth_test: str
    """"less" or "greater"."""
    attribute_location: str
    """"centre" or "centroid"."""
    outputs: Tuple[str, ...]
    """Those that are asked for now, out of those that were claimed."""
    draws: Sequence[SceneDraw]
    initial_depth: Optional[NDArray[np.float32]]
    components: Tuple[int, ...]
    """Of each attribute."""

    @property
    def shape(self) -> Tuple[int, ...]:
        """(height, width), and the samples of a pixel where there are several."""
        return (self.height, self.width) if self.samples == 1 else (self.height, self.width, self.samples)


class _Words:
    """Takes arrays off the front of a message."""

    def __init__(self, body: bytes):
        self._body, self._at = body, 0

    def take(self, shape: Tuple[int, ...], dtype: str = "<u4") -> NDArray[Any]:
        number = int(np.prod(shape))
        array = np.frombuffer(self._body, dtype, number, 4 * self._at).reshape(shape)
        self._at += number
        return array

    def ints(self, number: int) -> List[int]:
        return [int(word) for word in self.take((number,))]


def _scene(body: bytes, second: bool = False) -> Scene:
    """`second`: of version 2, whose headers begin with the number of their words."""
    words = _Words(body)
    if second:
        header, asked, _, width, height, samples, test, location, attributes, draws, has_depth = words.ints(11)
        words.ints(header - 11)
    else:
        asked, width, height, samples, test, location, attributes, draws, has_depth = words.ints(9)
    components = tuple(words.ints(attributes))
    shape = (height, width) if samples == 1 else (height, width, samples)
    initial = words.take(shape, "<f4") if has_depth else None
    return Scene(width, height, samples, ("less", "greater")[test], ("centre", "centroid")[location],
                 tuple(name for bit, name in enumerate(_OUTPUTS) if asked >> bit & 1),
                 [_draw(words, components, second) for _ in range(draws)], initial, components)


def _draw(words: _Words, components: Tuple[int, ...], second: bool) -> SceneDraw:
    header, primitive = words.ints(2) if second else (28, 0)
    vertices, triangles, exact = words.ints(3)
    x, y, width, height, near, far = (float(v) for v in words.take((6,), "<f4"))
    _, fill_rule, front_face, cull, depth_mode, depth_write, conservative, has_scissor = words.ints(8)
    x0, y0, x1, y1 = (int(v) for v in words.take((4,), "<i4"))
    has_grid, bits, rounding, offset_x, offset_y = words.ints(5)
    pixels = float(words.take((1,), "<f4")[0]) if header > 28 else 0.0
    words.ints(max(header - 29, 0))
    positions, clip = words.take((vertices, 4), "<f4"), words.take((vertices, 4), "<f4")
    corners, identifiers = words.take((triangles, 3 - primitive)), words.take((triangles,))
    attributes = []
    for number in components:
        interpolation = words.ints(1)[0]
        attributes.append(SceneAttribute(words.take((vertices, number), "<f4"),
                                         ("perspective", "noperspective", "flat")[interpolation]))
    return SceneDraw(positions, clip, bool(exact), (x, y, width, height, near, far), corners, identifiers, attributes,
                     _FILL_RULES[fill_rule], ("clockwise", "counter_clockwise")[front_face],
                     ("none", "front", "back")[cull], ("none", "clip", "clamp")[depth_mode], bool(depth_write),
                     ("none", "over", "inner")[conservative], (x0, y0, x1, y1) if has_scissor else None,
                     (bits, _ROUNDINGS[rounding], offset_x, offset_y) if has_grid else None, _PRIMITIVES[primitive],
                     pixels if pixels > 0 else None)


def _number_of(what: str, value: str, choices: Sequence[str]) -> int:
    if value not in choices:
        raise ValueError(f"{what}: one of {', '.join(choices)} is needed, not {value!r}")
    return choices.index(value)


def _bits(what: str, names: Sequence[str], choices: Sequence[str]) -> int:
    return sum(1 << bit for bit in {_number_of(what, name, choices) for name in names})


def _text(what: str, text: str) -> bytes:
    data = text.encode()
    if len(data) > 63:
        raise ValueError(f"{what}: at most 63 bytes are needed, not {len(data)}")
    return data


def _answer(scene: Scene, result: object) -> bytes:
    """The images in the order of the message."""
    if not isinstance(result, Mapping):
        if len(scene.outputs) != 1:
            raise TypeError(f"a dict of {', '.join(scene.outputs)} is needed, not {type(result).__name__}")
        result = {scene.outputs[0]: result}
    parts = []
    for name in scene.outputs:
        if name not in result:
            raise KeyError(f"{name} was asked for, and is not in what the draw function returned")
        images = [(name, result[name], scene.shape)]
        if name == "barycentrics":
            images = [(name, result[name], scene.shape + (3,))]
        if name == "attributes":
            if len(result[name]) != len(scene.components):
                raise ValueError(f"attributes: {len(scene.components)} images are needed, not {len(result[name])}")
            images = [(f"attributes[{k}]", image, scene.shape + (number,) if number > 1 else scene.shape)
                      for k, (image, number) in enumerate(zip(result[name], scene.components))]
        for label, image, shape in images:
            array = np.asarray(image)
            whole = name in ("count", "index")
            if whole and not (np.issubdtype(array.dtype, np.integer) or array.dtype == bool):
                raise TypeError(f"{label}: whole numbers are needed, not {array.dtype}")
            if array.shape != shape and array.shape != shape + (1,):
                raise ValueError(f"{label}: shape {shape} is needed, not {array.shape}")
            parts.append(array.astype("<u4" if whole else "<f4").tobytes())
    return b"".join(parts)


def _model(bits: int, rounding: str, offset: Tuple[int, int], rule: str, clip_depth: str) -> bytes:
    """surefill_adapter2_model: positions exact or on a grid, and lines and points as M7 has them."""
    owned, infinity = _OWNED[_number_of("fill_rule", rule, _FILL_RULES)], float("inf")
    ties = min(_number_of("fill_rule", rule, _FILL_RULES), 8)
    number = {"nearest_even": 0, "nearest_up": 1, "truncate": 4}[rounding]
    axes = [struct.pack("<7diI", 0.5, 0, 0, 0, 0, 0, o * 2.0 ** -(bits + 4) if bits >= 0 else 0.0, bits, number) for o in offset]
    outline = struct.pack("<2I5d", ties, 0, 0, 0, 0, infinity, 0)
    return struct.pack("<8I", 352, owned, 0, owned, 0, 0, 0, 0) + b"".join(axes) + struct.pack(
        "<7d4I4I", 0, 0, infinity, 0, 1, infinity, 0.0625, 0, 0, int(clip_depth == "minus_one_to_one"), 0, 0, 1, 0,
        0) + outline + outline + struct.pack("<2I", 0, 0)


def each_triangle(covers: Callable[[NDArray[np.float64], int, int], NDArray[Any]]) -> Callable[[Scene], NDArray[np.uint32]]:
    """A draw function for the output "count", of one that draws a single triangle into an image of its own.

    covers(xy, height, width): xy is (3, 2) float64, pixels, y down; what is not 0 in the (height, width) array that it returns
    is covered. This is how a library that has colours, or says no more than whether a pixel is covered, is put under test."""

    def draw(scene: Scene) -> NDArray[np.uint32]:
        image = np.zeros((scene.height, scene.width), np.uint32)
        for draw in scene.draws:
            positions = draw.positions.astype(np.float64)
            for corners in positions[draw.triangles]:
                image += np.asarray(covers(corners[:, :2] / corners[:, 3:], scene.height, scene.width)) != 0
        return image

    return draw


def serve(draw: Callable[[Scene], Union[NDArray[Any], Mapping[str, object]]], *, name: str, version: str = "",
          outputs: Sequence[str] = ("count",), features: Sequence[str] = (), form: str = "pixel", model: str = "unknown",
          grid_bits: int = 0, grid_rounding: str = "nearest_even", grid_offset: Tuple[int, int] = (0, 0),
          fill_rule: str = "top_left", profile: str = "opengl", rows: str = "down", clip_depth: str = "zero_to_one",
          limits: Mapping[str, int] = {}, primitives: Sequence[str] = ()) -> None:
    """Answers certify's requests over stdin and stdout until there are no more.

    draw       is called with a Scene, and returns a dict of those images that scene.outputs names: "count", "index" (EMPTY where
               nothing is seen) as whole numbers, "depth" (infinity where nothing is seen; -infinity for "greater"),
               "barycentrics" (one more axis, of 3) as floats, "attributes" as a list of images; or one image alone, if one
               output is claimed. Raising Unsupported declines a scene; any other exception is a finding.
    outputs    that it has: at least one of count, index, depth. certify makes counts up by drawing each triangle alone.
    features   that it has beyond plain triangles in front of the eye: behind, draws, samples, cull, scissor, ... (the bits of
               certify/adapter.h, in lower case). What is not claimed is never asked for.
    form       "pixel" or "clip": whether it reads SceneDraw.positions or SceneDraw.clip.
    model      "unknown" (certify finds out), "exact", or "grid" with the grid_... and the fill_rule.
    profile    how precise depth and attributes are meant to be: "exact", "d3d11", "vulkan" or "opengl".
    rows       "down", or "up" if row 0 of its images is the bottom one.
    clip_depth  "zero_to_one" or "minus_one_to_one".
    limits     the most "width", "height", "vertices", "triangles", "attributes" and "components" that it takes.
    primitives  beside triangles: "lines", "points"; with the feature "widths" they may have one. (It then speaks version 2.)

    What is printed meanwhile goes to stderr, and is quoted where the rasterizer fails."""
    for limit in limits:
        _number_of("limits", limit, _LIMITS)
    info = struct.pack(
        "<64s64s18I", _text("name", name), _text("version", version), _bits("outputs", outputs, _OUTPUTS),
        _bits("features", features, _FEATURES), _number_of("form", form, ("pixel", "clip")),
        _number_of("model", model, ("unknown", "exact", "grid")), grid_bits,
        _number_of("grid_rounding", grid_rounding, _ROUNDINGS), *grid_offset,
        _number_of("fill_rule", fill_rule, _FILL_RULES), _number_of("profile", profile, _PROFILES),
        _number_of("rows", rows, ("down", "up")),
        _number_of("clip_depth", clip_depth, ("zero_to_one", "minus_one_to_one")), *(limits.get(n, 0) for n in _LIMITS))
    second = bool(primitives) or any(name in ("closed_and_open", "widths") for name in features)
    if second:
        info = struct.pack(
            "<2I64s64s2Q12I", 200, _number_of("form", form, ("pixel", "clip")), _text("name", name),
            _text("version", version), _bits("outputs", outputs, _OUTPUTS), _bits("features", features, _FEATURES),
            1 | _bits("primitives", primitives, _PRIMITIVES), _number_of("profile", profile, _PROFILES),
            _number_of("rows", rows, ("down", "up")),
            _number_of("clip_depth", clip_depth, ("zero_to_one", "minus_one_to_one")),
            grid_bits if model == "unknown" else 0, *(limits.get(n, 0) for n in _LIMITS), 0)
    requests = sys.stdin.buffer
    sys.stdout.flush()
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # so that a print is no part of an answer
    while (header := requests.read(8)) and len(header) == 8:
        kind, length = struct.unpack("<2I", header)
        if kind == _CLOSE:
            return
        body = requests.read(4 * length)
        status, answer = _OK, info
        if kind == _OPEN and second and struct.unpack_from("<I", body)[0] == 1:
            answer = struct.pack("<I", 2)  # asked for version 1: this is one of version 2
        if kind == _MODEL:
            if model == "unknown":
                status, answer = _UNSUPPORTED, b"no model is stated"
            else:
                answer = _model(grid_bits if model == "grid" else -1, grid_rounding, grid_offset, fill_rule, clip_depth)
        if kind == _DRAW:
            try:
                scene = _scene(body, second)
                answer = _answer(scene, draw(scene))
            except Unsupported as reason:
                status, answer = _UNSUPPORTED, str(reason).encode()
            except Exception as error:
                traceback.print_exc()
                status, answer = _FAILED, f"{type(error).__name__}: {error}".encode()
        if status != _OK:
            answer = answer[:1000] + b"\0" * (-len(answer[:1000]) % 4)
        answers.write(struct.pack("<2I", status, len(answer) // 4) + answer)
        answers.flush()
