// SPDX-License-Identifier: Apache-2.0
// One for each fragment; blending adds them up.
layout(location = 0) out float one;

void main() {
  one = 1.0;
}
