# SPDX-License-Identifier: Apache-2.0
import concurrent.futures
import ctypes
import pathlib
import pickle
import platform
import re
import struct
import subprocess
import sys
import threading
import unittest

import numpy as np

import surefill

POSITIONS = np.array([[0, 0, 0.25, 1], [8, 0, 0.25, 1], [8, 8, 0.75, 1], [0, 8, 0.75, 1]], np.float32)
TRIANGLES = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
SIZE = (6, 8)


class Pictures(unittest.TestCase):
    def test_shapes_and_types(self):
        for samples, shape in ((1, (6, 8)), (4, (6, 8, 4))):
            raster = surefill.rasterize(POSITIONS, TRIANGLES, SIZE, samples=samples)
            self.assertEqual((raster.index.shape, raster.index.dtype), (shape, np.uint32))
            self.assertEqual((raster.depth.shape, raster.depth.dtype), (shape, np.float32))
            self.assertEqual(raster.barycentrics.shape, shape + (3,))
            self.assertEqual(surefill.interpolate(POSITIONS[:, :2].copy(), raster).shape, shape + (2,))
            self.assertEqual(raster.packed().shape, shape + (4,))

    def test_values_by_hand(self):
        raster = surefill.rasterize(POSITIONS, TRIANGLES, SIZE)
        # A sample on the diagonal belongs to the upper triangle, as its left edge.
        x, y = np.meshgrid(np.arange(8), np.arange(6))
        np.testing.assert_array_equal(raster.index, np.where(x >= y, 0, 1))
        np.testing.assert_array_equal(raster.depth, (0.25 + (y + 0.5) / 16).astype(np.float32))
        position = surefill.interpolate(np.ascontiguousarray(POSITIONS[:, :2]), raster)
        np.testing.assert_array_equal(position[..., 0], (x + 0.5).astype(np.float32))
        np.testing.assert_array_equal(position[..., 1], (y + 0.5).astype(np.float32))

    def test_packed_is_nvdiffrasts_layout(self):
        raster = surefill.rasterize(POSITIONS, TRIANGLES[:1], SIZE, identifiers=np.array([41], np.uint32))
        packed = raster.packed()
        np.testing.assert_array_equal(packed[0, 7], [raster.barycentrics[0, 7, 0], raster.barycentrics[0, 7, 1],
                                                     raster.depth[0, 7], 42])
        np.testing.assert_array_equal(packed[5, 0], [0, 0, 0, 0])
        self.assertEqual(raster.index[5, 0], surefill.NO_TRIANGLE)
        big = surefill.rasterize(POSITIONS, TRIANGLES[:1], SIZE, identifiers=np.array([1 << 24], np.uint32))
        self.assertRaisesRegex(ValueError, "index", big.packed)

    def test_options_matter(self):
        def of(**options):
            return surefill.rasterize(POSITIONS, TRIANGLES, SIZE, **options)

        covered = of().index != surefill.NO_TRIANGLE
        self.assertTrue(covered.all())
        self.assertFalse((of(cull="front").index != surefill.NO_TRIANGLE).any())
        self.assertTrue((of(cull="front", front_face="counter_clockwise").index != surefill.NO_TRIANGLE).all())
        self.assertTrue((of(depth_test="greater").depth == of().depth).all())
        np.testing.assert_array_equal(of(fill_rule="bottom_right").index[np.arange(6), np.arange(6)], 1)
        near = np.full(SIZE, 0.5, np.float32)
        beaten = of(initial_depth=near)
        np.testing.assert_array_equal(beaten.index != surefill.NO_TRIANGLE, of().depth < 0.5)
        np.testing.assert_array_equal(beaten.depth, np.minimum(of().depth, near))
        np.testing.assert_array_equal(of(threads=3).barycentrics, of().barycentrics)

    def test_interpolation_is_what_rasterize_saw(self):
        w = np.array([[1], [2], [4], [0.5]], np.float32)
        raster = surefill.rasterize(POSITIONS * w, TRIANGLES, SIZE)
        for i in range(3):  # the unit vectors of triangle 0 give its barycentrics
            unit = np.zeros((4, 1), np.float32)
            unit[TRIANGLES[0, i]] = 1
            of_triangle = raster.index == 0
            np.testing.assert_array_equal(surefill.interpolate(unit, raster)[of_triangle, 0],
                                          raster.barycentrics[of_triangle, i])
        flat = surefill.interpolate(np.array([[5], [6], [7], [8]], np.float32), raster, interpolation="flat")
        self.assertTrue((flat == 5).all())
        affine = surefill.interpolate(POSITIONS[:, :1].copy(), raster, interpolation="noperspective")
        np.testing.assert_array_equal(affine[..., 0], np.broadcast_to(np.arange(8) + np.float32(0.5), SIZE))

    def test_coverage(self):
        count = surefill.coverage(POSITIONS, np.concatenate([TRIANGLES, TRIANGLES[:1]]), SIZE)
        x, y = np.meshgrid(np.arange(8), np.arange(6))
        np.testing.assert_array_equal(count, np.where(x >= y, 2, 1))
        over = surefill.coverage(POSITIONS, TRIANGLES[:1], SIZE, conservative="over")
        # The closed triangle meets the square below the diagonal in its corner.
        np.testing.assert_array_equal(over, np.where(x >= y - 1, 1, 0))
        inner = surefill.coverage(POSITIONS, TRIANGLES[:1], SIZE, conservative="inner")
        np.testing.assert_array_equal(inner, np.where(x > y, 1, 0))

    def test_to_pixel(self):
        clip = np.array([[-1, 1, 0.5, 1], [1, -1, 0, 2], [0, 0, -3, -1]], np.float32)
        pixel = surefill.to_pixel(clip, (4, 8))
        np.testing.assert_array_equal(pixel, np.array([[0, 0, 0.5, 1], [12, 6, 0, 2], [-4, -2, -3, -1]], np.float32))
        down = surefill.to_pixel(clip, (4, 8), clip_y="down", clip_depth="minus_one_to_one")
        np.testing.assert_array_equal(down[0], [0, 4, 0.75, 1])

    def test_a_nan_drops_a_triangle(self):
        positions = POSITIONS.copy()
        positions[1, 0] = np.nan
        self.assertEqual(set(surefill.rasterize(positions, TRIANGLES, SIZE).index.ravel()), {1, surefill.NO_TRIANGLE})

    def test_nothing_is_copied_and_threads_run(self):
        # A view of a larger array, where it lies.
        block = np.zeros((10, 4), np.float32)
        block[3:7] = POSITIONS
        np.testing.assert_array_equal(surefill.rasterize(block[3:7], TRIANGLES, SIZE).depth,
                                      surefill.rasterize(POSITIONS, TRIANGLES, SIZE).depth)
        # The GIL is released: this thread counts on while another draws.
        many = np.tile(TRIANGLES, (150, 1))
        done = threading.Event()

        def draw():
            surefill.rasterize(POSITIONS * np.float32([256, 256, 1, 1]), many, (2048, 2048))
            done.set()

        worker = threading.Thread(target=draw)
        worker.start()
        steps = 0
        while not done.wait(0.001):
            steps += 1
        worker.join()
        self.assertGreater(steps, 5)


