// SPDX-License-Identifier: Apache-2.0
// The samples of a multisampled image, as 32-bit words: sample n of pixel (x, y), component c goes to element
// ((y * width + x) * samples + n) * components + c. WHOLE_NUMBERS says that the image holds those.
layout(local_size_x = 8, local_size_y = 8) in;
#ifdef VULKAN
layout(push_constant) uniform Sizes { ivec4 size; };  // width, height, samples, components
#define BINDING(n) layout(set = 0, binding = n)
#else
uniform ivec4 size;
#define BINDING(n) layout(binding = n)
#endif
#ifdef WHOLE_NUMBERS
BINDING(0) uniform usampler2DMS image;
#else
BINDING(0) uniform sampler2DMS image;
#endif
layout(std430, binding = 1) writeonly buffer Words { uint words[]; };

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= size.x || at.y >= size.y) return;
  for (int n = 0; n < size.z; ++n) {
    for (int c = 0; c < size.w; ++c) {
#ifdef WHOLE_NUMBERS
      uint word = texelFetch(image, at, n)[c];
#else
      uint word = floatBitsToUint(texelFetch(image, at, n)[c]);
#endif
      words[((at.y * size.x + at.x) * size.z + n) * size.w + c] = word;
    }
  }
}
