# SPDX-License-Identifier: Apache-2.0
"""What Python costs: medians of pairs of calls in turn, in the processor time of this thread.

    SUREFILL_LIBRARY=build/wheel/python/surefill/libsurefill.so python3 python/measure.py

The C call is surefill_render through ctypes, with everything prepared and its buffers used again."""
import ctypes
import statistics
import time

import numpy as np

import surefill
from surefill import _library as c

HEIGHT, WIDTH, PAIRS = 480, 640, 41


def grid(cells):
    """A bumpy sheet over the picture: 2 cells^2 triangles."""
    y, x = np.mgrid[0:cells + 1, 0:cells + 1] / cells
    w = 1 + 0.5 * np.sin(9 * x) * np.cos(7 * y)
    positions = np.stack([x * WIDTH * w, y * HEIGHT * w, np.full_like(w, -1), w], axis=-1).reshape(-1, 4).astype(np.float32)
    at = np.arange(cells * (cells + 1)).reshape(cells, cells + 1)[:, :-1].ravel()
    down = at + cells + 1
    return positions, np.concatenate([np.stack([at, at + 1, down], 1), np.stack([at + 1, down + 1, down], 1)]).astype(np.uint32)


def c_call(positions, triangles, attributes=None, images=()):
    """A prepared call: index, depth and barycentrics, or attributes alone, in images of up to four columns."""
    total = HEIGHT * WIDTH
    target = c.Target(struct_size=ctypes.sizeof(c.Target), width=WIDTH, height=HEIGHT, samples=1)
    draw = c.Draw(struct_size=ctypes.sizeof(c.Draw), vertices=positions.ctypes.data, vertex_count=len(positions),
                  indices=triangles.ctypes.data, index_count=triangles.size)
    kept = [positions, triangles, attributes]
    if attributes is None:
        for name, dtype, parts in (("index", np.uint32, 1), ("depth", np.float32, 1), ("barycentrics", np.float32, 3)):
            kept.append(np.empty(total * parts, dtype))
            setattr(target, name, kept[-1].ctypes.data)
            setattr(target, name + "_count", total * parts)
    else:
        columns = attributes.shape[1]
        buffers = [np.empty(total * 4, np.float32) for _ in range(columns // 4)]
        kept += buffers
        target.attributes = (c.AttributeTarget * len(buffers))(*(c.AttributeTarget(b.ctypes.data, b.size, 4) for b in buffers))
        draw.attributes = (c.AttributeArray * len(buffers))(*(
            c.AttributeArray(attributes.ctypes.data + 16 * k, attributes.size - 4 * k, 4, columns, 0) for k in range(len(buffers))))
        target.attribute_count = draw.attribute_count = len(buffers)
    options = c.Options(struct_size=ctypes.sizeof(c.Options))
    return lambda _kept=kept: c.check(c.render(target, draw, 1, options, None))


def median(function):
    start = time.thread_time()
    function()
    return time.thread_time() - start


def compare(name, one, other):
    pairs = [(median(one), median(other)) for _ in range(PAIRS)][1:]
    ratio = statistics.median(b / a for a, b in pairs)
    print(f"{name}: C {1e3 * statistics.median(a for a, _ in pairs):.2f} ms, Python "
          f"{1e3 * statistics.median(b for _, b in pairs):.2f} ms, ratio {ratio:.3f}")


for cells in (10, 70, 224):
    positions, triangles = grid(cells)
    values = np.random.default_rng(0).uniform(-1, 1, (len(positions), 8)).astype(np.float32)
    raster = surefill.rasterize(positions, triangles, (HEIGHT, WIDTH))
    prepared = c_call(positions, triangles)
    label = f"{WIDTH} x {HEIGHT}, {len(triangles)} triangles"
    compare(f"{label}, rasterize", prepared, lambda: surefill.rasterize(positions, triangles, (HEIGHT, WIDTH)))
    compare(f"{label}, rasterize, copy=False", prepared,
            lambda: surefill.rasterize(positions, triangles, (HEIGHT, WIDTH), copy=False))
    compare(f"{label}, rasterize, out=raster", prepared,
            lambda: surefill.rasterize(positions, triangles, (HEIGHT, WIDTH), out=raster))
    compare(f"{label}, interpolate 8", c_call(positions, triangles, values), lambda: surefill.interpolate(values, raster))