class Arrays(unittest.TestCase):
    """What is converted, and what is the caller's."""

    def test_conversions_that_change_nothing(self):
        expected = surefill.rasterize(POSITIONS, TRIANGLES, SIZE).depth
        for positions in (POSITIONS.astype(np.float64), POSITIONS.tolist(), POSITIONS.astype(">f4"), POSITIONS.astype(np.float16),
                          np.asfortranarray(POSITIONS), np.repeat(POSITIONS, 2, axis=0)[::2]):
            for triangles in (TRIANGLES.astype(np.int64), TRIANGLES.astype(np.uint8), TRIANGLES.tolist()):
                np.testing.assert_array_equal(surefill.rasterize(positions, triangles, SIZE).depth, expected)
        nan = POSITIONS.astype(np.float64)
        nan[0, 0] = np.nan  # is NaN in float32, too
        self.assertEqual(surefill.rasterize(nan, TRIANGLES, SIZE, outputs="statistics").statistics.dropped, 2)

    def test_conversions_on_request(self):
        positions = POSITIONS.astype(np.float64) + 0.1
        raster = surefill.rasterize(positions, TRIANGLES, SIZE, convert=True)
        np.testing.assert_array_equal(raster.depth, surefill.rasterize(positions.astype(np.float32), TRIANGLES, SIZE).depth)
        self.assertRaisesRegex(TypeError, r"astype\(numpy.float32\), or give convert=True", surefill.rasterize, positions,
                               TRIANGLES, SIZE)
        surefill.to_pixel(positions, SIZE, convert=True)
        surefill.interpolate(positions, raster, convert=True)

    def test_a_buffer_used_again_changes_nothing(self):
        positions, triangles, initial = POSITIONS.copy(), TRIANGLES.copy(), np.full(SIZE, 0.5, np.float32)
        raster = surefill.rasterize(positions, triangles, SIZE, initial_depth=initial)
        kept = surefill.rasterize(positions, triangles, SIZE, copy=False)
        values = np.ascontiguousarray(POSITIONS[:, :2])
        before = surefill.interpolate(values, raster), surefill.interpolate(values, kept)
        positions[:], triangles[:], initial[:] = 0, 0, 0
        np.testing.assert_array_equal(surefill.interpolate(values, raster), before[0])
        self.assertFalse(np.array_equal(surefill.interpolate(values, kept), before[1]))

    def test_out_is_written_over(self):
        first = surefill.rasterize(POSITIONS, TRIANGLES, SIZE)
        second = surefill.rasterize(POSITIONS, TRIANGLES[:1], SIZE, out=first)
        self.assertIs(first.index, second.index)
        self.assertEqual(int((second.index == 1).sum()), 0)
        self.assertIsNot(surefill.rasterize(POSITIONS, TRIANGLES, (4, 4), out=first).index, first.index)

    def test_only_what_is_asked_for(self):
        raster = surefill.rasterize(POSITIONS, TRIANGLES, SIZE, outputs="depth")
        self.assertRaisesRegex(AttributeError, "index: it was not asked for", lambda: raster.index)
        self.assertRaisesRegex(AttributeError, "attributes: none were given", lambda: raster.attributes)
        self.assertEqual(repr(raster), "<surefill.Raster 6 x 8: depth>")
        self.assertEqual(repr(surefill.rasterize(POSITIONS, TRIANGLES, SIZE, samples=4, layers=2, attributes=POSITIONS)),
                         "<surefill.Raster 6 x 8, 2 layers, 4 samples: index, depth, barycentrics, attributes>")
        copy = pickle.loads(pickle.dumps(surefill.rasterize(POSITIONS, TRIANGLES, SIZE)))
        np.testing.assert_array_equal(surefill.interpolate(POSITIONS, copy)[..., 0], np.arange(8)[None] + np.float32(0.5) +
                                      np.zeros(SIZE, np.float32))


