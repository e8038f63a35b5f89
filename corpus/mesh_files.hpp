// SPDX-License-Identifier: Apache-2.0
//
// PLY and STL files as OBJ text, which corpus/mesh.hpp reads: what an OBJ file may hold, faces of many corners and NaNs
// included, one of these may, too, and there is one way from there on. No library of Debian reads them from memory and
// says at which element a damaged file is wrong.
#ifndef SUREFILL_CORPUS_MESH_FILES_HPP
#define SUREFILL_CORPUS_MESH_FILES_HPP

#include <string>
#include <string_view>

namespace surefill::meshes {

// PLY 1.0: ascii, binary_little_endian, binary_big_endian. Of the element "vertex" x, y, z and, if all three are there,
// nx, ny, nz; of "face" the list vertex_indices or vertex_index. Other elements and properties are passed over. Throws
// MeshError "FILE:LINE: cause" (header and ascii), "FILE: cause" else: a header that is none, a file that ends early or
// goes on after its last element, a number that is none or that its type does not hold, a face of fewer than three
// corners or one that names a vertex that does not exist. Numbers are rounded once to float32.
std::string obj_of_ply(std::string_view bytes, std::string_view file);

// STL: ascii, or binary, which is told by its size: 84 bytes and 50 a triangle. Equal corners (by bits) become one
// vertex; the facets' own normals are read and not kept. Throws MeshError as above.
std::string obj_of_stl(std::string_view bytes, std::string_view file);

}  // namespace surefill::meshes

#endif  // SUREFILL_CORPUS_MESH_FILES_HPP
