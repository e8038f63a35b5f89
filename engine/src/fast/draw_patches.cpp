// SPDX-License-Identifier: Apache-2.0
//
// Draws patches into a safe occlusion buffer (O4): rows of squares, each from a first to a last one that a triangle or a
// rim edge meets, as both are convex. Plain C++ of which compilers make vector code, compiled once for each instruction
// set, or once where there is no Highway.
//
// Without rim edges on it, a square that one of the patch's faces meets is filled: the number of faces is constant around
// the closed square, and is not 0 within the face that meets it. So nobody asks for centres.
//
// A triangle in front of the eye meets a square exactly if they are apart neither along an axis nor along the normal of an
// edge: the square lies in the columns and rows that the triangle reaches, and no edge has it whole on its outer side. Of
// a row that bounds the column by a number for each edge, which grows linearly from row to row. What that leaves uncertain,
// to within its error, and what reaches behind the eye is decided by exact/occluder.hpp.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "exact/bounds.hpp"
#include "exact/occluder.hpp"
#include "fast/patches.hpp"

#if defined(SUREFILL_REFERENCE_ONLY)
#define SUREFILL_PATCHES scalar
#define SUREFILL_PATCHES_ONCE 1
#else
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/draw_patches.cpp"
#include "hwy/foreach_target.h"
// The loop above comes first.
#include "hwy/highway.h"
#define SUREFILL_PATCHES HWY_NAMESPACE
#define SUREFILL_PATCHES_ONCE HWY_ONCE
HWY_BEFORE_NAMESPACE();
#endif

namespace surefill::fast::SUREFILL_PATCHES {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kVectorKeys = 64;  // of a row, at once

// Rounding errors below are at most 8 units of 2^-53 of the sum of absolute terms; the bounds have twice that.
constexpr double kError = 0x1p-49;

// Beyond it a bound in columns is of no use, and each square is asked for.
constexpr double kUselessError = 0x1p-10;

inline double Low(double a, double b) {
  return a < b ? a : b;
}
inline double High(double a, double b) {
  return a > b ? a : b;
}
inline int ToInt(double value, int low, int high) {
  return static_cast<int>(Low(High(value, low), high));
}

// Closed range of squares along an axis that an extent meets, within [low, high).
inline void Meet(double from, double to, int low, int high, int* first, int* last) {
  *first = ToInt(std::ceil(from) - 1, low, high);
  *last = ToInt(std::floor(to), low - 1, high - 1);
}

// An edge about the corner of a box: E(x, y) = a x + b y + c. a and b have one rounding, c has the error kError / 4
// `magnitude`.
struct LocalEdge {
  double a, b, c, magnitude;
};

struct LocalVertex {
  double x, y, w;  // X - x0 W and Y - y0 W with one rounding each: the products are exact
};

inline LocalVertex Localize(const Vertex& v, int x0, int y0) {
  const double w = v.w;
  return {v.x - x0 * w, v.y - y0 * w, w};
}

inline LocalEdge EdgeOf(const Vertex& j, const Vertex& k, const LocalVertex& lj, const LocalVertex& lk) {
  const double jx = j.x, jy = j.y, jw = j.w, kx = k.x, ky = k.y, kw = k.w;
  const double p = lj.x * lk.y, q = lj.y * lk.x;
  return {jy * kw - jw * ky, jw * kx - jx * kw, p - q, std::fabs(p) + std::fabs(q)};
}

// A row's range of columns, and what may lie in it.
struct Columns {
  int first, last;            // closed; no square outside is met
  int sure_first, sure_last;  // all squares from here to there are met, if there are any
};

inline Columns Bounded(double low, double high, double error, int last_column) {
  const auto limit = static_cast<double>(last_column + 1);
  Columns c;
  c.first = static_cast<int>(Low(High(std::ceil(low - error), 0), limit));
  c.sure_first = static_cast<int>(Low(High(std::ceil(low + error), 0), limit));
  c.last = static_cast<int>(High(Low(std::floor(high + error), last_column), -1));
  c.sure_last = static_cast<int>(High(Low(std::floor(high - error), last_column), -1));
  return c;
}

inline void Note(const PatchScratch& scratch, int row, int first, int last) {
  scratch.first[row] = std::min(scratch.first[row], first);
  scratch.last[row] = std::max(scratch.last[row], last);
}

// ---- rims
struct Band {
  PixelBox box;  // of the patch, within the band
  int row0;      // of the band
  int width;     // of the buffer
  const PatchScratch& scratch;

