// SPDX-License-Identifier: Apache-2.0
//
// What the page's JavaScript and the judge call of each other (web/judge.mjs). Texts are UTF-8, with their size in bytes.
#ifndef SUREFILL_WEB_PAGE_HPP
#define SUREFILL_WEB_PAGE_HPP

#include <cstddef>
#include <cstdint>

extern "C" {

// What the judge says; kinds of surefill_tell.
enum SurefillTold : std::uint32_t {
  kToldLine,         // of the certificate as text, a check or the verdict, as the command prints it
  kToldCertificate,  // JSON
  kToldReport,       // the certificate as a page
  kToldUnopened,     // why there is nothing to judge: no GPU, no scene
  kToldError,        // why the judge gave up: a fault of its own
  kToldVerdict,      // JSON, of one scene
};

// --- JavaScript's

// The rasterizer is asked (certify/rivals/wire.hpp) and has so many milliseconds. The answer is allocated, the caller's to free:
// outcome (0 answered, 1 it ended, 2 too late), status, the number of words that follow, and these; a text where it ended. Returns
// when the answer is there: in the meantime, JavaScript goes on.
__attribute__((import_module("env"), import_name("ask"))) std::uint32_t* surefill_ask(
    std::uint32_t kind, const std::uint32_t* words, std::size_t count, std::size_t most_words, double milliseconds);
__attribute__((import_module("env"), import_name("tell"))) void surefill_tell(std::uint32_t kind, const char* text,
                                                                              std::size_t size);
// A case is done: the check, how many there are, and the share of the whole work, 0 to 1.
__attribute__((import_module("env"), import_name("progress"))) void surefill_progress(std::size_t check,
                                                                                      std::size_t checks, double share);

// --- the judge's

// A file of the corpus.
__attribute__((export_name("surefill_add_file"))) void surefill_add_file(const char* path, std::size_t path_size,
                                                                         const char* text, std::size_t size);
// Judges the rasterizer. Level 0 quick, 1 standard, 2 thorough; the seed in two halves; `checks`: names with *, commas between, or
// nothing for all; `machine`: what the certificate says of it; `seconds`: for a scene. Texts end with 0.
__attribute__((export_name("surefill_certify"))) void surefill_certify(std::uint32_t level, std::uint32_t seed_low,
                                                                       std::uint32_t seed_high, double seconds,
                                                                       const char* checks, const char* machine);
// Judges one scene, as text.
__attribute__((export_name("surefill_judge_scene"))) void surefill_judge_scene(double seconds, const char* scene);
// Ends the run after the case that it is at.
__attribute__((export_name("surefill_stop"))) void surefill_stop();

}  // extern "C"

#endif  // SUREFILL_WEB_PAGE_HPP
