// SPDX-License-Identifier: Apache-2.0
// What is seen: the triangle's identifier, barycentrics, attributes. The depth buffer holds the depth.
#ifdef VULKAN
#define PLACE(n) layout(location = n)
layout(push_constant) uniform Modes { ivec4 interpolation; };
#else
#define PLACE(n)
uniform ivec4 interpolation;
#endif

PLACE(0) flat in uint triangle;
PLACE(1) in vec3 weights;
#ifdef WITHOUT_INDEX
#define WEIGHTS 0
#define VALUES 1
#else
#define WEIGHTS 1
#define VALUES 2
layout(location = 0) out uint index;
#endif
layout(location = WEIGHTS) out vec4 barycentrics;  // and the identifier, plus one
#if ATTRIBUTES > 0
PLACE(2) smooth in vec4 perspective[ATTRIBUTES];
PLACE(6) noperspective in vec4 affine[ATTRIBUTES];
PLACE(10) flat in vec4 constant[ATTRIBUTES];
layout(location = VALUES) out vec4 value[ATTRIBUTES];
#endif

void main() {
#ifndef WITHOUT_INDEX
  index = triangle;
#endif
  barycentrics = vec4(weights, float(triangle) + 1.0);
#if ATTRIBUTES > 0
  for (int k = 0; k < ATTRIBUTES; ++k) {
    value[k] = interpolation[k] == 0 ? perspective[k] : interpolation[k] == 1 ? affine[k] : constant[k];
  }
#endif
}
