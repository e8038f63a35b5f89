// SPDX-License-Identifier: Apache-2.0
// The one place where the version is written (semver.org); CMake reads it from here.
#ifndef SUREFILL_VERSION_HPP
#define SUREFILL_VERSION_HPP

// "major.minor.patch"
#define SUREFILL_VERSION "0.2.0"

#endif  // SUREFILL_VERSION_HPP
