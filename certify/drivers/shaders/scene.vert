// SPDX-License-Identifier: Apache-2.0
// The vertices of a scene, as they are. A version line, and definitions of ATTRIBUTES (0 to 4) and, for Vulkan, of
// VULKAN come before this text.
#ifdef VULKAN
#define PLACE(n) layout(location = n)
layout(push_constant) uniform Points { layout(offset = 16) float size; };
#else
#define PLACE(n)
#endif

layout(location = 0) in vec4 position;
layout(location = 1) in uint identifier;
layout(location = 2) in uint corner;  // of its triangle: 0, 1, 2
PLACE(0) flat out uint triangle;
PLACE(1) out vec3 weights;
#if ATTRIBUTES > 0
layout(location = 3) in vec4 given[ATTRIBUTES];
PLACE(2) smooth out vec4 perspective[ATTRIBUTES];
PLACE(6) noperspective out vec4 affine[ATTRIBUTES];
PLACE(10) flat out vec4 constant[ATTRIBUTES];
#endif

void main() {
  gl_Position = position;
#ifdef VULKAN
  gl_PointSize = size;
#endif
  triangle = identifier;
  weights = vec3(corner == 0u, corner == 1u, corner == 2u);
#if ATTRIBUTES > 0
  for (int k = 0; k < ATTRIBUTES; ++k) perspective[k] = affine[k] = constant[k] = given[k];
#endif
}