class Modes(unittest.TestCase):
    """What C has, reached from Python."""

    MESH = np.random.default_rng(24)  # seed 24; 60 triangles
    V = (MESH.uniform(-2, 10, (60, 4)) * [1, 1, 0.1, 0] + [0, 0, 0.5, 1]).astype(np.float32)
    T = MESH.integers(0, 60, (60, 3))

    def test_columns_of_one_pass(self):
        for columns in (1, 4, 5, 8, 63, 70):
            values = np.random.default_rng(columns).uniform(-1, 1, (60, columns)).astype(np.float32)
            together = surefill.rasterize(self.V, self.T, SIZE, attributes=values)
            alone = np.stack([surefill.interpolate(values[:, k], together) for k in range(columns)], axis=-1)
            np.testing.assert_array_equal(together.attributes, alone)
            np.testing.assert_array_equal(surefill.interpolate(values, together), alone)
        words = ["flat", "perspective", "perspective", "noperspective", "flat"]
        mixed = surefill.interpolate(values[:, :5], together, interpolation=words)
        for k, word in enumerate(words):
            np.testing.assert_array_equal(mixed[..., k], surefill.interpolate(values[:, k], together, interpolation=word))

    def test_batches(self):
        shifted = np.stack([self.V, self.V + np.float32([2, 1, 0, 0]), self.V[::-1]])
        values = np.random.default_rng(1).uniform(-1, 1, (3, 60, 6)).astype(np.float32)
        for samples in (1, 2):
            batch = surefill.rasterize(shifted, self.T, SIZE, samples=samples, attributes=values, outputs=["index", "covered"])
            self.assertEqual(batch.index.shape, (3, *SIZE) if samples == 1 else (3, *SIZE, 2))
            self.assertIn("3 images", repr(batch))
            again = surefill.interpolate(values[0], batch)
            for k in range(3):
                one = surefill.rasterize(shifted[k], self.T, SIZE, samples=samples, attributes=values[k],
                                         outputs=["index", "covered"])
                np.testing.assert_array_equal(batch.index[k], one.index)
                np.testing.assert_array_equal(batch.attributes[k], one.attributes)
                np.testing.assert_array_equal(batch.covered[k], one.covered)
                np.testing.assert_array_equal(again[k], surefill.interpolate(values[0], one))
        parts = surefill.rasterize(self.V, self.T, SIZE, ranges=[[0, 20], [20, 40], [5, 0]], outputs=["index", "visible"])
        np.testing.assert_array_equal(parts.index[0], surefill.rasterize(self.V, self.T[:20], SIZE).index)
        second = surefill.rasterize(self.V, self.T[20:], SIZE)
        np.testing.assert_array_equal(parts.index[1], np.where(second.mask, second.index + 20, surefill.NO_TRIANGLE))
        self.assertFalse(parts.mask[2].any())
        self.assertEqual(parts.visible.sum(), parts.mask.sum())
        self.assertEqual(surefill.to_pixel(shifted, SIZE).shape, shifted.shape)

    def test_draws_are_numbered_on(self):
        draws = [surefill.Draw(POSITIONS, TRIANGLES[:1], scissor=(0, 0, 4, 6)), surefill.Draw(POSITIONS, TRIANGLES[1:]),
                 surefill.Draw(POSITIONS - np.float32([0, 0, 1, 0]), TRIANGLES, depth_write=False, scissor=(7, 0, 8, 1))]
        raster = surefill.render(draws, SIZE, outputs=["index", "visible", "depth"])
        x, y = np.meshgrid(np.arange(8), np.arange(6))
        expected = np.where(x < y, 1, np.where(x < 4, 0, surefill.NO_TRIANGLE))
        expected[0, 7] = 2
        np.testing.assert_array_equal(raster.index, expected)
        self.assertEqual([int(v.sum()) for v in raster.visible], [10, 21 - 6, 1])
        values = [POSITIONS[:, :1], POSITIONS[:, :1], np.full((4, 1), 9, np.float32)]
        seen = surefill.interpolate(values, raster)[..., 0]
        np.testing.assert_array_equal(seen[:, :4], np.broadcast_to(np.arange(4) + np.float32(0.5), (6, 4)))
        self.assertEqual(seen[0, 7], 9)
        self.assertRaisesRegex(ValueError, "^attributes: a list of 3", surefill.interpolate, POSITIONS, raster)

    def test_layers_origin_and_sample_places(self):
        stack = np.concatenate([TRIANGLES, TRIANGLES[:1]])
        layers = surefill.rasterize(POSITIONS, stack, SIZE, layers=3, outputs=["index", "depth", "count"])
        self.assertEqual((layers.index.shape, layers.count.shape), ((3, *SIZE), SIZE))
        np.testing.assert_array_equal(layers.mask.sum(axis=0), layers.count)
        np.testing.assert_array_equal(layers.index[:, 0, 7], [0, 2, surefill.NO_TRIANGLE])
        whole = surefill.rasterize(self.V, self.T, (6, 16))
        tile = surefill.rasterize(self.V, self.T, (3, 5), origin=(7, 2))
        np.testing.assert_array_equal(tile.barycentrics, whole.barycentrics[2:5, 7:12])
        moved = surefill.rasterize(POSITIONS, TRIANGLES, SIZE, sample_locations=[(0, 0)]).depth
        np.testing.assert_array_equal(moved[:, 7], (0.25 + np.arange(6) / 16).astype(np.float32))
        self.assertEqual(surefill.sample_locations(1), ((8, 8),))
        standard = surefill.rasterize(self.V, self.T, SIZE, samples=4)
        np.testing.assert_array_equal(standard.index, surefill.rasterize(
            self.V, self.T, SIZE, samples=4, sample_locations=surefill.sample_locations(4)).index)

    def test_numbers_and_states(self):
        raster = surefill.rasterize(POSITIONS, TRIANGLES[:, ::-1], SIZE, outputs=["winding", "covered", "visible"])
        self.assertTrue((raster.winding == -1).all())
        np.testing.assert_array_equal(raster.covered, [33, 15])
        self.assertEqual(raster.covered.dtype, np.uint64)
        far = surefill.rasterize(POSITIONS, np.concatenate([TRIANGLES, TRIANGLES]), SIZE, depth_test="less_equal").index
        self.assertTrue((far >= 2).all())
        biased = surefill.rasterize(POSITIONS, TRIANGLES, SIZE, depth_bias=(0.5, 0)).depth
        np.testing.assert_array_equal(biased, surefill.rasterize(POSITIONS, TRIANGLES, SIZE).depth + np.float32(0.5))
        corner = np.float32([[0.5, 0.5, 0, 1], [3, 0.5, 0, 1], [0.5, 3, 0, 1]])
        for grid, pixels in ((None, 6), (0, 3), (surefill.Grid(0, "nearest_up"), 1)):
            self.assertEqual(int(surefill.coverage(corner, [[0, 1, 2]], SIZE, grid=grid).sum()), pixels, grid)
        line = np.float32([[1.5, 1.5, 0, 1], [5.5, 1.5, 0, 1], [3.5, 1.5, 0, 1]])
        for how, pixels in (("over", 0), ("touched", 5), ("overlap", 0)):
            self.assertEqual(int(surefill.coverage(line, [[0, 1, 2]], SIZE, conservative=how).sum()), pixels, how)
        owner = surefill.rasterize(POSITIONS, TRIANGLES[:1], SIZE, conservative="over")
        np.testing.assert_array_equal(owner.mask, surefill.coverage(POSITIONS, TRIANGLES[:1], SIZE, conservative="over") == 1)
        self.assertEqual(surefill.rasterize(POSITIONS, TRIANGLES, SIZE, cull="front", outputs="statistics").statistics.culled, 2)
        reference = surefill.render([surefill.Draw(self.V, self.T)], SIZE, path="reference", outputs=["barycentrics", "statistics"])
        self.assertEqual(reference.statistics.path, "reference")
        np.testing.assert_array_equal(reference.barycentrics, surefill.rasterize(self.V, self.T, SIZE).barycentrics)

    def test_threads_of_a_pool_and_a_context(self):
        context, expected = surefill.Context(), surefill.rasterize(self.V * np.float32([40, 40, 1, 1]), self.T, (300, 400))
        with concurrent.futures.ThreadPoolExecutor(3) as pool:
            for _ in range(2):
                drawn = surefill.rasterize(self.V * np.float32([40, 40, 1, 1]), self.T, (300, 400), threads=4, executor=pool,
                                           context=context)
                np.testing.assert_array_equal(drawn.depth, expected.depth)
        # A pool that takes no more: the work is done all the same, and the pool's complaint is raised.
        self.assertRaisesRegex(RuntimeError, "shutdown", surefill.rasterize, self.V, self.T, (300, 400), threads=4, executor=pool)

    def test_streams(self):
        count = np.zeros((96, 128), np.uint32)

        def visit(blocks):
            for block in blocks:
                bits = (int(block["mask"]) >> np.arange(64, dtype=object) & 1).astype(np.uint32).reshape(8, 8)
                part = count[block["y"]:block["y"] + 8, block["x"]:block["x"] + 8]
                part += bits[:part.shape[0], :part.shape[1]]

        positions = self.V * np.float32([12, 12, 1, 1])
        told = surefill.visit_coverage(surefill.Draw(positions, self.T), count.shape, visit, threads=2)
        np.testing.assert_array_equal(count, surefill.coverage(positions, self.T, count.shape))
        self.assertEqual(told.triangles, 60)
        self.assertRaises(ZeroDivisionError, surefill.visit_coverage, surefill.Draw(positions, self.T), count.shape,
                          lambda blocks: 1 / 0)
        self.assertRaisesRegex(TypeError, "^draws: ", surefill.visit_coverage, positions, count.shape, visit)

    def test_occlusion(self):
        buffer = surefill.OcclusionBuffer(SIZE)
        box = np.array([[x, y, z, 1] for x in (2, 4) for y in (2, 4) for z in (2, 3)], np.float32)
        boxes = np.stack([box, box + np.float32([100, 0, 0, 0]), box - np.float32([0, 0, 5, 0])])
        self.assertEqual(buffer.query_boxes(boxes).tolist(), [2, 0, 2])
        buffer.draw([surefill.Draw(POSITIONS, TRIANGLES)])
        np.testing.assert_array_equal(buffer.depth, surefill.rasterize(POSITIONS, TRIANGLES, SIZE).depth)
        self.assertEqual(buffer.query_boxes(boxes).tolist(), [buffer.HIDDEN, buffer.OUTSIDE, buffer.VISIBLE])
        self.assertEqual(buffer.query_rectangles([[2, 2, 4, 4, 0.875], [2, 2, 4, 4, 0.125]]).tolist(), [1, 2])
        buffer.clear()
        self.assertEqual(buffer.query_boxes(boxes[:1]).tolist(), [2])
        self.assertRaisesRegex(ValueError, "^boxes: ", buffer.query_boxes, box)

    def test_safe_occlusion(self):
        square = np.array([[-9, -9, 0.5, 1], [40, -9, 0.5, 1], [-9, 40, 0.5, 1], [40, 40, 0.5, 1]], np.float32)
        mesh = surefill.OccluderMesh(square[:, :3], [[0, 1, 2], [2, 1, 3]])
        self.assertRaisesRegex(IndexError, "^triangles: ", surefill.OccluderMesh, square[:, :3], [[0, 1, 4]])
        buffer = surefill.SafeOcclusionBuffer((8, 8))
        box = np.array([[x, y, z, 1] for x in (2, 4) for y in (2, 4) for z in (0.5, 1)], np.float32)
        boxes = np.stack([box, box + np.float32([100, 0, 0, 0]), box - np.float32([0, 0, 5, 0])])
        self.assertEqual(buffer.query_boxes(boxes).tolist(), [2, 0, 2])
        buffer.draw(mesh, square)
        np.testing.assert_array_equal(buffer.depth, np.full((8, 8), 0.5))
        self.assertEqual(buffer.query_boxes(boxes).tolist(), [buffer.HIDDEN, buffer.OUTSIDE, buffer.VISIBLE])
        buffer.clear()
        buffer.draw([mesh, mesh], [square, square * np.float32(2)], cull="front", threads=2)
        self.assertEqual(buffer.query_boxes(boxes).tolist(), [2, 0, 2])
        strict = surefill.SafeOcclusionBuffer((8, 8), equal_is_visible=True)
        strict.draw(mesh, square)
        self.assertEqual(strict.query_boxes(boxes).tolist(), [2, 0, 2])
        self.assertEqual(strict.query_rectangles([[2, 2, 4, 4, 0.75]]).tolist(), [1])
        self.assertRaisesRegex(ValueError, "^positions: ", buffer.draw, mesh, square[:3])
        self.assertRaisesRegex(TypeError, "^meshes: ", buffer.draw, [1], [square])
        twice = surefill.OccluderMesh(square[[0, 1, 2, 3, 0], :3], [[0, 1, 2], [2, 1, 3]])
        moved = np.concatenate([square, square[:1] + np.float32([1, 0, 0, 0])])
        self.assertRaises(ValueError, buffer.draw, twice, moved)

    def test_cameras(self):
        points, K = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.5]]), np.array([[100, 0, 31.5], [0, 100, 23.5], [0, 0, 1]])
        positions = surefill.opencv(points, K, np.eye(3), [0, 0, 4])
        np.testing.assert_array_equal(positions[0], [32 * 4, 24 * 4, -1, 4])
        np.testing.assert_array_equal(positions[2], [32 * 4.5, 100 + 24 * 4.5, -1, 4.5])
        self.assertEqual(surefill.opencv(points, K, np.stack([np.eye(3)] * 2), np.zeros((2, 3, 1))).shape, (2, 3, 4))
        clip = np.c_[points, np.ones(3)] @ np.diag([2, 2, 1, 1]).T
        np.testing.assert_array_equal(surefill.opengl(points, np.diag([2, 2, 1, 1]), SIZE),
                                      surefill.to_pixel(clip, SIZE, clip_depth="minus_one_to_one"))
        np.testing.assert_array_equal(surefill.orthographic(points, (-1, -2, 3, 2), (8, 16))[1], [8, 4, 0, 1])
        np.testing.assert_array_equal(surefill.top_down(points, (0, 0, 2, 2), (4, 8))[2], [0, 2, -0.5, 1])
        self.assertRaisesRegex(ValueError, "^box: ", surefill.orthographic, points, (0, 0, 0, 1), SIZE)
        self.assertRaisesRegex(ValueError, "^K: ", surefill.opencv, points, np.eye(4), np.eye(3), [0, 0, 4])
        self.assertRaisesRegex(ValueError, "^points: ", surefill.opencv, points[:, :2], K, np.eye(3), [0, 0, 4])

    def test_numbers_are_rounded_without_the_float_state(self):
        from surefill._library import float32_bits
        rng = np.random.default_rng(3)
        doubles = np.concatenate([rng.integers(0, 2**64, 2000, np.uint64).view(np.float64), [0.0, -0.0, np.inf, 1e39, 2**-150, 2**-149],
                                  (rng.uniform(-1, 1, 2000) * 2.0 ** rng.integers(-155, 130, 2000))])
        doubles = doubles[~np.isnan(doubles)]
        with np.errstate(all="ignore"):
            np.testing.assert_array_equal([float32_bits(float(d)) for d in doubles], doubles.astype(np.float32).view(np.uint32))


