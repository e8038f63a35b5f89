# SPDX-License-Identifier: Apache-2.0
"""A small renderer in Python: a rotating cube with smooth colours, as text, and a picture file if asked for.

    picture.py [PICTURE.ppm]
"""
import hashlib
import sys

import numpy as np

import surefill

HEIGHT, WIDTH = 24, 60


def cube():
    corners = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], np.float64)
    triangles = np.array([[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 4, 2], [2, 4, 6],
                          [1, 3, 5], [3, 7, 5], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7]], np.int32)
    return corners, triangles


def project(points):
    """Model to clip space by + and * alone, so that every machine gets the same bits. y up, depth 0..1."""
    cosine, sine = 0.8, 0.6
    x, y, z = points.T
    x, z = cosine * x + sine * z, cosine * z - sine * x
    y, z = cosine * y - sine * z, cosine * z + sine * y
    w = z + 5.0
    near, far = 2.0, 8.0
    clip = np.stack([2.0 * x * HEIGHT / WIDTH * 2.0, 2.0 * y, (w - near) * (far / (far - near)), w], axis=1)
    return np.ascontiguousarray(clip, np.float32)


def main():
    corners, triangles = cube()
    positions = surefill.to_pixel(project(corners), (HEIGHT, WIDTH))
    raster = surefill.rasterize(positions, triangles, (HEIGHT, WIDTH), cull="back")
    colours = surefill.interpolate(np.ascontiguousarray((corners + 1) / 2, np.float32), raster)

    for row in raster.index:
        print("".join("." if t == surefill.NO_TRIANGLE else "abcdef"[t // 2] for t in row))
    seen = raster.index != surefill.NO_TRIANGLE
    print(f"{seen.sum()} pixels of {len(np.unique(raster.index[seen]))} triangles, "
          f"depth {raster.depth[seen].min():.9g} to {raster.depth[seen].max():.9g}")
    digest = hashlib.sha256(raster.packed().astype("<f4").tobytes() + colours.astype("<f4").tobytes()).hexdigest()
    print(f"sha256 {digest}")
    if len(sys.argv) > 1:
        with open(sys.argv[1], "wb") as out:
            out.write(b"P6\n%d %d\n255\n" % (WIDTH, HEIGHT))
            out.write(np.rint(colours * 255).astype(np.uint8).tobytes())


if __name__ == "__main__":
    main()