  float* keys(int x, int y) const {
    return scratch.keys + static_cast<std::size_t>(y - row0) * static_cast<std::size_t>(width) + x;
  }
};

void DrawRim(const Band& band, const MeshView& view, RimEdge rim) {
  const SeenVertex &s0 = view.seen[rim.from], &s1 = view.seen[rim.to];
  const Vertex &v0 = view.vertices[rim.from], &v1 = view.vertices[rim.to];
  Extent extent;
  std::optional<SeenEdge> exact;
  if ((s0.flags & s1.flags & SeenVertex::kInFront) != 0) {
    extent.add(s0.x, s0.y), extent.add(s1.x, s1.y);
  } else {
    exact.emplace(v0, v1);
    extent = exact->extent();
  }
  int x0, x1, y0, y1;
  Meet(extent.x0, extent.x1, band.box.x0, band.box.x1, &x0, &x1);
  Meet(extent.y0, extent.y1, band.box.y0, band.box.y1, &y0, &y1);
  if (x0 > x1 || y0 > y1) return;
  const LocalEdge edge = EdgeOf(v0, v1, Localize(v0, x0, y0), Localize(v1, x0, y0));
  const int last_column = x1 - x0;
  double start = 0, slope = 0, error = 0;
  const bool level = edge.a == 0;  // then the extent along y says all
  if (!level) {
    start = -edge.c / edge.a, slope = -edge.b / edge.a;
    error = kError * (edge.magnitude / std::fabs(edge.a) + std::fabs(slope) * (y1 - y0 + 2));
  }
  for (int y = y0; y <= y1; ++y) {
    Columns c{0, last_column, 0, last_column};
    if (!level) {
      const double above = start + slope * (y - y0), below = start + slope * (y - y0 + 1);
      c = Bounded(Low(above, below) - 1, High(above, below), error, last_column);
      if (c.first > c.last) continue;
      if (c.first != c.sure_first || c.last != c.sure_last) {
        if (!exact) exact.emplace(v0, v1);
        while (c.first <= c.last && !exact->meets(x0 + c.first, y)) ++c.first;
        while (c.first <= c.last && !exact->meets(x0 + c.last, y)) --c.last;
        if (c.first > c.last) continue;
      }
    }
    std::fill(band.keys(x0 + c.first, y), band.keys(x0 + c.last, y) + 1, std::numeric_limits<float>::infinity());
    Note(band.scratch, y - band.row0, x0 + c.first, x0 + c.last);
  }
}

// ---- faces
// The least number of 24 bits not below `value`, as a double: towards zero it cuts off, away from zero it carries.
inline double RoundUp(double value) {
  constexpr std::int64_t kBelow = (std::int64_t{1} << 29) - 1;
  const std::int64_t carry = value > 0 ? kBelow : 0;
  return std::bit_cast<double>((std::bit_cast<std::int64_t>(value) + carry) & ~kBelow);
}

// The key of a plane at the corner of squares where it is farthest.
struct Plane {
  double start = 0, dx = 0, dy = 0, error = kInfinity;
  double span = 0;  // from there to the corner where it is nearest
  double most = kInfinity, clamp_low = -kInfinity, clamp_high = kInfinity;
};

inline double Clamped(double key, const Plane& plane) {
  return Low(High(Low(key, plane.most), plane.clamp_low), plane.clamp_high);
}

// Keys of a row of squares as float32 in doubles; false if one of them is uncertain. Floats that are not normal are.
inline bool RowOfKeys(const Plane& plane, double start, int count, double* keys) {
  std::int64_t doubt = 0;
  for (int n = 0; n < count; ++n) {
    const double value = start + plane.dx * n, high = value + plane.error;
    const double up = Clamped(RoundUp(high), plane), other = Clamped(RoundUp(value - plane.error), plane);
    const double size = std::fabs(high);
    doubt |= static_cast<std::int64_t>(up != other) | static_cast<std::int64_t>(size > 0x1p127) |
             (static_cast<std::int64_t>(size < 0x1p-126) & static_cast<std::int64_t>(size != 0));
    keys[n] = up;
  }
  return doubt == 0;
}

class Face {
 public:
  Face(const Band& band, const MeshView& view, float sign, std::uint32_t triangle)
      : band_(band), sign_(sign), mode_(view.mode) {
    const std::uint32_t* index = view.indices + std::size_t{3} * triangle;
    for (int k = 0; k < 3; ++k) v_[k] = &view.vertices[index[k]], s_[k] = &view.seen[index[k]];
  }

