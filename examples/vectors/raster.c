/* SPDX-License-Identifier: Apache-2.0 */
#include "raster.h"

#include <math.h>

typedef long long Whole;

/* Edge function of a and b at p, all in 1/256 pixel; on the edge, the top-left rule: 1 for a sample that is the triangle's, else -1. */
static Whole edge(const Whole* a, const Whole* b, const Whole* p, int turn, int fault) {
  const Whole dx = (b[0] - a[0]) * turn, dy = (b[1] - a[1]) * turn;
  const Whole value = dx * (p[1] - a[1]) - dy * (p[0] - a[0]);
  if (value != 0) return value;
  return fault || dy < 0 || (dy == 0 && dx > 0) ? 1 : -1;
}

/* A vertex behind the eye, or very far away: there is no grid, and homogeneous edge functions decide. */
static void rasterize_homogeneous(int width, int height, const float* v[3], unsigned* counts) {
  double e[3][3];
  for (int i = 0; i < 3; ++i) {
    const float *a = v[(i + 1) % 3], *b = v[(i + 2) % 3];
    e[i][0] = (double)a[1] * b[3] - (double)a[3] * b[1];
    e[i][1] = (double)a[3] * b[0] - (double)a[0] * b[3];
    e[i][2] = (double)a[0] * b[1] - (double)a[1] * b[0];
  }
  const double d = v[0][0] * e[0][0] + v[0][1] * e[0][1] + v[0][3] * e[0][2];
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      int inside = 0;
      for (int i = 0; i < 3; ++i)
        inside += (e[i][0] * (x + 0.5) + e[i][1] * (y + 0.5) + e[i][2]) * (d > 0 ? 1 : -1) > 0;
      counts[y * width + x] += inside == 3;
    }
  }
}

void rasterize(int width, int height, const float* vertices, const unsigned* indices, unsigned triangles,
               unsigned* counts, int fault) {
  for (unsigned t = 0; t < triangles; ++t) {
    Whole p[3][2];
    const float* v[3];
    int finite = 1, plain = 1;
    for (int i = 0; i < 3; ++i) {
      v[i] = vertices + 4 * indices[3 * t + i];
      for (int c = 0; c < 4; ++c) finite = finite && isfinite(v[i][c]);
      const double x = (double)v[i][0] / v[i][3], y = (double)v[i][1] / v[i][3];
      plain = plain && v[i][3] > 0 && fabs(x) <= 16384 && fabs(y) <= 16384;
      if (finite && plain) p[i][0] = llrint(256 * x), p[i][1] = llrint(256 * y); /* to nearest, ties to even */
    }
    if (!finite) continue;
    if (!plain) {
      rasterize_homogeneous(width, height, v, counts);
      continue;
    }
    const Whole area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    for (int y = 0; y < height && area != 0; ++y) {
      for (int x = 0; x < width; ++x) {
        const Whole at[2] = {256 * x + 128, 256 * y + 128};
        int inside = 0;
        for (int i = 0; i < 3; ++i) inside += edge(p[i], p[(i + 1) % 3], at, area > 0 ? 1 : -1, fault) > 0;
        counts[y * width + x] += inside == 3;
      }
    }
  }
}
