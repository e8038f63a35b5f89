/* SPDX-License-Identifier: Apache-2.0 */
/* Holds raster.c against vectors/coverage_grid8.txt: every test is right, or the fault is named. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "raster.h"

static FILE* file;
static unsigned next(const char* form) {
  unsigned n = 0;
  if (fscanf(file, form, &n) != 1) fprintf(stderr, "the file ends too soon\n"), exit(2);
  return n;
}
int main(int argc, char** argv) {
  FILE* const faults = argc > 2 ? fopen(argv[2], "r") : NULL;
  if (!faults || !(file = fopen(argv[1], "r"))) return fprintf(stderr, "usage: run TESTS FAULTS [--fault]\n"), 2;
  static char failed[65536];
  unsigned id, tests = 0, wrong = 0;
  for (; fscanf(file, "%u", &id) == 1; ++tests) {
    unsigned head[17], expected[2]; /* words, models, width, ..., outputs, frames, as docs/vectors.md has them */
    for (int i = 0; i < 17; ++i) head[i] = next("%u");
    const int width = head[2], height = head[3], x0 = head[11], y0 = head[12], x1 = head[13], y1 = head[14];
    unsigned* counts = calloc((size_t)width * height, sizeof *counts);
    next("%u"); /* no initial depth */
    for (unsigned draws = next("%u"); draws > 0; --draws) {
      for (int i = 0; i < 11; ++i) next("%u"); /* the state is the default; first index */
      const unsigned n = next("%u");
      float* vertices = malloc(16 * n + 1);
      for (unsigned i = 0, bits; i < 4 * n; ++i) bits = next("%x"), memcpy(vertices + i, &bits, 4);
      const unsigned triangles = next("%u");
      unsigned* indices = malloc(12 * triangles + 1);
      for (unsigned i = 0; i < 3 * triangles; ++i) indices[i] = next("%u");
      next("%u"), next("%u"); /* no identifiers, no attributes */
      rasterize(width, height, vertices, indices, triangles, counts, argc > 3);
      free(vertices), free(indices);
    }
    for (int high = 0; high < 2; ++high) { /* least counts, then largest */
      unsigned left = (next("%u"), 0);
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x, --left) {
          if (left == 0) left = next("%u"), expected[high] = next("%u");
          const unsigned got = counts[y * width + x];
          if (high ? got > expected[1] : got < expected[0]) failed[id] = 1;
        }
    }
    wrong += failed[id], free(counts);
  }
  printf("%u tests, %u wrong\n", tests, wrong);
  char name[64], best[64] = "nothing known";
  double score = 0;
  for (file = faults; fscanf(file, "%63s", name) == 1;) {
    unsigned both = 0, either = wrong; /* tests that failed, and that show this fault */
    while (getc(file) == ' ') id = next("%u"), both += failed[id], either += !failed[id];
    if (either && (double)both / either > score) score = (double)both / either, strcpy(best, name);
  }
  if (wrong) printf("likely: %s\n", best);
  return wrong != 0;
}