class Recipes(unittest.TestCase):
    """Each block of docs/python.md that is marked python, in order."""

    def test_each_block(self):
        here = pathlib.Path(__file__).resolve()
        pages = [page for page in (here.with_name("python.md"), here.parent.parent / "docs/python.md") if page.exists()]
        text = pages[0].read_text()
        blocks, names = list(re.finditer(r"^```python\n(.*?)^```", text, re.M | re.S)), {}
        self.assertGreater(len(blocks), 12)
        for block in blocks:
            lines_before = text.count("\n", 0, block.start(1))
            exec(compile("\n" * lines_before + block[1], str(pages[0]), "exec"), names)


class WrongCalls(unittest.TestCase):
    """Each raises an exception that names the argument, and writes to none."""

    def setUp(self):
        self.before = POSITIONS.tobytes(), TRIANGLES.tobytes()

    def tearDown(self):
        self.assertEqual((POSITIONS.tobytes(), TRIANGLES.tobytes()), self.before)

    def wrong(self, error, name, function, *arguments, **options):
        self.assertRaisesRegex(error, f"^{name}: ", function, *arguments, **options)

    def test_rasterize(self):
        def call(error, name, positions=POSITIONS, triangles=TRIANGLES, size=SIZE, **options):
            self.wrong(error, name, surefill.rasterize, positions, triangles, size, **options)

        call(TypeError, "positions", positions=None)
        call(TypeError, "positions", positions="triangle")
        call(TypeError, "positions", positions=POSITIONS.astype(np.float64) + 0.1)
        call(TypeError, "positions", positions=POSITIONS.astype(np.complex64))
        call(TypeError, "positions", positions=np.ma.array(POSITIONS, mask=POSITIONS > 7))
        call(ValueError, "positions", positions=POSITIONS[:, :3].copy())
        call(ValueError, "positions", positions=POSITIONS.ravel())
        call(TypeError, "triangles", triangles=TRIANGLES.astype(np.float32))
        call(TypeError, "triangles", triangles=TRIANGLES.astype(bool))
        call(IndexError, "triangles", triangles=TRIANGLES.astype(np.int64) - 1)
        call(IndexError, "triangles", triangles=TRIANGLES.astype(np.int64) + 2**32)
        call(ValueError, "triangles", triangles=TRIANGLES.ravel())
        call(IndexError, "triangles", triangles=TRIANGLES + np.int32(2))
        call(IndexError, "triangles", triangles=TRIANGLES - np.int32(1))
        call(TypeError, "size", size=6)
        call(TypeError, "size", size=(6.0, 8))
        call(ValueError, "size", size=(-6, 8))
        call(ValueError, "size", size=(0, 8))
        call(ValueError, "size", size=(6, 16385))
        call(ValueError, "samples", samples=3)
        call(TypeError, "samples", samples="4")
        call(ValueError, "identifiers", identifiers=np.arange(3, dtype=np.uint32))
        call(TypeError, "identifiers", identifiers=[1.5, 2])
        call(ValueError, "identifiers", identifiers=np.array([3, -1], np.int32))
        call(ValueError, "identifiers", identifiers=np.array([surefill.NO_TRIANGLE, 3], np.uint32))
        call(ValueError, "initial_depth", initial_depth=np.zeros((8, 6), np.float32))
        call(ValueError, "fill_rule", fill_rule="left")
        call(ValueError, "front_face", front_face=None)
        call(ValueError, "cull", cull="both")
        call(ValueError, "depth_test", depth_test="equal")
        call(ValueError, "depth_mode", depth_mode=1)
        call(ValueError, "threads", threads=0)
        call(TypeError, "size", size=(6, 8, 3))
        call(ValueError, "outputs", outputs=["colour"])
        call(ValueError, "layers", layers=17)
        call(TypeError, "origin", origin=5)
        call(ValueError, "origin", origin=(0, 1 << 23))
        call(ValueError, "sample_locations", sample_locations=[(1, 2), (3, 4)])
        call(ValueError, "sample_locations", sample_locations=[(1, 16)])
        call(TypeError, "scissor", scissor=(0, 0, 4))
        call(ValueError, "grid", grid=13)
        self.wrong(ValueError, "culling_box", surefill.Draw, POSITIONS, TRIANGLES, culling_box=np.zeros((7, 4), np.float32))
        call(TypeError, "depth_bias", depth_bias=0.5)
        call(ValueError, "depth_bias", depth_bias=(0.5, float("nan")))
        call(ValueError, "ranges", ranges=[(0, 2), (1, 2)])
        call(TypeError, "context", context=1)
        call(TypeError, "executor", executor=1)
        call(TypeError, "out", out=1)
        call(ValueError, "interpolation", attributes=POSITIONS, interpolation=["flat"])
        call(ValueError, "conservative", conservative="inner", samples=1, outputs="depth")
        call(ValueError, "layers", layers=2, conservative="over")
        call(ValueError, "initial_depth", initial_depth=np.zeros((8, 6), np.float32))

    def test_flat_arrays_are_told_the_cure(self):
        for positions, triangles, cure in ((POSITIONS, [0, 1, 2], r"triangles\.reshape\(-1, 3\)"),
                                           (np.zeros(12, np.float32), TRIANGLES, r"positions\.reshape\(-1, 4\)")):
            with self.assertRaisesRegex(ValueError, cure):
                surefill.rasterize(positions, triangles, SIZE)

    def test_interpolate(self):
        raster = surefill.rasterize(POSITIONS, TRIANGLES, SIZE)
        self.wrong(TypeError, "raster", surefill.interpolate, POSITIONS, raster.index)
        self.wrong(TypeError, "attributes", surefill.interpolate, None, raster)
        self.wrong(ValueError, "attributes", surefill.interpolate, POSITIONS[:3], raster)
        self.wrong(ValueError, "attributes", surefill.interpolate, np.zeros((4, 0), np.float32), raster)
        self.wrong(ValueError, "attributes", surefill.interpolate, np.zeros((2, 4, 3), np.float32), raster)
        self.wrong(ValueError, "interpolation", surefill.interpolate, POSITIONS, raster, interpolation="cubic")

    def test_coverage_and_to_pixel(self):
        self.wrong(ValueError, "conservative", surefill.coverage, POSITIONS, TRIANGLES, SIZE, conservative="yes")
        self.wrong(ValueError, "conservative", surefill.coverage, POSITIONS, TRIANGLES, SIZE, conservative="over",
                   samples=4)
        self.wrong(TypeError, "clip", surefill.to_pixel, POSITIONS.astype(np.float64) + 0.1, SIZE)
        self.wrong(TypeError, "depth_range", surefill.to_pixel, POSITIONS, SIZE, depth_range=1)
        self.wrong(ValueError, "depth_range", surefill.to_pixel, POSITIONS, SIZE, depth_range=(0, float("nan")))
        self.wrong(ValueError, "clip_y", surefill.to_pixel, POSITIONS, SIZE, clip_y="left")


