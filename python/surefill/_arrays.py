# SPDX-License-Identifier: Apache-2.0
"""Checks of arguments. Each message begins with the argument's name and ends with what to do."""

from __future__ import annotations

import numbers
from typing import TYPE_CHECKING, Any, Optional, Sequence, Tuple

import numpy as np

from . import _library as c
from ._words import WORDS

if TYPE_CHECKING:
    from numpy.typing import NDArray

Shape = Tuple[Optional[int], ...]


def any_array(name: str, value: object) -> NDArray[Any]:
    """`value` as an array: itself, or what it says of itself (a list, a tensor that lies in memory)."""
    if isinstance(value, np.ma.MaskedArray):
        raise TypeError(f"{name}: a masked array is not taken; fill it: {name}.filled(...)")
    if isinstance(value, np.ndarray):
        return np.asarray(value)
    if value is None or isinstance(value, (str, bytes, numbers.Number)):
        raise TypeError(f"{name}: a NumPy array is needed, not {type(value).__name__}")
    try:
        return np.asarray(value)
    except Exception as error:
        raise TypeError(f"{name}: a NumPy array is needed, not {type(value).__name__} ({error})") from None


def check_shape(name: str, array: NDArray[Any], *shapes: Shape) -> None:
    for shape in shapes:
        if array.ndim == len(shape) and all(n is None or n == m for n, m in zip(shape, array.shape)):
            return
    wanted = " or ".join("(" + ", ".join("any" if n is None else str(n) for n in s) + ("," if len(s) == 1 else "") + ")"
                         for s in shapes)
    row = shapes[0][-1]
    cure = f"; {name}.reshape(-1, {row}) makes it" if array.ndim == 1 and len(shapes[0]) == 2 and row and array.size % row == 0 else ""
    raise ValueError(f"{name}: shape {wanted} is needed, not {array.shape}{cure}")


def floats(name: str, value: object, *shapes: Shape, convert: bool = False) -> NDArray[np.float32]:
    """As C-contiguous float32: the array itself where it is so, else a copy. Numbers that float32 does not hold are refused, or
    rounded to nearest with `convert`."""
    array = any_array(name, value)
    check_shape(name, array, *shapes)
    if array.dtype == np.float32:
        return np.ascontiguousarray(array, np.float32)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name}: float32 is needed, not {array.dtype}")
    with np.errstate(all="ignore"):
        result = np.ascontiguousarray(array, np.float32)
        if not convert and array.dtype != np.float16:
            back = result.astype(array.dtype)
            if not (back == array).all() and not np.array_equal(back, array, equal_nan=array.dtype.kind == "f"):
                raise TypeError(f"{name}: float32 does not hold these {array.dtype} values exactly; round them by "
                                f"{name}.astype(numpy.float32), or give convert=True")
    return result


def whole_numbers(name: str, value: object, *shapes: Shape, error: type = ValueError) -> NDArray[np.uint32]:
    """As C-contiguous uint32: int32 by its bits, other types where all values fit."""
    array = any_array(name, value)
    if array.dtype.kind not in "iu" and array.size > 0:
        raise TypeError(f"{name}: whole numbers are needed, not {array.dtype}; {name}.astype(numpy.int64) makes some")
    check_shape(name, array, *shapes)
    if array.dtype == np.uint32 or array.dtype == np.int32:
        return np.ascontiguousarray(array).view(np.uint32)
    if array.size > 0 and not (array.min() >= 0 and array.max() < 0xFFFFFFFF):
        bad = array.min() if array.min() < 0 else array.max()
        raise error(f"{name}: {bad} is outside 0..4294967294")
    return np.ascontiguousarray(array, np.uint32)


def choice(name: str, value: object, words: str = "") -> int:
    choices = WORDS[words or name]
    if not isinstance(value, str) or value not in choices:
        raise ValueError(f"{name}: one of {', '.join(choices)} is needed, not {value!r}")
    return choices.index(value)


def whole(name: str, value: object, low: int, high: int) -> int:
    if not isinstance(value, numbers.Integral) or isinstance(value, bool):
        raise TypeError(f"{name}: a whole number is needed, not {type(value).__name__}")
    result = int(value)
    if not low <= result <= high:
        raise ValueError(f"{name}: {result} is outside {low}..{high}")
    return result


def wholes(name: str, value: object, number: int, low: int, high: int, what: str) -> Tuple[int, ...]:
    """A tuple, list or array of so many whole numbers."""
    if isinstance(value, str) or not isinstance(value, (Sequence, np.ndarray)) or len(value) != number:
        shown = f", not {tuple(value)}" if isinstance(value, (tuple, list, np.ndarray)) else ""
        raise TypeError(f"{name}: {what} is needed{shown}")
    return tuple(whole(name, entry, low, high) for entry in value)


def size_of(size: object) -> Tuple[int, int]:
    height, width = wholes("size", size, 2, 1, c.MAX_SIZE, "a pair (height, width), such as image.shape[:2],")
    return height, width


def number(name: str, value: object) -> float:
    if not isinstance(value, numbers.Real) or isinstance(value, bool):
        raise TypeError(f"{name}: a number is needed, not {type(value).__name__}")
    return float(value)
