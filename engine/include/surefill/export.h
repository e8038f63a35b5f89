/* SPDX-License-Identifier: Apache-2.0 */
/* What is public: everything else is hidden from the linker. A program that links the shared library on Windows defines
 * SUREFILL_SHARED; the CMake package does it. */
#ifndef SUREFILL_EXPORT_H
#define SUREFILL_EXPORT_H

#if defined(_WIN32) && defined(SUREFILL_SHARED)
#ifdef SUREFILL_BUILDING
#define SUREFILL_API __declspec(dllexport)
#else
#define SUREFILL_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define SUREFILL_API __attribute__((visibility("default")))
#else
#define SUREFILL_API
#endif

#endif /* SUREFILL_EXPORT_H */