@unittest.skipUnless(sys.platform == "linux" and platform.machine() == "x86_64", "the float state is set as Linux has it")
class FloatState(unittest.TestCase):
    """B4: the caller's rounding mode, FTZ and DAZ change nothing, and are the caller's again, with the exception flags."""

    ROUNDINGS = (0, 1, 2, 3)
    FTZ, DAZ, TRAPS_OFF, FLAGS = 0x8000, 0x40, 0x1F80, 0x3F
    LIBM = ctypes.CDLL("libm.so.6")
    SIZE = 32  # of a fenv_t: the coprocessor's 28 bytes, then MXCSR

    def state(self):
        environment = ctypes.create_string_buffer(self.SIZE)
        self.LIBM.fegetenv(environment)
        return environment

    def in_state(self, mxcsr, function):
        before, changed = self.state(), self.state()
        struct.pack_into("<I", changed, 28, mxcsr)
        after = ctypes.create_string_buffer(self.SIZE)
        try:
            self.LIBM.fesetenv(changed)
            result = function()
            self.LIBM.fegetenv(after)
        finally:
            self.LIBM.fesetenv(before)
        self.assertEqual(struct.unpack_from("<I", after, 28)[0], mxcsr)
        return result

    def test_all_functions(self):
        rng = np.random.default_rng(15)
        scale = rng.choice(np.array([1, 2**-127, 2**-140]), (40, 1))
        clip = (rng.uniform(-1, 1, (40, 4)) * scale).astype(np.float32)
        positions = surefill.to_pixel(clip, SIZE)
        wall = np.array([[0, 0, 2**-127, 1], [9, 0, 2**-127, 1], [0, 9, 2**-127, 1]], np.float32)
        vertices = np.concatenate((positions[:36], wall))
        triangles = np.arange(39, dtype=np.int32).reshape(13, 3)
        values = (rng.uniform(-1, 1, (39, 2)) * np.array([1, 2**-130])).astype(np.float32)
        initial = np.full(SIZE, 2**-128, np.float32)

        def results():
            raster = surefill.rasterize(vertices, triangles, SIZE)
            return (surefill.to_pixel(clip, SIZE, depth_range=(0.1, 0.7), clip_depth="minus_one_to_one"),
                    surefill.to_pixel(clip, SIZE, depth_range=(1e-45, 2**-127 / 3)),
                    raster.index, raster.depth, raster.barycentrics, surefill.interpolate(values, raster),
                    surefill.rasterize(wall, triangles[:1], SIZE, initial_depth=initial, threads=3).index,
                    surefill.coverage(vertices, triangles, SIZE, samples=4))

        expected = [array.tobytes() for array in results()]
        for rounding in self.ROUNDINGS:
            for flush in (0, self.FTZ, self.DAZ, self.FTZ | self.DAZ):
                for flags in (0, self.FLAGS):
                    arrays = self.in_state(rounding << 13 | flush | self.TRAPS_OFF | flags, results)
                    for number, (array, wanted) in enumerate(zip(arrays, expected)):
                        self.assertEqual(array.tobytes(), wanted, (rounding, flush, number))

    def test_what_is_refused(self):
        bad = np.array([[0, np.nan, 0, 1]], np.float32)

        def call():
            for depth_range in ((0, 1e39), (float("inf"), 1)):
                try:
                    surefill.to_pixel(bad, SIZE, depth_range=depth_range)
                except ValueError as error:
                    if not str(error).startswith("depth_range"):
                        raise

        self.in_state(self.TRAPS_OFF | self.FTZ, call)