  void Draw() {
    if (!FindBox()) return;
    SetUp();
    for (int y = y_first_; y <= y_last_; ++y) {
      Columns c = ColumnsOf(y - y0_);
      if (c.first > c.last) continue;
      if (careful_ || c.first != c.sure_first || c.last != c.sure_last) {
        while (c.first <= c.last && !exact().meets(x0_ + c.first, y)) ++c.first;
        while (c.first <= c.last && !exact().meets(x0_ + c.last, y)) --c.last;
        if (c.first > c.last) continue;
      }
      Note(band_.scratch, y - band_.row0, x0_ + c.first, x0_ + c.last);
      DrawRow(y, c.first, c.last);
    }
  }

 private:
  ExactOccluder& exact() {
    if (!exact_) exact_.emplace(*v_[0], *v_[1], *v_[2], sign_);
    return *exact_;
  }

  bool FindBox() {
    const PixelBox& box = band_.box;
    in_front_ = (s_[0]->flags & s_[1]->flags & s_[2]->flags & SeenVertex::kInFront) != 0;
    if (in_front_) {
      Meet(Low(Low(s_[0]->x, s_[1]->x), s_[2]->x), High(High(s_[0]->x, s_[1]->x), s_[2]->x), box.x0, box.x1, &x0_,
           &x1_);
      Meet(Low(Low(s_[0]->y, s_[1]->y), s_[2]->y), High(High(s_[0]->y, s_[1]->y), s_[2]->y), box.y0, box.y1, &y0_,
           &y1_);
    } else {
      const PixelBox reached = screen_box(*v_[0], *v_[1], *v_[2], box, 0, 1);
      x0_ = reached.x0, x1_ = reached.x1 - 1, y0_ = reached.y0, y1_ = reached.y1 - 1;
    }
    return x0_ <= x1_ && y0_ <= y1_;
  }

  void SetUp() {
    LocalVertex l[3];
    LocalEdge e[3];
    for (int k = 0; k < 3; ++k) l[k] = Localize(*v_[k], x0_, y0_);
    for (int k = 0; k < 3; ++k) e[k] = EdgeOf(*v_[(k + 1) % 3], *v_[(k + 2) % 3], l[(k + 1) % 3], l[(k + 2) % 3]);
    const double t0 = l[0].x * e[0].a, t1 = l[0].y * e[0].b, t2 = l[0].w * e[0].c;
    const double determinant = (t0 + t1) + t2;
    const double determinant_error = kError * ((std::fabs(t0) + std::fabs(t1)) + std::fabs(l[0].w) * e[0].magnitude);
    columns_ = x1_ - x0_ + 1, rows_ = y1_ - y0_ + 1;
    if (std::fabs(determinant) > 0x1p10 * determinant_error) {
      SetUpPlane(e, determinant, determinant_error);
    } else {
      plane_ = {};
      careful_ = true;
    }
    if (in_front_) plane_.most = High(High(s_[0]->farthest, s_[1]->farthest), s_[2]->farthest);
    if (mode_ == DepthMode::clamp) plane_.clamp_low = sign_ > 0 ? 0 : -1, plane_.clamp_high = plane_.clamp_low + 1;
    clips_ = mode_ == DepthMode::clip && (s_[0]->flags & s_[1]->flags & s_[2]->flags & SeenVertex::kUnitDepth) == 0;
    careful_ = careful_ || !in_front_;
    // A left edge leaves the squares from a column on, a right one those up to a column.
    left_ = right_ = 0;
    const bool negative = determinant < 0;
    careful_sign_ = determinant_error >= std::fabs(determinant);
    y_first_ = y0_, y_last_ = y1_;
    error_ = 0;
    for (const LocalEdge& edge : e) {
      if (edge.a == 0) {
        CutRows(edge, (edge.b > 0) != negative);
        continue;
      }
      const double start = -edge.c / edge.a, slope = -edge.b / edge.a;
      error_ = High(error_, kError * (edge.magnitude / std::fabs(edge.a) + std::fabs(slope) * (rows_ + 1)));
      // Of the row's two borders the one on the inner side.
      const double offset = (edge.b > 0) != negative ? slope : 0;
      if ((edge.a > 0) != negative) {
        left_start_[left_] = start + offset - 1, left_slope_[left_++] = slope;
      } else {
        right_start_[right_] = start + offset, right_slope_[right_++] = slope;
      }
    }
    if (careful_sign_) error_ = kInfinity;
    careful_ = careful_ || !(error_ < kUselessError);
  }

