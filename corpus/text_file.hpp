// SPDX-License-Identifier: Apache-2.0
//
// What the readers of scenes and meshes have in common: the bytes before the first line.
#ifndef SUREFILL_CORPUS_TEXT_FILE_HPP
#define SUREFILL_CORPUS_TEXT_FILE_HPP

#include <string>
#include <string_view>

namespace surefill::corpus {

inline constexpr std::string_view kWhatIsRead =
    "scenes (.scene) and meshes (Wavefront .obj, .ply, .stl) are read; text in UTF-8";

// Without a byte order mark of UTF-8, which editors on Windows write.
std::string_view without_byte_order_mark(std::string_view text);

// "this is gzip-compressed: scenes ... are read", where the first bytes are those of a well-known format that is
// neither a scene nor an OBJ mesh; else empty.
std::string what_is_not_read(std::string_view text);

// Is it a PLY file, or STL, by its first bytes, or as binary STL by its size?
bool is_ply(std::string_view bytes);
bool is_stl(std::string_view bytes);

}  // namespace surefill::corpus

#endif  // SUREFILL_CORPUS_TEXT_FILE_HPP