# The engine behind `serve`, drawing as certify asks; the texts for the faults are put in by the tests.
SERVED = """
import numpy as np, surefill
def draw(scene):
    draw, = scene.draws
    print("drawing")  # is no part of the answer
    if len(draw.triangles) > 2:
        raise surefill.Unsupported("more than two triangles")
    raster = surefill.rasterize(draw.positions, draw.triangles, (scene.height, scene.width), samples=scene.samples,
                                identifiers=draw.identifiers, depth_test=scene.depth_test, cull=draw.cull)
    values = [surefill.interpolate(np.ascontiguousarray(a.values), raster, interpolation=a.interpolation)
              for a in draw.attributes]
    count = (raster.index != surefill.NO_TRIANGLE).astype(np.uint8)
    return {"count": count, "index": raster.index, "depth": raster.depth, "attributes": values}
surefill.serve(draw, name="served", version="7", outputs=["count", "index", "depth", "attributes"],
               features=["samples", "cull", "flat"], model="exact", profile="exact", limits={"width": 512})
"""


class Serving(unittest.TestCase):
    def talk(self, program, *requests):
        """The (status, body) of each answer; messages are packed here by hand, from docs/adapters.md."""
        data = b"".join(struct.pack("<2I", kind, len(body) // 4) + body for kind, body in requests)
        result = subprocess.run([sys.executable, "-c", program], input=data, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, timeout=60)
        self.said, answers, rest = result.stderr.decode(), [], result.stdout
        while rest:
            status, length = struct.unpack("<2I", rest[:8])
            answers.append((status, rest[8:8 + 4 * length]))
            rest = rest[8 + 4 * length:]
        return answers

    @staticmethod
    def scene(outputs, triangles=TRIANGLES, samples=1, cull=0):
        head = struct.pack("<9I1I", outputs, SIZE[1], SIZE[0], samples, 0, 0, 1, 1, 0, 2)  # one attribute of two components
        draw = struct.pack("<3I6f8I4i5I", len(POSITIONS), len(triangles), 0, 0, 0, 8, 8, 0, 1, 0, 0, 0, cull, 0, 1, 0, 0,
                           0, 0, 0, 0, 0, 0, 0, 0, 0)
        identifiers = np.arange(40, 40 + len(triangles), dtype="<u4")
        return b"".join([head, draw, POSITIONS.tobytes(), POSITIONS.tobytes(), triangles.astype("<u4").tobytes(),
                         identifiers.tobytes(), struct.pack("<I", 2), np.arange(8, dtype="<f4").tobytes()])

    def test_what_is_asked_is_answered(self):
        info, (status, images), close = self.talk(SERVED, (1, struct.pack("<I", 1)), (2, self.scene(23)), (2, self.scene(2)))
        self.assertEqual(info[0], 0)
        self.assertEqual(struct.unpack("<64s64s18I", info[1]),
                         (b"served".ljust(64, b"\0"), b"7".ljust(64, b"\0"), 23, 4 | 8 | 1 << 12, 0,
                          1, 0, 0, 0, 0, 0, 0, 0, 0, 512, 0, 0, 0, 0, 0))
        raster = surefill.rasterize(POSITIONS, TRIANGLES, SIZE, identifiers=np.array([40, 41], np.uint32))
        flat = np.where((raster.index == 40)[..., None], np.float32([0, 1]), np.float32([0, 1]))  # both begin at vertex 0
        self.assertEqual(status, 0)
        self.assertEqual(images, np.ones(SIZE, "<u4").tobytes() + raster.index.tobytes() + raster.depth.tobytes() +
                         flat.astype("<f4").tobytes())
        self.assertEqual(close, (0, raster.index.tobytes()))
        self.assertIn("drawing", self.said)

    def test_state_reaches_the_function(self):
        (status, image), culled = self.talk(SERVED, (2, self.scene(1, samples=4)), (2, self.scene(1, cull=1)))
        self.assertEqual((status, image), (0, np.ones(SIZE + (4,), "<u4").tobytes()))
        self.assertEqual(culled, (0, np.zeros(SIZE, "<u4").tobytes()))

    def test_what_is_declined_and_what_fails(self):
        many = self.scene(1, np.concatenate([TRIANGLES, TRIANGLES]))
        declined, drawn = self.talk(SERVED, (2, many), (2, self.scene(1)))
        self.assertEqual((declined[0], declined[1].rstrip(b"\0")), (1, b"more than two triangles"))
        self.assertEqual(drawn[0], 0)
        for fault, text in (("astype(np.uint8)[1:]", "count: shape (6, 8) is needed, not (5, 8)"),
                            ("astype(float)", "count: whole numbers are needed, not float64"),
                            ("nothing()", "AttributeError")):
            (status, body), = self.talk(SERVED.replace("astype(np.uint8)", fault), (2, self.scene(1)))
            self.assertEqual(status, 2)
            self.assertIn(text, body.decode())
        (status, body), = self.talk(SERVED.replace('"index": raster', '"indices": raster'), (2, self.scene(2)))
        self.assertIn("index was asked for", body.decode())

    def test_a_wrong_claim_is_refused(self):
        for claim, error in (('features=["culling"]', "features: one of behind"), ('outputs=["colour"]', "outputs: one of"),
                             ('profile="good"', "profile: one of exact"), ('limits={"pixels": 1}', "limits: one of width")):
            self.assertEqual(self.talk(f"import surefill\nsurefill.serve(None, name='x', {claim})"), [])
            self.assertIn(error, self.said)

    def test_one_triangle_at_a_time(self):
        program = """
import numpy as np, surefill
@surefill.each_triangle
def draw(xy, height, width):
    assert xy.shape == (3, 2) and xy.dtype == np.float64
    image = np.zeros((height, width), bool)
    image[0, 0] = xy[1, 0] == 8  # the corner of the first triangle alone
    return image
surefill.serve(draw, name="one")
"""
        (status, image), = self.talk(program, (2, self.scene(1)))
        expected = np.zeros(SIZE, "<u4")
        expected[0, 0] = 2
        self.assertEqual((status, image), (0, expected.tobytes()))


if __name__ == "__main__":
    unittest.main()