  // A level edge leaves the rows from one on, or those up to one. Of a triangle in front of the eye its extent says that.
  void CutRows(const LocalEdge& edge, bool from) {
    if (in_front_ || edge.b == 0 || careful_sign_) return;
    const double at = -edge.c / edge.b, error = kError * edge.magnitude / std::fabs(edge.b);
    if (from) {
      y_first_ = std::max(y_first_, y0_ + ToInt(std::ceil(at - error) - 1, 0, rows_));
    } else {
      y_last_ = std::min(y_last_, y0_ + ToInt(std::floor(at + error), -1, rows_ - 1));
    }
  }

  void SetUpPlane(const LocalEdge (&e)[3], double determinant, double determinant_error) {
    double c = 0, x = 0, y = 0, magnitude = 0;
    for (int k = 0; k < 3; ++k) {
      const double key = sign_ * v_[k]->z;
      c += key * e[k].c, x += key * e[k].a, y += key * e[k].b;
      magnitude +=
          std::fabs(key) * (std::fabs(e[k].a) * (columns_ + 1) + std::fabs(e[k].b) * (rows_ + 1) + e[k].magnitude);
    }
    const double inverse = 1 / determinant;
    plane_.dx = x * inverse, plane_.dy = y * inverse;
    plane_.start = c * inverse + (High(plane_.dx, 0) + High(plane_.dy, 0));
    plane_.span = std::fabs(plane_.dx) + std::fabs(plane_.dy);
    const double size = magnitude * std::fabs(inverse);
    plane_.error = size * (4 * kError + 2 * determinant_error * std::fabs(inverse));
  }

  Columns ColumnsOf(int row) const {
    double low = -kInfinity, high = kInfinity;
    for (int k = 0; k < left_; ++k) low = High(low, left_start_[k] + left_slope_[k] * row);
    for (int k = 0; k < right_; ++k) high = Low(high, right_start_[k] + right_slope_[k] * row);
    if (careful_) {
      if (!(error_ < kUselessError)) return {0, columns_ - 1, 0, columns_ - 1};
      low = High(low, -2), high = Low(high, columns_ + 1);
    }
    return Bounded(low, high, error_, columns_ - 1);
  }

  void DrawRow(int y, int first, int last) {
    if (clips_) return DrawClippedRow(y, first, last);
    double keys[kVectorKeys];
    const double start = plane_.start + plane_.dy * (y - y0_);
    for (int x = first; x <= last; x += kVectorKeys) {
      const int count = std::min(kVectorKeys, last - x + 1);
      float* const to = band_.keys(x0_ + x, y);
      if (RowOfKeys(plane_, start + plane_.dx * x, count, keys)) {
        for (int n = 0; n < count; ++n) {
          const auto key = static_cast<float>(keys[n]);
          to[n] = to[n] < key ? key : to[n];
        }
      } else {
        for (int n = 0; n < count; ++n) to[n] = std::max(to[n], KeyOf(x + n, y));
      }
    }
  }

  // The key of one square.
  float KeyOf(int x, int y) {
    double key;
    if (RowOfKeys(plane_, plane_.start + plane_.dy * (y - y0_) + plane_.dx * x, 1, &key))
      return static_cast<float>(key);
    return static_cast<float>(Clamped(exact().farthest(x0_ + x, y), plane_));
  }

  // Depth clipping: squares on which the face leaves [0, 1] are not filled.
  void DrawClippedRow(int y, int first, int last) {
    const double low = sign_ > 0 ? 0 : -1, high = low + 1;
    // Which end of the range can be passed, by the vertices?
    bool below = !in_front_, above = !in_front_;
    for (const Vertex* v : v_) {
      const double key = static_cast<double>(sign_) * v->z, w = v->w;
      below |= key<low * w, above |= key> high * w;
    }
    for (int x = first; x <= last; ++x) {
      const double farthest = plane_.start + plane_.dy * (y - y0_) + plane_.dx * x, nearest = farthest - plane_.span;
      bool inside = (!above || farthest + 2 * plane_.error < high) && (!below || nearest - 2 * plane_.error > low);
      const bool outside = (above && farthest - 2 * plane_.error > high) || (below && nearest + 2 * plane_.error < low);
      if (!inside && !outside) inside = exact().within_unit_range(x0_ + x, y);
      float* const to = band_.keys(x0_ + x, y);
      *to = inside ? std::max(*to, KeyOf(x, y)) : std::numeric_limits<float>::infinity();
    }
  }

