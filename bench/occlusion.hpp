// SPDX-License-Identifier: Apache-2.0
#ifndef SUREFILL_BENCH_OCCLUSION_HPP
#define SUREFILL_BENCH_OCCLUSION_HPP

namespace surefill::bench {

// Frames of occlusion culling: occluders drawn and boxes asked for, of safe and of exact buffers.
void add_occlusion(int threads);

// Prints what share of the boxes that the exact buffer of 1920 x 1080 hides safe buffers of several sizes hide, in a city and
// behind two meshes, and the time of both on one thread. Returns the exit status: not 0 if a safe buffer hides what the
// exact one does not.
int measure_hidden();

}  // namespace surefill::bench

#endif  // SUREFILL_BENCH_OCCLUSION_HPP
