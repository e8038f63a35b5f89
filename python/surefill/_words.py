# SPDX-License-Identifier: Apache-2.0
"""The words of enumerations, in the order of their values; made from the table of a draw's fields, by corpus/tests/python_words_test.cpp."""

from typing import Dict, Tuple

WORDS: Dict[str, Tuple[str, ...]] = {
    "fill_rule": ("top_left", "top_right", "bottom_left", "bottom_right", "southwards", "southwards_west", "northwards", "northwards_west", "closed", "open",),
    "front_face": ("clockwise", "counter_clockwise",),
    "cull": ("none", "front", "back",),
    "depth_mode": ("none", "clip", "clamp",),
    "conservative": ("none", "over", "inner", "overlap", "touched",),
    "primitive": ("triangles", "lines", "points",),
    "grid_rounding": ("nearest_even", "nearest_up", "truncate",),
    "depth_test": ("less", "greater", "less_equal", "greater_equal",),
    "attribute_location": ("centre", "centroid",),
    "interpolation": ("perspective", "noperspective", "flat",),
    "clip_depth": ("zero_to_one", "minus_one_to_one",),
    "clip_y": ("up", "down",),
}