  const Band& band_;
  float sign_;
  DepthMode mode_;
  const Vertex* v_[3];
  const SeenVertex* s_[3];
  std::optional<ExactOccluder> exact_;
  // careful: each square at an end of a row is asked for; careful_sign: also because D's sign is not known.
  bool in_front_ = false, careful_ = false, careful_sign_ = false, clips_ = false;
  int x0_ = 0, x1_ = -1, y0_ = 0, y1_ = -1, y_first_ = 0, y_last_ = -1, columns_ = 0, rows_ = 0;
  int left_ = 0, right_ = 0;
  double left_start_[3], left_slope_[3], right_start_[3], right_slope_[3], error_ = 0;
  Plane plane_;
};

// ---- patches
// z is the nearer one of what it was and of what the patch fills squares with.
template <bool kLess>
inline void MergeRow(float* keys, float* depth, int count) {
  constexpr float kNone = -std::numeric_limits<float>::infinity();
  for (int n = 0; n < count; ++n) {
    const float key = keys[n] > kNone ? keys[n] : -kNone, z = (kLess ? key : -key) + 0.0f;
    depth[n] = kLess ? (z < depth[n] ? z : depth[n]) : (z > depth[n] ? z : depth[n]);
    keys[n] = kNone;
  }
}

// Is a key of the row farther than `nearest`?
inline bool SeesRow(const float* depth, int count, float sign, float nearest) {
  std::int32_t some = 0;
  for (int n = 0; n < count; ++n) some |= static_cast<std::int32_t>(sign * depth[n] > nearest);
  return some != 0;
}

// The rows of a box in which a patch could change a key; none: an empty box.
inline PixelBox SeenRows(const PatchFrame& frame, PixelBox box, float nearest) {
  const auto sees = [&](int y) {
    return SeesRow(frame.depth + static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + box.x0,
                   box.x1 - box.x0, frame.sign, nearest);
  };
  while (box.y0 < box.y1 && !sees(box.y0)) ++box.y0;
  while (box.y0 < box.y1 && !sees(box.y1 - 1)) --box.y1;
  return box;
}

void DrawAll(const PatchFrame& frame, int begin, int end, const PatchScratch& scratch) {
  for (std::size_t i = 0; i < frame.patch_count; ++i) {
    const Patch& patch = frame.patches[i];
    const PixelBox in_band{patch.box.x0, std::max(patch.box.y0, begin), patch.box.x1, std::min(patch.box.y1, end)};
    if (in_band.empty()) continue;
    float nearest = patch.nearest;
    if (frame.views[patch.view].mode == DepthMode::clamp) {
      const float low = frame.sign > 0 ? 0.0f : -1.0f;
      nearest = std::min(std::max(nearest, low), low + 1);
    }
    const Band band{SeenRows(frame, in_band, nearest), begin, frame.width, scratch};
    if (band.box.empty()) continue;
    for (int y = band.box.y0; y < band.box.y1; ++y) {
      scratch.first[y - begin] = std::numeric_limits<int>::max(), scratch.last[y - begin] = -1;
    }
    const MeshView& view = frame.views[patch.view];
    for (std::size_t r = patch.rim_begin; r < patch.rim_end; ++r) DrawRim(band, view, frame.rims[r]);
    for (std::size_t f = patch.face_begin; f < patch.face_end; ++f) Face(band, view, frame.sign, frame.faces[f]).Draw();
    for (int y = band.box.y0; y < band.box.y1; ++y) {
      const int first = scratch.first[y - begin], count = scratch.last[y - begin] - first + 1;
      if (count <= 0) continue;
      float* const depth = frame.depth + static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + first;
      if (frame.sign > 0) {
        MergeRow<true>(band.keys(first, y), depth, count);
      } else {
        MergeRow<false>(band.keys(first, y), depth, count);
      }
    }
  }
}

// ---- queries and levels
bool Finite(const float* numbers, std::size_t count) {
  constexpr std::size_t kLanes = 32;
  float sums[kLanes] = {};  // 0, or a NaN
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    for (std::size_t n = 0; n < kLanes; ++n) sums[n] += numbers[i + n] * 0.0f;
  }
  float sum = 0;
  for (; i < count; ++i) sum += numbers[i] * 0.0f;
  for (const float lane : sums) sum += lane;
  return sum == 0;
}

