// SPDX-License-Identifier: Apache-2.0
//
// Real meshes: Wavefront OBJ, PLY and STL to scenes. The library `surefill_mesh`; it depends on the corpus alone.
#ifndef SUREFILL_CERTIFY_MESH_HPP
#define SUREFILL_CERTIFY_MESH_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "corpus/scene.hpp"

namespace surefill::meshes {

using Float3 = std::array<float, 3>;
using Double3 = std::array<double, 3>;

// What the loader throws. what() is one line "FILE:LINE: cause", or "FILE: cause".
class MeshError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Triangles over shared vertices; front faces are counter-clockwise, as OBJ has them. A vertex is one pair of position
// and normal of the file, so one position may stand at several vertices, with the same bits.
struct Mesh {
  std::vector<Float3> positions;  // the decimals of the file, each rounded once to float32
  std::vector<Float3> normals;  // one a vertex: the file's, or the sum of the adjacent faces' area vectors, of length 1
  std::vector<std::array<std::uint32_t, 3>> triangles;  // polygons are triangulated; all indices are in range
  std::uint64_t non_finite_triangles = 0;  // with a NaN or an infinity: they are kept, and drawing drops them (B1)
  std::uint64_t lost_triangles = 0;        // of polygons that could not be triangulated, such as those without area
};

// Reads a mesh: PLY or STL where its first bytes or its name say so, else OBJ. Throws MeshError, as load_obj and
// corpus/mesh_files.hpp have it.
Mesh load_mesh(const std::string& path);

// The same from bytes; `file` is the name.
Mesh parse_mesh(std::string_view bytes, std::string_view file);

// Reads an OBJ file. Throws MeshError: missing, a directory, unreadable, a number that is none, a face of fewer than
// three vertices or one that names a vertex that does not exist (so also where a file ends in the middle), no triangle
// at all.
Mesh load_obj(const std::string& path);

// The same from text; `file` is the name used in messages.
Mesh parse_obj(std::string_view text, std::string_view file = "mesh");

// Where the mesh is seen from. Right-handed world; the field of view is vertical, in degrees, 0 < fov < 180; 0 < near <
// far. Orthographic: `height` units of the world fill the picture from top to bottom, near may be negative, and the
// field of view does not matter.
struct Camera {
  Double3 eye{0, 0, 1}, target{0, 0, 0}, up{0, 1, 0};
  double field_of_view = 40;
  double height = 0;  // above 0: orthographic
  double near_plane = 0.1, far_plane = 100;
};

// The smallest box that holds all finite vertices of triangles. {0, 0, 0} twice if there are none.
struct Box {
  Double3 low{}, high{};
  Double3 centre() const;
  double radius() const;  // half the diagonal
};
Box bounds(const Mesh& mesh);

// A camera that sees the whole mesh, from (-x, +y, -z), so a little from above; near and far hold the mesh between
// them.
Camera framing_camera(const Mesh& mesh, int width, int height);

// The height with which the picture just holds the mesh, as an orthographic camera from there sees it.
double fitting_height(const Camera& camera, const Mesh& mesh, int width, int height);

// near and far that hold the mesh between them as seen by this eye; near is far / 10,000 at least, also from inside.
void fit_planes(Camera& camera, const Mesh& mesh);

// Throws MeshError, without a file name, if the camera looks nowhere or its numbers are out of their ranges.
void check_camera(const Camera& camera);

// The projection of one position to clip space, y up, depth [0, 1]: computed in double, each component
// rounded once to float32. Equal positions give equal bits.
ClipVertex project(const Camera& camera, double aspect, const Float3& position);

// The mesh as a scene of one draw: clip coordinates with a viewport of the whole target (S3), counter-clockwise front
// faces, depth clipped to [0, 1], and, if `normals`, the perspective attribute "normal" of three components. Throws as
// check_camera.
corpus::Scene mesh_scene(const Mesh& mesh, const Camera& camera, int width, int height, bool normals = false);

}  // namespace surefill::meshes

#endif  // SUREFILL_CERTIFY_MESH_HPP
