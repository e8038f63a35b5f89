/* SPDX-License-Identifier: Apache-2.0 */
/* A rasterizer as small as they come: positions on a grid of 1/256 pixel, edge functions in whole numbers, top-left rule. */
#ifndef EXAMPLES_VECTORS_RASTER_H
#define EXAMPLES_VECTORS_RASTER_H

/* Adds 1 to counts[y * width + x] where a triangle covers the centre of pixel (x, y). A vertex is X, Y, Z, W. `fault` plants one. */
void rasterize(int width, int height, const float* vertices, const unsigned* indices, unsigned triangles,
               unsigned* counts, int fault);

#endif