// Integers i of [0, size) with low <= i + offset <= high, or with [i, i + 1) and [low, high] meeting. The quotients are rounded
// to double, and compared with pixel centres and corners exactly nevertheless: X and c W are numbers of 24 and 39 bits, so
// if X / W differs from the place c, it does by more than 2^-40 of c.
inline void PixelsOf(double low, double high, RectanglePixels which, int size, int* first, int* last) {
  const bool met = which == RectanglePixels::met;
  const double from = met ? std::floor(low) : std::ceil(low - 0.5), to = std::floor(met ? high : high - 0.5) + 1;
  *first = ToInt(from, 0, size), *last = ToInt(to, 0, size);
}

BoxQuestion QuestionOf(const Vertex* corners, float sign, RectanglePixels which, PixelBox target) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  double x[8], y[8];
  float key[8], least_w = corners[0].w, most_w = corners[0].w;
  for (int k = 0; k < 8; ++k) {
    const float w = corners[k].w;
    least_w = least_w < w ? least_w : w, most_w = most_w > w ? most_w : w;
  }
  if (!(most_w > 0)) return {{0, 0, 0, 0}, 0};
  if (!(least_w > 0)) return {target, -std::numeric_limits<float>::infinity()};
  for (int k = 0; k < 8; ++k) {
    const Vertex& v = corners[k];
    const double w = v.w;
    x[k] = v.x / w, y[k] = v.y / w;
    key[k] = sign * v.z / v.w;
  }
  double low_x[4], high_x[4], low_y[4], high_y[4];
  float low_key[4];
  for (int k = 0; k < 4; ++k) {
    low_x[k] = Low(x[k], x[k + 4]), high_x[k] = High(x[k], x[k + 4]);
    low_y[k] = Low(y[k], y[k + 4]), high_y[k] = High(y[k], y[k + 4]);
    low_key[k] = key[k] < key[k + 4] ? key[k] : key[k + 4];
  }
  BoxQuestion q;
  PixelsOf(Low(Low(low_x[0], low_x[1]), Low(low_x[2], low_x[3])),
           High(High(high_x[0], high_x[1]), High(high_x[2], high_x[3])), which, target.x1, &q.pixels.x0, &q.pixels.x1);
  PixelsOf(Low(Low(low_y[0], low_y[1]), Low(low_y[2], low_y[3])),
           High(High(high_y[0], high_y[1]), High(high_y[2], high_y[3])), which, target.y1, &q.pixels.y0, &q.pixels.y1);
  const float nearest = std::min(std::min(low_key[0], low_key[1]), std::min(low_key[2], low_key[3]));
  q.nearest = std::min(std::max(nearest, -kLargest), kLargest);  // I4
  return q;
}

void Ask(const Vertex* corners, std::size_t boxes, float sign, RectanglePixels which, PixelBox target,
         BoxQuestion* questions) {
  for (std::size_t i = 0; i < boxes; ++i) questions[i] = QuestionOf(corners + 8 * i, sign, which, target);
}

void LargestOfBlocks(const float* from, std::size_t stride, int rows, int columns, float scale, float* largest) {
  constexpr int kColumns = 128;
  for (int x = 0; x < columns; x += kColumns) {
    float column[kColumns];
    const int count = std::min(kColumns, columns - x);
    for (int i = 0; i < kColumns; ++i) column[i] = -std::numeric_limits<float>::infinity();
    for (int row = 0; row < rows; ++row) {
      const float* const in = from + static_cast<std::size_t>(row) * stride + x;
      for (int i = 0; i < count; ++i) {
        const float value = scale * in[i];
        column[i] = value > column[i] ? value : column[i];
      }
    }
    for (int i = 0; i < count; i += 8) {
      float most = column[i];
      for (int k = 1; k < 8; ++k) most = column[i + k] > most ? column[i + k] : most;
      largest[(x + i) / 8] = most;
    }
  }
}

}  // namespace

const PatchKernels* PatchesOfTarget() {
  static const PatchKernels kernels{DrawAll, Finite, Ask, LargestOfBlocks};
  return &kernels;
}

}  // namespace surefill::fast::SUREFILL_PATCHES

#if !defined(SUREFILL_REFERENCE_ONLY)
HWY_AFTER_NAMESPACE();
#endif

#if SUREFILL_PATCHES_ONCE
namespace surefill::fast {

#if defined(SUREFILL_REFERENCE_ONLY)
const PatchKernels& patch_kernels() {
  return *scalar::PatchesOfTarget();
}
#else
HWY_EXPORT(PatchesOfTarget);

const PatchKernels& patch_kernels() {
  return *HWY_DYNAMIC_DISPATCH(PatchesOfTarget)();
}
#endif

}  // namespace surefill::fast
#endif
