// SPDX-License-Identifier: Apache-2.0
//
// Surefill 0.2.0: the reference engine in one file, its source. Made by reference/amalgamate.py of engine/ in
// Surefill's sources: change those, and not this file.
// clang-format off
#include "surefill_reference.h"

#include <algorithm>
#include <atomic>
#include <cfenv>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <utility>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off")
#elif defined(_MSC_VER)
#pragma fp_contract(off)
#endif

// ---------------------------------------------------------------- src/arguments.hpp
namespace surefill_reference {

// As validate, for a call that has options and may have statistics (else null): B2.
Status check_call(const Target& target, std::span<const Draw> draws, const Statistics* statistics,
                  const Options& options) noexcept;

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/build_check.hpp
//
// What the engine asks of its compiler: each operation on floats and doubles rounded once, to its own type, in the
// order in which it is written. What options tell is checked here. Contraction to fused operations is told by no macro:
// the build switches it off, and where sources were copied into another build, the first call finds out by trying.


#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    defined(__NO_SIGNED_ZEROS__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0)
#error \
    "Surefill's images would be wrong: compile its sources without -ffast-math, -Ofast and their parts (add -fno-fast-math; programs that use the library may keep them)"
#endif

// 16 says so of _Float16 alone, which the engine does not use.
#if FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16
#error \
    "Surefill's images would be wrong: float and double must be computed in their own precision (FLT_EVAL_METHOD 0), on x86 with -msse2 -mfpmath=sse"
#endif

namespace surefill_reference {

// Does scalar arithmetic hold what is asked for? Vector code has its own check, for each instruction set.
bool is_exact_build();

// Numbers that show contraction: x^2 is 1 + 2 s + s^2, rounded 1 + 2 s, as s^2 is half a last place or less. Volatile,
// so that the compiler works out nothing.
template <typename T>
struct ContractionProbe {
  static constexpr T kStep = sizeof(T) == 8 ? T(0x1p-27) : T(0x1p-12);
  volatile T x = 1 + kStep, square = 1 + 2 * kStep, one = 1, small = kStep * kStep / 4;
};

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/float_environment.hpp
//
// The floating-point state that the engine's proofs assume (B4): round to nearest, ties to even, subnormals kept on
// input and output, no traps. Set on entry of every public call, also for checks that look at floats; on exit the
// caller gets its own back, exception flags included.




namespace surefill_reference {

// A thread's modes, traps and exception flags.
class FloatState {
 public:
#if defined(__SSE2__)

  static FloatState now() {
    return FloatState(_mm_getcsr());
  }
  static FloatState of_engine() {
    return FloatState(0x1F80);
  }
  void set() const {
    _mm_setcsr(control_);
  }
  unsigned flags() const {
    return control_ & 0x3F;
  }
  FloatState with_flags(unsigned flags) const {
    return FloatState(control_ | flags);
  }

 private:
  explicit FloatState(unsigned control) : control_(control) {}
  unsigned control_;  // MXCSR

#elif defined(__aarch64__)

  static FloatState now() {
    FloatState state;
    asm volatile("mrs %0, fpcr" : "=r"(state.control_));
    asm volatile("mrs %0, fpsr" : "=r"(state.status_));
    return state;
  }
  static FloatState of_engine() {
    return {};
  }
  void set() const {
    asm volatile("msr fpcr, %0" : : "r"(control_));
    asm volatile("msr fpsr, %0" : : "r"(status_));
  }
  unsigned flags() const {
    return static_cast<unsigned>(status_);
  }
  FloatState with_flags(unsigned flags) const {
    FloatState state = *this;
    state.status_ |= flags;
    return state;
  }

 private:
  std::uint64_t control_ = 0, status_ = 0;  // FPCR, FPSR

#else  // standard C++ has to do: it knows the rounding mode, and FE_DFL_ENV has subnormals

  static FloatState now() {
    FloatState state;
    std::fegetenv(&state.environment_);
    state.flags_ = static_cast<unsigned>(std::fetestexcept(FE_ALL_EXCEPT));
    return state;
  }
  static FloatState of_engine() {
    FloatState before = now(), state;
    std::fesetenv(FE_DFL_ENV);
    std::fegetenv(&state.environment_);
    before.set();
    return state;
  }
  void set() const {
    std::fesetenv(&environment_);
    std::feraiseexcept(static_cast<int>(flags_));
  }
  unsigned flags() const {
    return flags_;
  }
  FloatState with_flags(unsigned flags) const {
    FloatState state = *this;
    state.flags_ |= flags;
    return state;
  }

 private:
  std::fenv_t environment_{};
  unsigned flags_ = 0;

#endif
};

// The engine's state on this thread while it lives. Compilers know nothing of it and move arithmetic across: what
// needs the state is in a function that is not inlined.
class FloatEnvironment {
 public:
  FloatEnvironment() : before_(FloatState::now()) { FloatState::of_engine().set(); }
  ~FloatEnvironment() { before_.with_flags(raised_.load(std::memory_order_relaxed)).set(); }
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

  // Runs the caller's code in the state that was there before, on this thread or another one in the engine's state. The
  // flags that it raises are among those given back.
  template <typename Code>
  void leave_for(const Code& code) {
    before_.set();
    code();
    const unsigned flags = FloatState::now().flags();
    FloatState::of_engine().set();
    if ((flags & ~raised_.load(std::memory_order_relaxed)) != 0) raised_.fetch_or(flags, std::memory_order_relaxed);
  }

 private:
  const FloatState before_;
  std::atomic<unsigned> raised_{0};
};

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/callers_code.hpp
namespace surefill_reference {

// The caller's code, as the engine calls it: in the caller's floating-point state, on whichever thread.
struct CallersCode {
  FloatEnvironment& environment;
  Executor executor;
  CoverageVisitor visitor;

  Options with_executor(Options options) {
    if (executor.run != nullptr) options.executor = {run_tasks, this};
    return options;
  }

  static void run_tasks(void* context, std::size_t items, void (*task)(void*, std::size_t), void* argument) {
    CallersCode& own = *static_cast<CallersCode*>(context);
    own.environment.leave_for([&] { own.executor.run(own.executor.context, items, task, argument); });
  }
  static void visit_blocks(void* context, std::span<const CoverageBlock> blocks) {
    CallersCode& own = *static_cast<CallersCode*>(context);
    own.environment.leave_for([&] { own.visitor.visit(own.visitor.context, blocks); });
  }
};

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/facts.hpp
//
// What a target and a draw mean, each fact once, for both paths: regions, samples, outputs, indices, strides, culling,
// finiteness. No arithmetic that decides coverage or values: the paths share none.



namespace surefill_reference {

// Half-open rectangle of pixels.
struct PixelBox {
  int x0, y0, x1, y1;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  bool contains(int x, int y) const { return x0 <= x && x < x1 && y0 <= y && y < y1; }
};

// A place in space, in pixels: a multiple of 1/16, at most kMaxOrigin + kMaxTargetSize in magnitude, exact in double.
struct SamplePosition {
  double x, y;
};

// ---- of a target
// Which results somebody asks for, in terms of work.
struct Wanted {
  bool shading;     // barycentrics or attributes
  bool visibility;  // the triangle that is seen: its index, or shading
  bool depth;       // depth, or what needs it
};

inline Wanted wanted_outputs(const Target& target) {
  Wanted wanted{!target.barycentrics.empty(), false, false};
  for (const AttributeTarget& attribute : target.attributes) wanted.shading |= !attribute.values.empty();
  wanted.visibility = wanted.shading || !target.index.empty();
  wanted.depth = wanted.visibility || !target.depth.empty();
  return wanted;
}

// Where sample n of a pixel lies, from the pixel's corner (S4, S7).
inline SamplePosition sample_offset(const Target& target, int n) {
  const SampleLocation location = target.sample_locations.empty()
                                      ? sample_location(target.samples, n)
                                      : target.sample_locations[static_cast<std::size_t>(n)];
  return {location.x / 16.0, location.y / 16.0};
}

// And where that is in pixel (x, y) of space.
inline SamplePosition place_of_sample(const Target& target, int x, int y, int n) {
  const SamplePosition offset = sample_offset(target, n);
  return {x + offset.x, y + offset.y};
}

// The element of a buffer that sample n of pixel (x, y) has.
inline std::size_t sample_index(const Target& target, int x, int y, std::size_t n) {
  return (static_cast<std::size_t>(y) * static_cast<std::size_t>(target.width) + static_cast<std::size_t>(x)) *
             static_cast<std::size_t>(target.samples) +
         n;
}

// Is the larger depth nearer (V1)? And is the later one of equal depths seen (V5)?
inline bool is_reversed(DepthTest test) {
  return test == DepthTest::greater || test == DepthTest::greater_equal;
}
inline bool takes_equal(DepthTest test) {
  return test >= DepthTest::less_equal;
}

// The depth of an empty sample without initial depth (V1).
inline float empty_depth(DepthTest test) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  return is_reversed(test) ? -kInfinity : kInfinity;
}

// Floats from one sample to the next.
inline std::size_t stride_of(const AttributeTarget& image) {
  return image.stride != 0 ? image.stride : image.components;
}

// ---- of a draw
// The vertices of each of its primitives; of what is no enumerator, 1.
inline std::size_t corners_of(const DrawState& draw) {
  return draw.primitive == Primitive::triangles ? 3 : draw.primitive == Primitive::lines ? 2 : 1;
}

// The number of its primitives, whatever they are.
inline std::size_t triangles_of(const Draw& draw) {
  return draw.indices.size() / corners_of(draw);
}

inline bool has_triangles(const DrawState& draw) {
  return draw.primitive == Primitive::triangles;
}

// Target and scissor (M3), in pixels of space (S6).
inline PixelBox region_of(const Target& target, const Draw& draw) {
  PixelBox region{target.origin.x, target.origin.y, target.origin.x + target.width, target.origin.y + target.height};
  if (draw.scissor) {
    region = {std::max(region.x0, draw.scissor->x0), std::max(region.y0, draw.scissor->y0),
              std::min(region.x1, draw.scissor->x1), std::min(region.y1, draw.scissor->y1)};
    if (region.empty()) region = {};
  }
  return region;
}

// Floats from one vertex to the next.
inline std::size_t stride_of(const AttributeArray& attribute) {
  return attribute.stride != 0 ? attribute.stride : attribute.components;
}

// Is it the front that faces so? `facing` has the sign of D (F1) or, under Grid, that of a sample (G1); D = 0 is
// back-facing (M4b).
inline bool faces_front(const DrawState& draw, int facing) {
  return facing != 0 && (facing > 0) == (draw.front_face == FrontFace::clockwise);
}

// Does culling leave out what faces so (F2)?
inline bool culls(const DrawState& draw, int facing) {
  return draw.cull == (faces_front(draw, facing) ? Cull::front : Cull::back);
}

// ---- of a triangle, by its position in the draw
inline std::uint32_t vertex_index(const Draw& draw, std::uint32_t position, std::size_t corner) {
  return draw.indices[corners_of(draw) * position + corner];
}

inline const Vertex& vertex_of(const Draw& draw, std::uint32_t position, std::size_t corner) {
  return draw.vertices[vertex_index(draw, position, corner)];
}

// What the index output has for it (V2).
inline std::uint32_t index_of(const Draw& draw, std::uint32_t position) {
  return draw.identifiers.empty() ? draw.first_index + position : draw.identifiers[position];
}

inline bool is_finite(const Vertex& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

// B1, of the attributes alone: every component, whatever is asked for.
inline bool attributes_are_finite(const Draw& draw, std::uint32_t position) {
  for (const AttributeArray& attribute : draw.attributes) {
    for (std::size_t corner = 0; corner < corners_of(draw); ++corner) {
      const float* values = &attribute.values[vertex_index(draw, position, corner) * stride_of(attribute)];
      for (std::uint32_t c = 0; c < attribute.components; ++c) {
        if (!std::isfinite(values[c])) return false;
      }
    }
  }
  return true;
}

// B1: if not, the triangle is dropped.
inline bool is_finite(const Draw& draw, std::uint32_t position) {
  for (std::size_t corner = 0; corner < corners_of(draw); ++corner) {
    if (!is_finite(vertex_of(draw, position, corner))) return false;
  }
  return attributes_are_finite(draw, position);
}

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/exact/bounds.hpp
//
// A box of pixels that holds every sample a triangle can cover. Vertices are divided by W only where W > 0; a vertex at
// or behind the eye either proves that it does not reach past a bound, or the box ends at the target's edge there (J.
// Blinn, Calculating Screen Coverage, 1996).



namespace surefill_reference {

// An interval of real numbers: what a triangle reaches along one axis in front of the eye.
struct Reach {
  double low, high;
};

// Along one axis: `c` is X (or Y) of the three vertices. Not all W are <= 0.
//
// A visible point is a sum of l_i m_i with l_i >= 0 and W > 0. If c_i - high W_i <= 0 for every vertex, the same holds
// for the sum, so c / W <= high. For W_i > 0 that is c_i / W_i <= high. Rounding the quotient is monotonic and sample
// coordinates are doubles, so no margin is needed while all W > 0; with another vertex in play the bounds move outwards
// by one ulp.
inline Reach reach(const double (&c)[3], const double (&w)[3]) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Reach r{kInfinity, -kInfinity};
  bool all_in_front = true;
  for (int i = 0; i < 3; ++i) {
    if (w[i] > 0) {
      r.low = std::min(r.low, c[i] / w[i]);
      r.high = std::max(r.high, c[i] / w[i]);
    } else {
      all_in_front = false;
    }
  }
  if (all_in_front) return r;
  r.low = std::nextafter(r.low, -kInfinity);
  r.high = std::nextafter(r.high, kInfinity);
  for (int i = 0; i < 3; ++i) {
    if (w[i] > 0) continue;
    // high W_i and low W_i with their rounding error taken to the unsafe side; 0 is exact.
    const double at_high = r.high * w[i], at_low = r.low * w[i];
    if (!(c[i] <= at_high - std::fabs(at_high) * 0x1p-52)) r.high = kInfinity;
    if (!(c[i] >= at_low + std::fabs(at_low) * 0x1p-52)) r.low = -kInfinity;
  }
  return r;
}

// Pixels i of [first, last) with a sample coordinate i + offset in the reach, offset between the two given ones.
inline void clip_to_reach(Reach r, double least_offset, double largest_offset, int* first, int* last) {
  const double lowest = std::ceil(r.low - largest_offset), highest = std::floor(r.high - least_offset);
  *first = static_cast<int>(std::clamp(lowest, static_cast<double>(*first), static_cast<double>(*last)));
  *last = static_cast<int>(std::clamp(highest + 1, static_cast<double>(*first), static_cast<double>(*last)));
}

// The part of `limits` that the triangle can reach. Sample offsets within a pixel lie in [least_offset,
// largest_offset].
inline PixelBox screen_box(const Vertex& v0, const Vertex& v1, const Vertex& v2, PixelBox limits, double least_offset,
                           double largest_offset) {
  const double w[3] = {v0.w, v1.w, v2.w};
  if (!(w[0] > 0 || w[1] > 0 || w[2] > 0)) return {0, 0, 0, 0};
  clip_to_reach(reach({v0.x, v1.x, v2.x}, w), least_offset, largest_offset, &limits.x0, &limits.x1);
  clip_to_reach(reach({v0.y, v1.y, v2.y}, w), least_offset, largest_offset, &limits.y0, &limits.y1);
  return limits;
}

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/exact/exact.hpp
//
// Exact arithmetic on doubles: sums and products that keep their rounding error, expansions (sums of doubles that do
// not overlap), and the one rounding from an exact quotient to float32. Source: J. R. Shewchuk, Adaptive Precision
// Floating-Point Arithmetic and Fast Robust Geometric Predicates, 1997.
//
// Holds in round-to-nearest with subnormals and without contraction to FMA (B4; the build sets -ffp-contract=off).
// Range: all numbers here are sums of products of at most six float32 values or float32 midpoints and three sample
// coordinates: multiples of 2^-910 below 2^850, so nothing overflows, and no error term underflows.



namespace surefill_reference {

struct DoublePair {
  double value, error;  // value + error is exact; value is value + error rounded to nearest
};

// a + b (Knuth; Shewchuk theorem 7).
inline DoublePair two_sum(double a, double b) {
  const double sum = a + b;
  const double b_virtual = sum - a;
  const double a_virtual = sum - b_virtual;
  return {sum, (a - a_virtual) + (b - b_virtual)};
}

// a * b (Dekker, Veltkamp; Shewchuk theorems 17 and 18).
inline DoublePair two_product(double a, double b) {
  constexpr double kSplitter = 0x1p27 + 1;
  const double product = a * b;
  const double a_big = kSplitter * a, a_high = a_big - (a_big - a), a_low = a - a_high;
  const double b_big = kSplitter * b, b_high = b_big - (b_big - b), b_low = b - b_high;
  const double error = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
  return {product, error};
}

// A real number as a sum of at most kCapacity doubles, smallest first, nonadjacent (Shewchuk theorem 10: growing by one
// double at a time keeps them so under ties to even). No term is 0, so the number is 0 exactly if there are no terms.
template <std::size_t kCapacity>
class Expansion {
 public:
  Expansion() = default;
  // The same number with room for more terms.
  template <std::size_t kOther>
  explicit Expansion(const Expansion<kOther>& other) : size_(other.size()) {
    static_assert(kOther <= kCapacity);
    for (int i = 0; i < size_; ++i) term_[i] = other.term(i);
  }

  // Adds one double. At most one term more.
  void add(double b) {
    int kept = 0;
    for (int i = 0; i < size_; ++i) {
      const DoublePair sum = two_sum(b, term_[i]);
      if (sum.error != 0) term_[kept++] = sum.error;
      b = sum.value;
    }
    if (b != 0) term_[kept++] = b;
    size_ = kept;
  }

  // Adds a * b. At most two terms more.
  void add_product(double a, double b) {
    const DoublePair product = two_product(a, b);
    if (product.error != 0) add(product.error);
    add(product.value);
  }

  // Adds other * factor. At most twice as many terms more as `other` has.
  template <std::size_t kOther>
  void add_scaled(const Expansion<kOther>& other, double factor) {
    for (int i = 0; i < other.size(); ++i) add_product(other.term(i), factor);
  }

  // Adds a * b: at most twice as many terms more as the product of their numbers.
  template <std::size_t kA, std::size_t kB>
  void add_product_of(const Expansion<kA>& a, const Expansion<kB>& b) {
    for (int i = 0; i < b.size(); ++i) add_scaled(a, b.term(i));
  }

  // Changes the sign.
  void negate() {
    for (int i = 0; i < size_; ++i) term_[i] = -term_[i];
  }

  int sign() const { return size_ == 0 ? 0 : term_[size_ - 1] > 0 ? 1 : -1; }

  // The number, to a relative error below 2^-50: the terms are nonadjacent, so the largest is at least half of the sum.
  double estimate() const {
    double sum = 0;
    for (int i = 0; i < size_; ++i) sum += term_[i];
    return sum;
  }

  int size() const { return size_; }
  double term(int i) const { return term_[i]; }

 private:
  double term_[kCapacity];
  int size_ = 0;
};

// The float32 nearest to a real number that is known to lie between two neighbours low < high; `sign_at(m)` is the
// exact sign of number - m. An infinite neighbour stands for 2^128.
template <typename SignAtMidpoint>
float nearest_of_neighbours(float low, float high, SignAtMidpoint sign_at) {
  const double beyond = 0x1p128;
  const double low_value = std::isinf(low) ? -beyond : static_cast<double>(low);
  const double high_value = std::isinf(high) ? beyond : static_cast<double>(high);
  const double midpoint = low_value + (high_value - low_value) / 2;  // exact: 25 bits
  const int above = sign_at(midpoint);
  if (above != 0) return above > 0 ? high : low;
  return static_cast<float>(midpoint);  // ties to even, by the conversion itself
}

constexpr double kLargestFloat = std::numeric_limits<float>::max();

// Rounds as I4 says, if the interval [low, high] around the real number is narrow enough to tell: true, and `*rounded`
// is the finite float32 nearest to every number of the interval. An interval with a NaN tells nothing.
inline bool round_interval(double low, double high, float* rounded) {
  low = low < -kLargestFloat ? -kLargestFloat : low > kLargestFloat ? kLargestFloat : low;
  high = high < -kLargestFloat ? -kLargestFloat : high > kLargestFloat ? kLargestFloat : high;
  const float from_low = static_cast<float>(low);
  if (!(from_low == static_cast<float>(high))) return false;
  *rounded = from_low + 0.0f;  // -0 becomes +0
  return true;
}

// The float32 nearest to numerator / denominator as I4 says; denominator is not 0.
template <std::size_t kNumerator, std::size_t kDenominator>
float round_quotient(const Expansion<kNumerator>& numerator, const Expansion<kDenominator>& denominator) {
  const double quotient = numerator.estimate() / denominator.estimate();  // relative error below 2^-48
  const double error = std::fabs(quotient) * 0x1p-48;
  float rounded;
  if (round_interval(quotient - error, quotient + error, &rounded)) return rounded;
  // The interval is far narrower than the distance of floats: there is one midpoint in it, between these neighbours.
  const float low = static_cast<float>(quotient - error), high = static_cast<float>(quotient + error);
  const float nearest = nearest_of_neighbours(low, high, [&](double midpoint) {
    Expansion<kNumerator + 2 * kDenominator> rest;
    for (int i = 0; i < numerator.size(); ++i) rest.add(numerator.term(i));
    rest.add_scaled(denominator, -midpoint);
    return rest.sign() * denominator.sign();
  });
  return nearest + 0.0f;
}

// The least float32 not below numerator / denominator; +0 for 0, +infinity beyond range. The denominator is not 0.
template <std::size_t kNumerator, std::size_t kDenominator>
float round_up_quotient(const Expansion<kNumerator>& numerator, const Expansion<kDenominator>& denominator) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  // Is the quotient above a float?
  const auto above = [&](float value) {
    if (std::isinf(value)) return value < 0;
    Expansion<kNumerator + 2 * kDenominator> rest;
    for (int i = 0; i < numerator.size(); ++i) rest.add(numerator.term(i));
    rest.add_scaled(denominator, -static_cast<double>(value));
    return rest.sign() * denominator.sign() > 0;
  };
  float rounded = static_cast<float>(numerator.estimate() / denominator.estimate());  // a neighbour at most off
  while (above(rounded)) rounded = std::nextafter(rounded, kInfinity);
  for (;;) {
    const float below = std::nextafter(rounded, -kInfinity);
    if (above(below)) return rounded + 0.0f;
    rounded = below;
  }
}

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/exact/edge.hpp
//
// Edge functions of a homogeneous triangle (semantics.md, section 2; Olano and Greer 1997) and the ladder that finds
// their exact signs: double with an error bound, double proved exact by its residuals, expansions.



namespace surefill_reference {

// Counts a decision, where somebody asks.
inline void count(Rungs* rungs, std::uint64_t Rungs::*rung) {
  if (rungs != nullptr) ++(rungs->*rung);
}

// Relative to the sum of absolute terms, the rounding error of a x + b y + c is below 8 units of 2^-53: one for a
// coefficient (its products are exact), one for the product, two for the sums, and as much again for the sum of
// absolute terms itself.
constexpr double kEdgeErrorBound = 0x1p-50;

constexpr int sign_of(double value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

// r = p - q without rounding error, for r computed as p - q?
inline bool difference_is_exact(double p, double q) {
  return two_sum(p, -q).error == 0;
}

// E(p) = a x + b y + c for the edge from vertex j to vertex k. Each coefficient is a difference of two exact products,
// rounded once: its sign, and whether it is 0, are exact.
struct EdgeFunction {
  double a, b, c;
  bool exact;  // all three coefficients without rounding error
  Vertex from, to;

  EdgeFunction() = default;
  EdgeFunction(const Vertex& j, const Vertex& k) : from(j), to(k) {
    const double jx = j.x, jy = j.y, jw = j.w, kx = k.x, ky = k.y, kw = k.w;
    a = jy * kw - jw * ky;
    b = jw * kx - jx * kw;
    c = jx * ky - jy * kx;
    exact = difference_is_exact(jy * kw, jw * ky) && difference_is_exact(jw * kx, jx * kw) &&
            difference_is_exact(jx * ky, jy * kx);
  }

  // E at p in double, and a bound of its absolute error.
  double value(SamplePosition p, double* error_bound) const {
    *error_bound = kEdgeErrorBound * ((std::fabs(a * p.x) + std::fabs(b * p.y)) + std::fabs(c));
    return (a * p.x + b * p.y) + c;
  }

  // E at p, exactly. Four products of 48 bits times 27 bits, and two of 48 bits.
  Expansion<10> exact_value(SamplePosition p) const {
    const double jx = from.x, jy = from.y, jw = from.w, kx = to.x, ky = to.y, kw = to.w;
    Expansion<10> sum;
    sum.add_product(jy * kw, p.x);
    sum.add_product(-(jw * ky), p.x);
    sum.add_product(jw * kx, p.y);
    sum.add_product(-(jx * kw), p.y);
    sum.add(jx * ky);
    sum.add(-(jy * kx));
    return sum;
  }

  // The sign of E at p, 0 for a real tie.
  int sign(SamplePosition p, Rungs* rungs = nullptr) const {
    double bound;
    const double estimate = value(p, &bound);
    if (std::fabs(estimate) > bound) {
      count(rungs, &Rungs::signs_by_filter);
      return sign_of(estimate);
    }
    if (exact) {
      const DoublePair ax = two_product(a, p.x), by = two_product(b, p.y);
      const DoublePair ab = two_sum(ax.value, by.value), abc = two_sum(ab.value, c);
      if (ax.error == 0 && by.error == 0 && ab.error == 0 && abc.error == 0) {
        count(rungs, &Rungs::signs_by_residual);
        return sign_of(abc.value);
      }
    }
    count(rungs, &Rungs::signs_by_expansion);
    return exact_value(p).sign();
  }
};

// What a fill rule does with a sample on an edge: where it moves it (C3), or which side has all of them (C5).
struct TieShift {
  int x, y;  // +1 or -1
  bool y_dominates;
  int all = 0;  // +1: every sample on an edge is covered; -1: none is; 0: the sample moves
};

// Is it one of C3's rules, and not of C5's?
inline bool moves_samples(FillRule rule) {
  return rule <= FillRule::northwards_west;
}

inline TieShift tie_shift(FillRule rule) {
  switch (rule) {
    case FillRule::top_left:
      return {+1, +1, false};
    case FillRule::top_right:
      return {-1, +1, false};
    case FillRule::bottom_left:
      return {+1, -1, false};
    case FillRule::bottom_right:
      return {-1, -1, false};
    case FillRule::southwards:
      return {+1, +1, true};
    case FillRule::southwards_west:
      return {-1, +1, true};
    case FillRule::northwards:
      return {+1, -1, true};
    case FillRule::northwards_west:
      return {-1, -1, true};
    case FillRule::closed:
      return {+1, +1, false, +1};
    case FillRule::open:
      return {+1, +1, false, -1};
  }
  return {+1, +1, false};
}

// The sign that an edge function takes where it is 0 (C3). a and b are not both 0 there.
inline int tie_sign(double a, double b, TieShift shift) {
  const int along_x = sign_of(a) * shift.x, along_y = sign_of(b) * shift.y;
  if (shift.y_dominates) return along_y != 0 ? along_y : along_x;
  return along_x != 0 ? along_x : along_y;
}

// The same for a triangle whose D has the sign `determinant`, under any rule (C3, C5).
inline int tie_sign(const EdgeFunction& edge, TieShift shift, int determinant) {
  return shift.all != 0 ? shift.all * determinant : tie_sign(edge.a, edge.b, shift);
}

// det(m0, m1, m2), exactly.
inline Expansion<12> exact_determinant(const Vertex& v0, const Vertex& v1, const Vertex& v2) {
  Expansion<12> sum;
  const auto add = [&sum](double x, double y, double z) { sum.add_product(x * y, z); };
  add(v1.y, v2.w, v0.x), add(-v1.w, v2.y, v0.x);
  add(v1.w, v2.x, v0.y), add(-v1.x, v2.w, v0.y);
  add(v1.x, v2.y, v0.w), add(-v1.y, v2.x, v0.w);
  return sum;
}

// The sign of D = det(m0, m1, m2). `edge0` is the edge from v1 to v2: D is its value at m0, with the same error bound.
inline int determinant_sign(const EdgeFunction& edge0, const Vertex& v0, Rungs* rungs = nullptr) {
  const double ax = edge0.a * v0.x, by = edge0.b * v0.y, cw = edge0.c * v0.w;
  const double estimate = (ax + by) + cw;
  if (std::fabs(estimate) > kEdgeErrorBound * ((std::fabs(ax) + std::fabs(by)) + std::fabs(cw))) {
    count(rungs, &Rungs::signs_by_filter);
    return sign_of(estimate);
  }
  count(rungs, &Rungs::signs_by_expansion);
  return exact_determinant(v0, edge0.from, edge0.to).sign();
}

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/exact/approximation.hpp
//
// Doubles with a bound of their error, and the float32 that is stored of a quotient (I4): by such bounds if they can tell,
// else by exact arithmetic.



namespace surefill_reference {

// A double and a bound of its distance from the real number it stands for.
struct Approximation {
  double value, error;
};

// n / m. For real N, M: N/M - n/m = ((N - n) - (n/m)(M - m)) / M. Infinite error where M may be 0. The factor covers
// the rounding of the bound.
inline Approximation quotient(Approximation n, Approximation m) {
  const double smallest = std::fabs(m.value) - m.error;
  if (!(smallest > 0)) return {0, std::numeric_limits<double>::infinity()};
  const double q = n.value / m.value;
  return {q, ((n.error + std::fabs(q) * m.error) / smallest + std::fabs(q) * 0x1p-52) * (1 + 0x1p-20)};
}

// The float32 of I4: by the filter if it can tell, else by `exact`.
template <typename Exact>
float rounded(Approximation q, Exact exact, Rungs* rungs = nullptr) {
  float result;
  if (round_interval(q.value - q.error, q.value + q.error, &result)) {
    count(rungs, &Rungs::values_by_filter);
    return result;
  }
  count(rungs, &Rungs::values_by_expansion);
  return exact();
}

// A float32 as I4 stores it: -0 becomes +0.
inline float stored(float value) {
  return value + 0.0f;
}

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/exact/triangle.hpp
//
// One triangle set up for exact evaluation at samples: coverage (C2, C3), depth (I1, I5), attributes (I2, I3), each by
// a filter in double and, where that cannot tell, by expansions.



namespace surefill_reference {

// w0 e0 + w1 e1 + w2 e2 for exact weights. Three products and two sums: below 3 units of 2^-53 of the sum of absolute
// terms; the bound has 8, which covers the rounding of the bound itself.
inline Approximation weighted_sum(const double (&w)[3], const Approximation (&e)[3]) {
  const double t0 = w[0] * e[0].value, t1 = w[1] * e[1].value, t2 = w[2] * e[2].value;
  const double magnitude = (std::fabs(t0) + std::fabs(t1)) + std::fabs(t2);
  const double inherited = (std::fabs(w[0]) * e[0].error + std::fabs(w[1]) * e[1].error) + std::fabs(w[2]) * e[2].error;
  return {(t0 + t1) + t2, inherited + 0x1p-50 * magnitude};
}

class Triangle {
 public:
  using EdgeSet = unsigned;  // bit i: edge i
  // False if D = 0 (C1). Vertices are finite (B1).
  bool set_up(const Vertex& v0, const Vertex& v1, const Vertex& v2, Rungs* rungs = nullptr) {
    vertex_[0] = v0, vertex_[1] = v1, vertex_[2] = v2;
    for (int i = 0; i < 3; ++i) edge_[i] = EdgeFunction(vertex_[(i + 1) % 3], vertex_[(i + 2) % 3]);
    determinant_sign_ = determinant_sign(edge_[0], v0, rungs);
    determinant_known_ = false;
    return determinant_sign_ != 0;
  }

  // The sign of D (F1).
  int determinant() const { return determinant_sign_; }

  const Vertex& vertex(int i) const { return vertex_[i]; }
  const EdgeFunction& edge(int i) const { return edge_[i]; }  // from vertex i + 1 to vertex i + 2, modulo 3

  // C2, C3 and C5.
  bool covers(SamplePosition p, TieShift shift, Rungs* rungs = nullptr) const {
    for (const EdgeFunction& edge : edge_) {
      int sign = edge.sign(p, rungs);
      if (sign == 0) sign = tie_sign(edge, shift, determinant_sign_);
      if (sign != determinant_sign_) return false;
    }
    return true;
  }

  // Depth at p, with the bias of I8, as I4 stores it; false if depth clipping removes the fragment (I5).
  bool depth(SamplePosition p, const DrawState& state, float* stored, Rungs* rungs = nullptr) {
    const DepthMode mode = state.depth_mode;
    const Approximation q = approximate_depth(p);
    if (mode == DepthMode::clip) {
      const double low = q.value - q.error, high = q.value + q.error;
      if (high < 0 || low > 1) {
        count(rungs, &Rungs::values_by_filter);
        return false;
      }
      if (!(low > 0 && high < 1) && !inside_unit_range(exact_depth_numerator(p), rungs)) return false;
    }
    *stored = state.depth_bias ? biased_depth(p, *state.depth_bias, rungs) : rounded_depth(p, q, rungs);
    if (mode == DepthMode::clamp) *stored = *stored < 0 ? 0.0f : *stored > 1 ? 1.0f : *stored;  // rounding is monotonic
    return true;
  }

  // The depth at p (I1), whether or not the triangle covers p, as I4 rounds it. D is not 0.
  float rounded_depth(SamplePosition p, Rungs* rungs = nullptr) {
    return rounded_depth(p, approximate_depth(p), rungs);
  }

  // The same with a bias (I8).
  float biased_depth(SamplePosition p, const DepthBias& bias, Rungs* rungs = nullptr) {
    const auto exact = [&] {
      Expansion<108> numerator(exact_depth_numerator(p));
      numerator.add_scaled(exact_determinant_value(), bias.constant);
      numerator.add_scaled(exact_slope_numerator(), bias.slope);
      return round_quotient(numerator, exact_determinant_value());
    };
    return rounded(with_bias(approximate_depth(p), bias), exact, rungs);
  }

  // z + c + s m (I8) for an approximation of z. D is not 0. The factor covers the rounding of sums and bounds.
  Approximation with_bias(Approximation z, const DepthBias& bias) {
    const Approximation m = approximate_slope();
    const double c = bias.constant, s = bias.slope, term = s * m.value;
    const double magnitude = (std::fabs(z.value) + std::fabs(c)) + std::fabs(term);
    return {(z.value + c) + term, (z.error + std::fabs(s) * m.error) * (1 + 0x1p-20) + 0x1p-50 * magnitude};
  }

  // I8's m times D, exactly: D is not 0.
  Expansion<12> exact_slope_numerator() const {
    Expansion<12> along_x, along_y;
    for (int i = 0; i < 3; ++i) {
      const double z = vertex_[i].z;
      const Vertex &j = edge_[i].from, &k = edge_[i].to;
      along_x.add_product(static_cast<double>(j.y) * k.w, z);
      along_x.add_product(-(static_cast<double>(j.w) * k.y), z);
      along_y.add_product(static_cast<double>(j.w) * k.x, z);
      along_y.add_product(-(static_cast<double>(j.x) * k.w), z);
    }
    for (Expansion<12>* slope : {&along_x, &along_y}) {
      if (slope->sign() * determinant_sign_ < 0) slope->negate();
    }
    Expansion<24> difference(along_x);
    difference.add_scaled(along_y, -1);
    return difference.sign() * determinant_sign_ > 0 ? along_x : along_y;
  }

  // z(p) (I1), and a bound of its error. D is not 0.
  Approximation approximate_depth(SamplePosition p) {
    Approximation e[3];
    evaluate_edges(p, e);
    return quotient(weighted_sum({vertex_[0].z, vertex_[1].z, vertex_[2].z}, e), approximate_determinant());
  }

  // The sign of z(p) - bound, exactly, for a bound of 0 or 1. D is not 0.
  int compare_depth(SamplePosition p, double bound, Rungs* rungs = nullptr) {
    const Approximation q = approximate_depth(p);
    const bool above = q.value - q.error > bound, below = q.value + q.error < bound;  // rounding is monotonic
    if (above || below) {
      count(rungs, &Rungs::values_by_filter);
      return above ? 1 : -1;
    }
    count(rungs, &Rungs::values_by_expansion);
    return minus_multiple_of_determinant(exact_depth_numerator(p), bound).sign() * determinant_sign_;
  }

  // Z_0 E_0 + Z_1 E_1 + Z_2 E_2 at p, exactly: the depth there is this over D. p may also be a corner of the guard
  // band of G1: no bound is involved.
  Expansion<60> exact_depth_numerator(SamplePosition p) const {
    return exact_weighted_sum({vertex_[0].z, vertex_[1].z, vertex_[2].z}, p);
  }

  // D itself.
  const Expansion<12>& exact_determinant_value() {
    know_determinant();
    return determinant_;
  }

  // Is the sum of the E_i of D's sign at p? (M1: then p is seen in the triangle's plane in front of the eye.)
  bool plane_in_front(SamplePosition p) const {
    Approximation e[3];
    evaluate_edges(p, e);
    const Approximation sum = weighted_sum({1, 1, 1}, e);
    if (std::fabs(sum.value) > sum.error) return sign_of(sum.value) == determinant_sign_;
    return exact_weighted_sum({1, 1, 1}, p).sign() == determinant_sign_;
  }

  // An attribute at p as I4 stores it, from its values at the three vertices. For perspective, the sum of the E_i is
  // not 0 at p: it is not at a covered sample, nor where plane_in_front().
  float attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Rungs* rungs = nullptr) {
    if (interpolation == Interpolation::flat) return value_of_vertex_0(u);
    if (interpolation == Interpolation::perspective) {
      return weighted_mean({u[0], u[1], u[2]}, {1, 1, 1}, p, kAllEdges, rungs);
    }
    const double w[3] = {static_cast<double>(u[0]) * vertex_[0].w, static_cast<double>(u[1]) * vertex_[1].w,
                         static_cast<double>(u[2]) * vertex_[2].w};  // 48 bits, exact
    Approximation e[3];
    evaluate_edges(p, e);
    const Approximation q = quotient(weighted_sum(w, e), approximate_determinant());
    return rounded(
        q, [&] { return round_quotient(exact_weighted_sum(w, p), determinant_); }, rungs);
  }

  // The edges whose E_i counts at p under Grid (G2): it has the sign of D and is not 0. None if D = 0.
  EdgeSet right_edges(SamplePosition p, Rungs* rungs = nullptr) const {
    EdgeSet set = 0;
    for (int i = 0; i < 3; ++i) {
      if (determinant_sign_ != 0 && edge_[i].sign(p, rungs) == determinant_sign_) set |= 1u << i;
    }
    return set;
  }

  // An attribute at p as G2 has it: from the E_i that count, and the value of vertex 0 where their sum is 0.
  float attribute_of_right_edges(SamplePosition p, const float (&u)[3], Interpolation interpolation,
                                 Rungs* rungs = nullptr) const {
    const EdgeSet set = right_edges(p, rungs);
    if (interpolation == Interpolation::flat || set == 0) return value_of_vertex_0(u);
    if (interpolation == Interpolation::perspective) {
      return weighted_mean({u[0], u[1], u[2]}, {1, 1, 1}, p, set, rungs);
    }
    const double w[3] = {vertex_[0].w, vertex_[1].w, vertex_[2].w};
    if (weighted_sum_is_zero(w, p, set)) return value_of_vertex_0(u);
    return weighted_mean({u[0] * w[0], u[1] * w[1], u[2] * w[2]}, w, p, set, rungs);  // 48 bits, exact
  }

 private:
  static constexpr EdgeSet kAllEdges = 7;

  static float value_of_vertex_0(const float (&u)[3]) { return stored(u[0]); }

  // The E_i at p; 0 for edges outside the set.
  void evaluate_edges(SamplePosition p, Approximation (&e)[3], EdgeSet set = kAllEdges) const {
    for (int i = 0; i < 3; ++i) {
      e[i] = {0, 0};
      if ((set >> i & 1u) != 0) e[i].value = edge_[i].value(p, &e[i].error);
    }
  }

  Expansion<60> exact_weighted_sum(const double (&w)[3], SamplePosition p, EdgeSet set = kAllEdges) const {
    Expansion<60> sum;
    for (int i = 0; i < 3; ++i) {
      if ((set >> i & 1u) != 0) sum.add_scaled(edge_[i].exact_value(p), w[i]);
    }
    return sum;
  }

  bool weighted_sum_is_zero(const double (&w)[3], SamplePosition p, EdgeSet set) const {
    Approximation e[3];
    evaluate_edges(p, e, set);
    const Approximation sum = weighted_sum(w, e);
    return !(std::fabs(sum.value) > sum.error) && exact_weighted_sum(w, p, set).sign() == 0;
  }

  // The sum of numerator[i] E_i over that of denominator[i] E_i, as I4 stores it. The latter is not 0.
  float weighted_mean(const double (&numerator)[3], const double (&denominator)[3], SamplePosition p, EdgeSet set,
                      Rungs* rungs = nullptr) const {
    Approximation e[3];
    evaluate_edges(p, e, set);
    const Approximation q = quotient(weighted_sum(numerator, e), weighted_sum(denominator, e));
    const auto exact = [&] {
      return round_quotient(exact_weighted_sum(numerator, p, set), exact_weighted_sum(denominator, p, set));
    };
    return rounded(q, exact, rungs);
  }

  Approximation approximate_determinant() {
    know_determinant();
    return {determinant_estimate_, std::fabs(determinant_estimate_) * 0x1p-50};
  }

  // I8's m: the larger one of two is as near to the truth as they are.
  Approximation approximate_slope() {
    Approximation a[3], b[3];
    for (int i = 0; i < 3; ++i) {  // rounded once
      a[i] = {edge_[i].a, std::fabs(edge_[i].a) * 0x1p-52};
      b[i] = {edge_[i].b, std::fabs(edge_[i].b) * 0x1p-52};
    }
    const double z[3] = {vertex_[0].z, vertex_[1].z, vertex_[2].z};
    const Approximation x = quotient(weighted_sum(z, a), approximate_determinant());
    const Approximation y = quotient(weighted_sum(z, b), approximate_determinant());
    return {std::max(std::fabs(x.value), std::fabs(y.value)), std::max(x.error, y.error)};
  }

  float rounded_depth(SamplePosition p, Approximation q, Rungs* rungs = nullptr) {
    return rounded(
        q, [&] { return round_quotient(exact_depth_numerator(p), exact_determinant_value()); }, rungs);
  }

  // D itself is needed for values only; once per triangle.
  void know_determinant() {
    if (determinant_known_) return;
    determinant_ = exact_determinant(vertex_[0], vertex_[1], vertex_[2]);
    determinant_estimate_ = determinant_.estimate();
    determinant_known_ = true;
  }

  // 0 <= numerator / D <= 1, exactly (I5).
  bool inside_unit_range(const Expansion<60>& numerator, Rungs* rungs = nullptr) const {
    count(rungs, &Rungs::values_by_expansion);
    if (numerator.sign() * determinant_sign_ < 0) return false;
    return minus_multiple_of_determinant(numerator, 1).sign() * determinant_sign_ <= 0;
  }

  // numerator - bound D for a bound of 0 or 1.
  Expansion<72> minus_multiple_of_determinant(const Expansion<60>& numerator, double bound) const {
    Expansion<72> rest;
    for (int i = 0; i < numerator.size(); ++i) rest.add(numerator.term(i));
    for (int i = 0; i < determinant_.size(); ++i) rest.add(-bound * determinant_.term(i));
    return rest;
  }

  Vertex vertex_[3];
  EdgeFunction edge_[3];  // edge i lies opposite vertex i
  int determinant_sign_ = 0;
  bool determinant_known_ = false;
  double determinant_estimate_ = 0;
  Expansion<12> determinant_;
};

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/exact/grid.hpp
//
// Grid mode (semantics.md, section 6): a triangle clipped to the guard band and projected, its corners rounded once to
// the fixed-point grid, and everything that is then asked of it.



namespace surefill_reference {

constexpr double kGuardBand = kMaxTargetSize + 1;  // g of G1: |X - ox W| <= g W and |Y - oy W| <= g W

// An estimate of a coordinate in units of the grid is a rounded value's neighbour only within this: |t| < 2^27, or, with
// an origin, 2^35.
inline double snap_error(bool with_origin = false) {
  return with_origin ? 0x1p-13 : 0x1p-21;
}

// c / w, which lies in [-g, g], rounded to the grid as G1 says: a position in pixels. w > 0.
double snapped_position(float c, float w, int offset, const Grid& grid, Rungs* rungs = nullptr);

// A corner of the clipped triangle: homogeneous coordinates, exact, W > 0 once all four planes have been applied. Sums
// of four products of a float32 or a 47-bit product of a float by a float32, so at most eight terms.
struct GuardCorner {
  Expansion<8> x, y, z, w;
  int guard_x = 0, guard_y = 0;  // not both 0: the corner (ox + guard_x g, oy + guard_y g) of the band itself; x, y, w
                                 // say so, z is not set, for there Z/W is I1
  int line = 0;  // which line leads to the next corner: 0..2 the triangle's edge i, 3 + p the guard plane p
};

// The part of a triangle within the guard band. Each of the four planes adds at most one corner.
struct GuardPolygon {
  GuardCorner corner[7];
  int corners = 0;
};

// The smallest and the largest Z/W among the corners of a polygon (G2): rounded as I4 says, and compared exactly.
struct DepthRange {
  float low, high;
  bool low_below_zero, high_below_zero, low_above_one, high_above_one;
};

// Does the hull of a triangle's vertices contain the eye, where D = 0 (G1)?
bool hull_contains_eye(const Triangle& triangle);

// An exact depth: Z/W of a corner, or I1. The denominator is not 0.
struct DepthFraction {
  Expansion<60> numerator;
  Expansion<12> denominator;
};

class SnappedTriangle {
 public:
  // False if the triangle's hull contains the eye (G1). Vertices are finite (B1). The grid is valid. Places are in space
  // whatever the origin (S6), which is where the guard band lies.
  bool set_up(const Vertex& v0, const Vertex& v1, const Vertex& v2, const Grid& grid, Rungs* rungs = nullptr,
              Origin origin = {});

  // The clipped polygon on the grid: positions in pixels, exact.
  int corners() const { return polygon_.corners; }
  SamplePosition corner(int n) const {
    return {static_cast<double>(point_[n].x) / units_per_pixel_ + origin_.x,
            static_cast<double>(point_[n].y) / units_per_pixel_ + origin_.y};
  }
  // What depth is clamped to (G2).
  const DepthRange& depth_range() {
    know_depth_range();
    return depth_range_;
  }

  // The part of `limits` with a sample in the box of the snapped polygon. Offsets as for screen_box.
  PixelBox box(PixelBox limits, double least_offset, double largest_offset) const;

  // N(p) of G1: -1, 0 or 1.
  int winding(SamplePosition p, TieShift shift) const { return winding(point_, polygon_.corners, p, shift); }
  // Does the triangle of corners 0, n and n + 1 cover p?
  bool fan_covers(int n, SamplePosition p, TieShift shift) const {
    const Point triangle[3] = {point_[0], point_[n], point_[n + 1]};
    return winding(triangle, 3, p, shift) != 0;
  }

  // Depth at p as G2, I8 and I4 have it; false if depth clipping removes the fragment (I5).
  bool depth(SamplePosition p, const DrawState& state, float* stored, Rungs* rungs = nullptr);

  // Does an E_i count at p (G2)? If not, or if D = 0, the values at p are those of vertex 0.
  bool has_weights(SamplePosition p, Rungs* rungs = nullptr) const { return triangle_.right_edges(p, rungs) != 0; }

  // An attribute at p as G2 and I4 have it, from its values at the three vertices.
  float attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Rungs* rungs = nullptr) {
    return triangle_.attribute_of_right_edges(p, u, interpolation, rungs);
  }

 private:
  // In units of 2^-(bits + 4) pixels from the origin, in which grid positions and samples are integers. Below 2^30 +
  // 2^17 in magnitude.
  struct Point {
    std::int64_t x, y;
  };

  int winding(const Point* corner, int corners, SamplePosition p, TieShift shift) const;
  void know_depth_range();
  DepthFraction corner_depth(int n);
  float biased_depth(SamplePosition p, const DepthBias& bias, Rungs* rungs);

  Triangle triangle_;  // unsnapped
  Origin origin_;
  GuardPolygon polygon_;
  Point point_[7];  // the corners of polygon_, snapped
  double units_per_pixel_ = 1;
  bool depth_range_known_ = false;
  DepthRange depth_range_{};
};

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/exact/line.hpp
//
// A line of a draw: the samples that it covers, wide or thin (M7), and its values there (I7). S is what is seen of it: a
// segment or a ray, from its vertex 0 towards its vertex 1. Along the major axis t it has one point a coordinate.



namespace surefill_reference {

class Line {
 public:
  // False if it covers nothing: S is empty, or one point. Vertices are finite, the width too and above 0; without one the
  // line is thin.
  bool set_up(const Vertex& v0, const Vertex& v1, std::optional<float> width);

  // z(t) = slope t + start for the depth (I7) between the ends, off by less than error + 2^-50 |slope t|.
  struct DepthAlong {
    double slope, start, error;
  };
  DepthAlong depth_along() const;

  bool x_major() const { return x_major_; }
  double half_width() const { return half_; }
  const EdgeFunction& edge() const { return edge_; }

  bool covers(SamplePosition p, TieShift shift, Rungs* rungs = nullptr) const;

  // Has S a point with the major coordinate of the moved sample?
  bool within_ends(SamplePosition p, TieShift shift) const {
    const double t = along(p);
    const int step = x_major_ ? shift.x : shift.y;
    for (int i = 0; i < 2; ++i) {
      if (!(end_[i].w > 0)) continue;
      const int after = t * end_[i].w == end_[i].t  ? step
                        : t * end_[i].w > end_[i].t ? 1
                                                    : -1;  // exact: 27 and 24 bits
      if (after * forward_ != (i == 0 ? 1 : -1)) return false;
    }
    return true;
  }

  // From which to which major coordinate S reaches, to within a rounding; without an end, infinitely far.
  Reach reach_of_ends() const;

  // The pixels of `limits` that it can cover. Sample offsets within a pixel lie in [least_offset, largest_offset].
  PixelBox box(PixelBox limits, double least_offset, double largest_offset) const;

  // Depth as it is stored; false if depth clipping removes the fragment (I5).
  bool depth(SamplePosition p, DepthMode mode, float* to, Rungs* rungs = nullptr) const;

  // An attribute at p as I4 stores it, from its values at the two vertices.
  float attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Rungs* rungs = nullptr) const;

 private:
  struct End {
    double t, w, z;  // the major coordinate times W
  };

  // n_0 v_0 + n_1 v_1 for I7's k_i = n_i / determinant: n_0 = a_0 - b_0 and n_1 = a_1 - b_1, of doubles. One of the
  // n_i may be 0, and none has another sign than the determinant d_0 - d_1.
  struct Mix {
    double a[2], b[2], d[2], v[2];

    Approximation sum() const {
      const double s0 = (a[0] - b[0]) * v[0], s1 = (a[1] - b[1]) * v[1];
      return {s0 + s1, 0x1p-50 * (std::fabs(s0) + std::fabs(s1))};
    }
    Approximation weights() const {
      const double sum = (a[0] - b[0]) + (a[1] - b[1]);
      return {sum, 0x1p-51 * std::fabs(sum)};
    }
    Approximation determinant() const {
      const double difference = d[0] - d[1];
      return {difference, 0x1p-52 * std::fabs(difference)};
    }
    Expansion<8> exact_sum() const {
      Expansion<8> sum;
      for (int i = 0; i < 2; ++i) sum.add_product(a[i], v[i]), sum.add_product(-b[i], v[i]);
      return sum;
    }
    Expansion<4> exact_weights() const {
      Expansion<4> sum;
      for (int i = 0; i < 2; ++i) sum.add(a[i]), sum.add(-b[i]);
      return sum;
    }
    Expansion<2> exact_determinant() const {
      Expansion<2> difference;
      difference.add(d[0]), difference.add(-d[1]);
      return difference;
    }
  };

  double along(SamplePosition p) const { return x_major_ ? p.x : p.y; }

  // |dx| >= |dy| of S's direction (b, -a)? Rounding is monotonic, so only equal numbers have to be looked at.
  bool along_x() const;

  // The sign of E + s |m| w/2 at the moved sample, m the coefficient of the minor coordinate: the line is wider than its
  // distance from the sample where it is not s's opposite, for both s.
  int side(SamplePosition p, int s, TieShift shift, Rungs* rungs) const;

  // Does S have an end at vertex i that lies in the open diamond around the moved sample?
  bool ends_in_diamond(int i, SamplePosition p, TieShift shift) const;

  Reach widened(Reach r) const;

  // I7 at p for values v_0 and v_1: at the point of S that has p's major coordinate, or at the nearest end.
  Mix mix_at(SamplePosition p, double v0, double v1) const;

  // 0 <= sum / determinant <= 1, exactly.
  static bool inside_unit_range(const Mix& mix);

  EdgeFunction edge_;
  bool thin_ = false, x_major_ = true;
  int forward_ = 1;    // does t grow along S?
  double half_ = 0.5;  // of the width
  double slope_ = 0;   // the edge's coefficient of the minor coordinate
  End end_[2] = {};
};

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/exact/point.hpp
//
// A point of a draw: the square of samples that it covers (M7), and its values (I6).



namespace surefill_reference {

class Point {
 public:
  // False if it covers nothing. The vertex is finite; the size is finite and above 0.
  bool set_up(const Vertex& v, float size) {
    vertex_ = v;
    half_ = 0.5 * static_cast<double>(size) * v.w;  // of the side, times W: 48 bits, exact
    return v.w > 0;
  }

  bool covers(SamplePosition p, TieShift shift) const {
    return covers(p.x, vertex_.x, shift.x) && covers(p.y, vertex_.y, shift.y);
  }

  // The pixels of `limits` that it can cover. Sample offsets within a pixel lie in [least_offset, largest_offset].
  PixelBox box(PixelBox limits, double least_offset, double largest_offset) const {
    clip_to_reach(reach_of(vertex_.x), least_offset, largest_offset, &limits.x0, &limits.x1);
    clip_to_reach(reach_of(vertex_.y), least_offset, largest_offset, &limits.y0, &limits.y1);
    return limits;
  }

  // Depth as it is stored; false if depth clipping removes the fragments (I5).
  bool depth(DepthMode mode, float* to) const {
    const double z = vertex_.z, w = vertex_.w;
    if (mode == DepthMode::clip && (z < 0 || z > w)) return false;
    const double q = z / w;
    *to = rounded({q, std::fabs(q) * 0x1p-52}, [&] {
      Expansion<1> numerator, denominator;
      numerator.add(z), denominator.add(w);
      return round_quotient(numerator, denominator);
    });
    if (mode == DepthMode::clamp) *to = *to < 0 ? 0.0f : *to > 1 ? 1.0f : *to;  // rounding is monotonic
    return true;
  }

 private:
  // |p' - c/W| < s/2 along one axis, on which a sample is moved by `step`. p W is exact: 27 and 24 bits.
  bool covers(double p, double c, int step) const {
    return sign(p * vertex_.w, -c, -half_, step) < 0 && sign(p * vertex_.w, -c, half_, step) > 0;
  }

  // Of a + b + c, where a moves by an infinitely small part of `step`.
  static int sign(double a, double b, double c, int step) {
    const double sum = (a + b) + c;
    if (std::fabs(sum) > 0x1p-51 * ((std::fabs(a) + std::fabs(b)) + std::fabs(c))) return sign_of(sum);
    Expansion<3> exact;
    exact.add(a), exact.add(b), exact.add(c);
    return exact.sign() != 0 ? exact.sign() : step;
  }

  // A little more than what it covers along an axis.
  Reach reach_of(double c) const {
    const double centre = c / vertex_.w, half = half_ / vertex_.w;
    const double margin = half + 0x1p-50 * (std::fabs(centre) + half);
    return {centre - margin, centre + margin};
  }

  Vertex vertex_;
  double half_ = 0;
};

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/exact/exact_draw.hpp
//
// A primitive of a draw, as its mode has it: what it covers, and the values there, by the scalar arithmetic of Triangle,
// SnappedTriangle, Line and Point. All that the reference path draws with, and what the vector code asks where it cannot tell.
// Compiled once, and not for each instruction set; it keeps the one that was asked about last.



namespace surefill_reference {

// The sign of D of a triangle (C1).
int orientation(const Draw& draw, std::uint32_t position, Rungs* rungs = nullptr);

// Does the triangle, whose D is 0, cover nothing? Under Grid it does not always (G1), and where it is asked for the
// pixels that it touches (M4b).
bool is_degenerate(const Draw& draw, std::uint32_t position);

class ExactDraw {
 public:
  // Pixels and places are those of space; the origin is the target's (S6), which Grid alone looks at.
  explicit ExactDraw(Origin origin = {}) : origin_(origin) {}

  // The primitive at a position in the draw, whose vertices are finite (B1). False if it covers nothing: a triangle by C1
  // (but for M4b) or, under Grid, by G1, a line or a point by M7. Everything below is about it.
  bool use(const Draw& draw, std::uint32_t position, Rungs* rungs = nullptr);

  // The pixels of `limits` that it can cover. Sample offsets within a pixel lie in [least_offset, largest_offset].
  PixelBox box(const PixelBox& limits, double least_offset, double largest_offset) const;

  // Coverage as attributes have it, without culling: C2, C3, C5; under Grid G1, N != 0.
  bool covers(SamplePosition p, TieShift shift, Rungs* rungs = nullptr) const { return facing(p, shift, rungs) != 0; }
  // Coverage as M2 counts it, but for scissor and depth clip: covered, and not culled (F2).
  bool draws(SamplePosition p, TieShift shift, Rungs* rungs = nullptr) const {
    const int side = facing(p, shift, rungs);
    return side != 0 && !(has_triangles(*draw_) && culls(*draw_, side));
  }
  bool draws_square(int x, int y, Rungs* rungs = nullptr) const;  // M4, M4a, M4b
  // Is it a triangle that is culled whole (F2)? Under Grid that is a matter of the sample (G1).
  bool is_culled() const { return has_triangles(*draw_) && !draw_->grid && culls(*draw_, triangle_.determinant()); }
  // Does the triangle face front there, where it draws (F1; under Grid G1)?
  bool is_front(SamplePosition p, TieShift shift, Rungs* rungs = nullptr) const {
    return faces_front(*draw_, facing(p, shift, rungs));
  }

  // Depth as it is stored; false if depth clipping removes the fragment: I1, I5; under Grid G2.
  bool depth(SamplePosition p, float* stored, Rungs* rungs = nullptr);
  // Is there a value at p, covered or not (M1)?
  bool has_values(SamplePosition p) const;
  // Where the attributes of pixel (x, y) are taken, in which the triangle is seen (M1).
  SamplePosition place_of_attributes(const Target& target, int x, int y, TieShift shift) const;
  float attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Rungs* rungs = nullptr);

  const Line& line() const { return line_; }              // of a draw of lines
  const Triangle& triangle() const { return triangle_; }  // without Grid only
  SnappedTriangle& snapped() { return snapped_; }         // under Grid only

 private:
  // 0 if it does not cover p; else the sign of D or, under Grid, of N(p); of a line or a point 1.
  int facing(SamplePosition p, TieShift shift, Rungs* rungs) const {
    if (!has_triangles(*draw_)) return is_line() ? line_.covers(p, shift, rungs) : point_.covers(p, shift);
    if (draw_->grid) return snapped_.winding(p, shift);
    return triangle_.covers(p, shift, rungs) ? triangle_.determinant() : 0;
  }

  bool is_line() const { return draw_->primitive == Primitive::lines; }

  Origin origin_;
  const Draw* draw_ = nullptr;
  std::uint32_t position_ = 0;
  bool covers_something_ = false;
  Triangle triangle_;        // without Grid
  SnappedTriangle snapped_;  // and with Grid
  Line line_;
  Point point_;
};

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/fragments.hpp
//
// What becomes of a sample that a triangle covers, by scalar exact arithmetic: counts, winding, numbers of triangles, the
// index of conservative frames, and the layers of those that are seen. Who covers is found out elsewhere: by the reference
// path, sample by sample, or by the fast path's stream of coverage.



namespace surefill_reference {

// A covered sample: the triangle, by its position in the draw, the pixel of the target, the number of the sample and,
// where somebody looks at depth, what is stored of it.
struct Fragment {
  std::uint32_t position;
  int x, y, n;
  float z = 0;
};

// Who is seen at the samples of a frame, layer by layer (V4). Element n total + s is layer n of sample s. An empty place
// has no draw; its depth is the initial one (V1).
class Layers {
 public:
  static constexpr std::uint32_t kNoDraw = 0xFFFFFFFFu;

  // False where memory is lacking. `named`: somebody looks at who is seen, and not at the depth alone.
  bool allocate(const Target& target, bool named);

  std::size_t size() const { return layers_ * total_; }
  std::size_t total() const { return total_; }
  float depth(std::size_t place) const { return depth_[place]; }
  // kNoDraw where nobody looks at who is seen.
  std::uint32_t draw(std::size_t place) const { return draw_ != nullptr ? draw_[place] : kNoDraw; }
  std::uint32_t position(std::size_t place) const { return position_[place]; }

  void put(std::size_t place, std::uint32_t draw, std::uint32_t position) {
    if (draw_ != nullptr) draw_[place] = draw, position_[place] = position;
  }
  // Puts a fragment into the only layer there is.
  void replace(std::size_t place, std::uint32_t draw, std::uint32_t position, float z) {
    put(place, draw, position);
    depth_[place] = z;
  }
  // Puts a fragment into a place; what was there, and behind it, moves one layer back.
  void insert(std::size_t place, std::uint32_t draw, std::uint32_t position, float z);

 private:
  std::size_t total_ = 0, layers_ = 1;
  float* depth_ = nullptr;
  std::unique_ptr<float[]> own_depth_;
  std::unique_ptr<std::uint32_t[]> draw_, position_;
};

// The fragments of one draw, whose triangles come in order at each sample. Of one thread; several may work on different
// samples of a draw.
class DrawFragments {
 public:
  // `layers` is null if nobody looks at depth.
  DrawFragments(const Target& target, const Draw& draw, std::uint32_t number, Layers* layers, Rungs& rungs)
      : target_(target),
        draw_(draw),
        number_(number),
        layers_(layers),
        rungs_(rungs),
        shift_(tie_shift(draw.fill_rule)),
        depth_alone_(layers != nullptr && target.layers == 1 && draw.depth_write && draw.identifiers.empty() &&
                     !takes_equal(target.depth_test) && target.count.empty() && target.winding.empty() &&
                     draw.covered.empty()),
        triangle_(target.origin) {}

  // The draw's exact triangles, of which one is in use, and its number in the frame.
  ExactDraw& triangle() { return triangle_; }
  std::uint32_t number() const { return number_; }

  // M2, of the triangle in use: covered, not culled, and not removed by depth clipping. Finds out the depth, where somebody
  // looks at it.
  bool counts(Fragment& f);
  // What is left of that where M2 but for M4a is known to hold.
  bool counts_of_covered(Fragment& f);
  // Counts it, and sees who is in front.
  void take(const Fragment& f) {
    if (!depth_alone_) return take_all(f);
    const std::size_t s = sample_index(target_, f.x, f.y, static_cast<std::size_t>(f.n));
    const float there = layers_->depth(s);
    if (is_reversed(target_.depth_test) ? f.z > there : f.z < there) layers_->replace(s, number_, f.position, f.z);
  }

  // Writes barycentrics and attributes of a triangle that is seen in pixel (x, y) of the target, to a place of the outputs.
  void shade(std::uint32_t position, int x, int y, std::size_t place);

 private:
  void take_all(const Fragment& f);
  SamplePosition place_of(const Fragment& f) const {
    return place_of_sample(target_, target_.origin.x + f.x, target_.origin.y + f.y, f.n);
  }
  void see(const Fragment& f, std::size_t s);
  bool passes(float z, std::size_t place) const;
  bool precedes(const Fragment& f, std::size_t place) const;
  // Of a place that has a triangle of this draw.
  std::uint32_t index_at(std::size_t place) const { return index_of(draw_, layers_->position(place)); }

  const Target& target_;
  const Draw& draw_;
  std::uint32_t number_;
  Layers* layers_;
  Rungs& rungs_;
  TieShift shift_;
  bool depth_alone_;  // nothing counts fragments, and one that comes later is seen only if it is nearer
  ExactDraw triangle_;
};

// A frame before and after its fragments.
class FragmentFrame {
 public:
  FragmentFrame(const Target& target, std::span<const Draw> draws);

  // Memory, and the empty image (V1). False where memory is lacking: then nothing is written.
  bool begin();
  // Null if nobody looks at depth.
  Layers* layers() { return seen_ ? &layers_ : nullptr; }
  // Writes what the fragments have made: index, barycentrics, attributes, visible numbers.
  void finish(Rungs& rungs);

 private:
  void show(std::uint32_t number, Rungs& rungs);

  const Target& target_;
  std::span<const Draw> draws_;
  Wanted wanted_;
  bool visible_ = false, seen_ = false;
  Layers layers_;
};

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/exact/conservative.hpp
//
// Conservative rasterization (M4, M4a, M4b): whether the closed square of a pixel meets, shares an area with, or lies in
// the closed set T of all real points where no E_i / D is negative. Needs no arithmetic beyond the signs of the E_i at
// the square's corners, but for degenerate triangles.



namespace surefill_reference {

// The closed square of pixel (x, y) against a triangle with D != 0.
class PixelSquare {
 public:
  PixelSquare(const Triangle& triangle, int x, int y, Rungs* rungs = nullptr) : triangle_(triangle), x_(x), y_(y) {
    const double left = x, right = x + 1, top = y, bottom = y + 1;
    const SamplePosition corner[4] = {{left, top}, {right, top}, {right, bottom}, {left, bottom}};
    for (int i = 0; i < 3; ++i) {
      for (int c = 0; c < 4; ++c) {
        sign_[i][c] = triangle.edge(i).sign(corner[c], rungs) * triangle.determinant();
      }
    }
  }

  // Inner: T is convex, so its corners decide.
  bool inside() const {
    for (const auto& of_edge : sign_) {
      for (const int sign : of_edge) {
        if (sign < 0) return false;
      }
    }
    return true;
  }

  // Overlap, where some W_i > 0. Helly's theorem again, for the open square and the open half-planes {E_i / D > 0}, which
  // have a common point: near a vertex in front of the eye.
  bool overlapped() const { return pair_overlaps(0, 1) && pair_overlaps(1, 2) && pair_overlaps(2, 0); }

  // Over, where some W_i > 0; where none is, T is empty, and otherwise it is not (a vertex in front of the eye projects
  // into it). Helly's theorem in the plane: the square and the half-planes H_i = {E_i / D >= 0} have a common point if
  // any three of these four convex sets have one. The three half-planes do.
  bool touched() const { return pair_meets(0, 1) && pair_meets(1, 2) && pair_meets(2, 0); }

 private:
  // Do H_i, H_j and the square meet, j = i + 1 modulo 3? Two half-planes that meet do so in an unbounded set, so if
  // they meet the square, they do on one of its sides. If no corner lies in both, that means: one end of the side lies
  // in H_i alone, the other in H_j alone, and the point between them where E_i = 0 lies in H_j.
  bool pair_meets(int i, int j) const {
    for (int c = 0; c < 4; ++c) {
      if (sign_[i][c] >= 0 && sign_[j][c] >= 0) return true;
    }
    for (int side = 0; side < 4; ++side) {
      if (crossing_is_inside(i, side)) return true;
    }
    return false;
  }

  // Do the interiors of H_i, H_j and the square have a common point, j = i + 1 modulo 3? The wedge of both half-planes is
  // open and unbounded, so if it meets the open square, it meets its border too, and there whole stretches of a side;
  // and where it meets the border, it meets the square. Along a side E_i and E_j are linear: if no corner lies in both
  // interiors, one end of the side lies in one of them and the other end in the other. At a corner where E_i = 0 and E_j
  // > 0 next to one with E_i > 0, the stretch begins at once; otherwise it ends where E_i = 0, and E_j must be positive
  // there.
  bool pair_overlaps(int i, int j) const {
    for (int c = 0; c < 4; ++c) {
      if (sign_[i][c] > 0 && sign_[j][c] > 0) return true;
    }
    for (int side = 0; side < 4; ++side) {
      const int p = side, q = (side + 1) % 4;
      for (const auto& [here, next] : {std::pair(p, q), std::pair(q, p)}) {
        if (sign_[i][here] == 0 && sign_[j][here] > 0 && sign_[i][next] > 0) return true;
        if (sign_[j][here] == 0 && sign_[i][here] > 0 && sign_[j][next] > 0) return true;
      }
      if (crossing_side(i, side) > 0) return true;
    }
    return false;
  }

  // Does line i cross the side from corner p to corner q between them, at a point of H_j, j = i + 1 and k = i + 2?
  //
  // The point is |E_i(q)| p + |E_i(p)| q. E_i has opposite signs at p and q, so the value of E_j there is the sign of
  // E_i(p) times E_i(p) E_j(q) - E_i(q) E_j(p), up to a positive factor. That difference is D m_k . (p x q), because
  // (m_j x m_k) x (m_k x m_i) = D m_k. So E_j / D has the sign of E_i(p) m_k . (p x q).
  bool crossing_is_inside(int i, int side) const { return crosses(i, side) && crossing_side(i, side) >= 0; }

  bool crosses(int i, int side) const { return sign_[i][side] * sign_[i][(side + 1) % 4] < 0; }

  // The sign of E_j / D where line i crosses the side; 0 too if it does not.
  int crossing_side(int i, int side) const {
    return crosses(i, side) ? sign_[i][side] * triangle_.determinant() * vertex_side((i + 2) % 3, side) : 0;
  }

  // The sign of m_k . (p x q) for the corners p and q of a side: W_k times the distance of vertex k from the side's
  // line, inwards. Both sides of each comparison are exact: 24 bits, and 24 by 23 bits.
  int vertex_side(int k, int side) const {
    const Vertex& v = triangle_.vertex(k);
    const double x = v.x, y = v.y, w = v.w;
    switch (side) {
      case 0:
        return sign_of_difference(y, y_ * w);
      case 1:
        return sign_of_difference((x_ + 1) * w, x);
      case 2:
        return sign_of_difference((y_ + 1) * w, y);
      default:
        return sign_of_difference(x, x_ * w);
    }
  }

  static int sign_of_difference(double a, double b) { return a > b ? 1 : a < b ? -1 : 0; }

  const Triangle& triangle_;
  double x_, y_;
  int sign_[3][4];  // of E_i / D at the corners: top left, top right, bottom right, bottom left
};

// M4b for D = 0: does the S (M7) of an edge of the triangle, a single point too, meet the closed square of pixel (x, y)?
//
// A point l_0 m_0 + l_1 m_1 in front of the eye lies in the square if none of the four linear functions X - x W, (x + 1)
// W - X, Y - y W, (y + 1) W - Y is negative there; the first two sum to W. The l >= 0 for which that is so are a cone,
// whose extreme rays are among those of the two vertices and those where one function is 0. W is linear, so if it is
// positive anywhere in the cone, it is on an extreme ray.
inline bool degenerate_touches(const Triangle& triangle, int x, int y) {
  constexpr int kSides = 4;
  const auto sides_at = [&](const Vertex& v, Expansion<2>(&value)[kSides]) {
    const double left = x, top = y, vx = v.x, vy = v.y, w = v.w;  // the products have 24 and 23 bits
    value[0].add(vx), value[0].add(-(left * w));
    value[1].add((left + 1) * w), value[1].add(-vx);
    value[2].add(vy), value[2].add(-(top * w));
    value[3].add((top + 1) * w), value[3].add(-vy);
  };
  for (int edge = 0; edge < 3; ++edge) {
    Expansion<2> at_from[kSides], at_to[kSides];
    sides_at(triangle.edge(edge).from, at_from), sides_at(triangle.edge(edge).to, at_to);
    // Is l_0 from + l_1 to a point of the square?
    const auto inside = [&](const Expansion<2>& l0, const Expansion<2>& l1) {
      int least = 1, across = -1;
      for (int side = 0; side < kSides; ++side) {
        Expansion<16> sum;
        sum.add_product_of(at_from[side], l0), sum.add_product_of(at_to[side], l1);
        least = std::min(least, sum.sign());
        if (side < 2) across = std::max(across, sum.sign());
      }
      return least >= 0 && across > 0;
    };
    Expansion<2> zero, one;
    one.add(1);
    if (inside(one, zero) || inside(zero, one)) return true;
    for (int side = 0; side < kSides; ++side) {
      Expansion<2> l0 = at_to[side], l1 = at_from[side];
      if (l0.sign() * l1.sign() >= 0) continue;
      (l0.sign() < 0 ? l0 : l1).negate();
      if (inside(l0, l1)) return true;
    }
  }
  return false;
}

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/reference.hpp
//
// The scalar reference path: plain portable C++, one triangle and one sample at a time. It is what the fast path is
// held to.



namespace surefill_reference::reference {

// As surefill_reference::render, for arguments that validate() has accepted, with the floating-point state already set. Returns
// ok or out_of_memory.
Status render(const Target& target, std::span<const Draw> draws, Rungs& rungs) noexcept;

// The fragments of one draw, onto what the draws before it have left.
void draw(const Target& target, const Draw& draw, std::uint32_t number, Layers* layers, Rungs& rungs) noexcept;

// As surefill_reference::visit_coverage, in the same way. Returns ok.
Status visit_coverage(const Target& target, std::span<const Draw> draws, const CoverageVisitor& visitor,
                      Rungs& rungs) noexcept;

}  // namespace surefill_reference::reference

// ---------------------------------------------------------------- src/statistics.hpp
namespace surefill_reference {

// M11: of draws that validate() has accepted, with the floating-point state already set. No path has a part in it.
Statistics statistics_of(std::span<const Draw> draws) noexcept;

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/overlap.hpp
//
// Which memory a call writes, and whether that overlaps what it reads (B2).



namespace surefill_reference {

struct Bytes {
  std::uint64_t begin = 0, end = 0;  // in 64 bits: memory may end where the addresses do

  Bytes() = default;
  Bytes(const void* data, std::uint64_t size) : begin(reinterpret_cast<std::uintptr_t>(data)), end(begin + size) {}
  template <typename T>
  explicit Bytes(std::span<T> s) : Bytes(s.data(), s.size() * std::uint64_t{sizeof(T)}) {}
  // Of one object, which may be null.
  template <typename T>
  static Bytes of(const T* object) {
    return {object, object == nullptr ? 0 : sizeof(T)};
  }

  bool empty() const { return begin == end; }
  // Do they share a byte? Empty ones share none.
  bool overlaps(const Bytes& other) const {
    return begin < end && other.begin < other.end && begin < other.end && other.begin < end;
  }
};

// The memory that a call writes.
class Outputs {
 public:
  // False if it overlaps what was there before.
  bool add(const Bytes& bytes) {
    if (touched_by(bytes)) return false;
    bytes_[count_++] = bytes;
    return true;
  }

  // All buffers of a target; false if they overlap. A list of attributes that is null or too long is not read.
  bool add_buffers(const Target& target) {
    bool apart = add(Bytes(target.count)) && add(Bytes(target.index)) && add(Bytes(target.depth)) &&
                 add(Bytes(target.barycentrics)) && add(Bytes(target.winding));
    if (target.attributes.data() == nullptr || target.attributes.size() > kMaxAttributes) return apart;
    const std::size_t buffers = count_;
    for (const AttributeTarget& image : target.attributes) {
      const Bytes bytes(image.values);
      apart = apart && !touches(bytes, 0, buffers) && !numbers_touch(bytes);
      for (std::size_t k = 0; apart && k < count_ - buffers; ++k)
        apart = !bytes_[buffers + k].overlaps(bytes) || lie_side_by_side(target.attributes[k], image);
      if (!apart) return false;
      bytes_[count_++] = bytes;
    }
    return apart;
  }

  // The numbers of the draws' triangles (M10), where one asks for them. The list stays where it is.
  void add_numbers(std::span<const Draw> draws) {
    for (const Draw& draw : draws) {
      if (!draw.covered.empty() || !draw.visible.empty()) draws_ = draws;
    }
  }
  bool has_numbers() const { return !draws_.empty(); }

  bool touched_by(const Bytes& bytes) const { return touches(bytes, 0, count_) || numbers_touch(bytes); }

  // Do the numbers of a draw's triangles lie on these bytes?
  bool numbers_touch(const Bytes& bytes) const {
    return std::any_of(draws_.begin(), draws_.end(), [&](const Draw& draw) {
      return Bytes(draw.covered).overlaps(bytes) || Bytes(draw.visible).overlaps(bytes);
    });
  }

 private:
  bool touches(const Bytes& bytes, std::size_t begin, std::size_t end) const {
    return std::any_of(bytes_ + begin, bytes_ + end, [&](const Bytes& output) { return output.overlaps(bytes); });
  }

  // Two images whose memory overlaps: does each keep to its own components of every sample? By the distance of their
  // first ones, modulo the stride that both have.
  static bool lie_side_by_side(const AttributeTarget& a, const AttributeTarget& b) {
    const std::uint64_t stride = stride_of(a) * std::uint64_t{sizeof(float)};
    if (stride_of(a) != stride_of(b) || stride == 0) return false;
    const std::uint64_t from = Bytes(a.values).begin % stride, to = Bytes(b.values).begin % stride;
    const std::uint64_t distance = (to + stride - from) % stride;
    return a.components * sizeof(float) <= distance && distance + b.components * sizeof(float) <= stride;
  }

  static constexpr std::size_t kMost = 7 + kMaxAttributes;  // five buffers, the attributes, statistics, diagnostics
  Bytes bytes_[kMost];
  std::size_t count_ = 0;
  std::span<const Draw> draws_;  // those with numbers, or none
};

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/build_check.cpp
namespace surefill_reference {
namespace {

// The forms that compilers contract or reorder. Not inlined: it needs the engine's floating-point state.
template <typename T>
[[gnu::noinline]] bool holds() {
  ContractionProbe<T> p;
  const T x0 = p.x, x1 = p.x, x2 = p.x, x3 = p.x, square = p.square, one = p.one, small = p.small;
  const T subtracted = x0 * x0 - square;  // all are 0 as they are written
  const T negated = square - x1 * x1;
  const T added = x2 * x2 + -square;
  const T of_products = x3 * x3 - one * square;
  const T reordered = (one + small) - one;
  return subtracted == 0 && negated == 0 && added == 0 && of_products == 0 && reordered == 0;
}

}  // namespace

bool is_exact_build() {
  static const bool exact = [] {
    const FloatEnvironment environment;
    return holds<float>() && holds<double>();
  }();
  return exact;
}

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/exact/grid.cpp
namespace surefill_reference {
namespace {

// The planes of the guard band: gW - X, gW + X, gW - Y, gW + Y, in the order in which they clip. Positive is inside.
constexpr int kPlanes = 4;
constexpr bool bounds_x(int plane) {
  return plane < 2;
}
constexpr double outwards(int plane) {
  return plane % 2 == 0 ? 1 : -1;
}

// Where the band ends at a plane, counted outwards: a whole number of 23 bits.
double limit_of(int plane, Origin origin) {
  return kGuardBand + outwards(plane) * (bounds_x(plane) ? origin.x : origin.y);
}

// A plane's function at a vertex of the triangle: 47 and 24 bits.
Expansion<2> plane_value(int plane, const Vertex& v, Origin origin) {
  Expansion<2> sum;
  sum.add(limit_of(plane, origin) * static_cast<double>(v.w));
  sum.add(-outwards(plane) * static_cast<double>(bounds_x(plane) ? v.x : v.y));
  return sum;
}

bool inside_guard_band(const Vertex& v, Origin origin) {
  for (int plane = 0; plane < kPlanes; ++plane) {
    const double coordinate = bounds_x(plane) ? v.x : v.y;
    if (!(outwards(plane) * coordinate <= limit_of(plane, origin) * static_cast<double>(v.w))) return false;
  }
  return true;
}

int plane_sign(int plane, const GuardCorner& corner, Origin origin) {
  Expansion<32> sum;
  sum.add_scaled(corner.w, limit_of(plane, origin));
  sum.add_scaled(bounds_x(plane) ? corner.x : corner.y, -outwards(plane));
  return sum.sign();
}

GuardCorner vertex_corner(const Vertex& v, int line) {
  GuardCorner corner;
  corner.x.add(v.x), corner.y.add(v.y), corner.z.add(v.z), corner.w.add(v.w);
  corner.line = line;
  return corner;
}

// Where a plane cuts the edge from a to b, from these end points alone: |f(b)| a + |f(a)| b, which is the same real
// point for either order. f(a) and f(b) have opposite signs.
GuardCorner edge_corner(int plane, const Vertex& a, const Vertex& b, Origin origin) {
  const Expansion<2> fa = plane_value(plane, a, origin), fb = plane_value(plane, b, origin);
  const auto mean = [&](double at_a, double at_b) {
    Expansion<8> sum;
    sum.add_scaled(fb, fb.sign() * at_a);
    sum.add_scaled(fa, fa.sign() * at_b);
    return sum;
  };
  GuardCorner corner;
  corner.x = mean(a.x, b.x), corner.y = mean(a.y, b.y), corner.z = mean(a.z, b.z), corner.w = mean(a.w, b.w);
  return corner;
}

// The sign of the sum of the E_i at the direction (0, 1, 0), which is b_0 + b_1 + b_2.
int sign_of_b_sum(const Triangle& triangle) {
  Expansion<6> sum;
  for (int i = 0; i < 3; ++i) {
    const EdgeFunction& edge = triangle.edge(i);
    const double jx = edge.from.x, jw = edge.from.w, kx = edge.to.x, kw = edge.to.w;
    sum.add(jw * kx);  // 48 bits, exact
    sum.add(-(jx * kw));
  }
  return sum.sign();
}

// Where two planes of the band meet in the triangle's interior; `first` clipped before `second`. D is not 0: a plane
// through the eye meets a guard plane in a line through the eye, and the part of that line within a hull without the
// eye lies on one side of every other guard plane.
//
// An X plane and a Y plane: both X planes have been applied by then, so W >= 0, and 0 only at the eye; the point is
// (ox +- g, oy +- g, 1) times a positive number.
//
// The two X planes: the point is (0, 1, 0) times l, where the weights l E_i / D of the vertices sum to 1, so l has the
// sign of D times that of the sum of the E_i at (0, 1, 0). It lies outside of a Y plane, and so is gone in the end.
GuardCorner band_corner(int first, int second, const Triangle& triangle, Origin origin) {
  GuardCorner corner;
  if (!bounds_x(second)) {
    corner.guard_x = outwards(first) > 0 ? 1 : -1;
    corner.guard_y = outwards(second) > 0 ? 1 : -1;
    corner.x.add(origin.x + kGuardBand * corner.guard_x), corner.y.add(origin.y + kGuardBand * corner.guard_y);
    corner.w.add(1);
  } else {
    corner.y.add(triangle.determinant() * sign_of_b_sum(triangle));
  }
  return corner;
}

// Where a plane cuts the line that leads from `corner` to the next one.
GuardCorner cut(const GuardCorner& corner, int plane, const Triangle& triangle, Origin origin) {
  if (corner.line >= 3) return band_corner(corner.line - 3, plane, triangle, origin);
  return edge_corner(plane, triangle.edge(corner.line).from, triangle.edge(corner.line).to, origin);
}

// Sutherland and Hodgman 1974, against one plane. A corner on the plane stays and is not cut again.
void clip(const GuardPolygon& in, int plane, const Triangle& triangle, Origin origin, GuardPolygon* out) {
  int sign[7];
  for (int n = 0; n < in.corners; ++n) sign[n] = plane_sign(plane, in.corner[n], origin);
  out->corners = 0;
  for (int n = 0; n < in.corners; ++n) {
    const GuardCorner& corner = in.corner[n];
    const int here = sign[n], next = sign[(n + 1) % in.corners];
    if (here >= 0) {
      GuardCorner& kept = out->corner[out->corners++] = corner;
      if (here == 0 && next < 0) kept.line = 3 + plane;
    }
    if (here * next < 0) {
      GuardCorner& added = out->corner[out->corners++] = cut(corner, plane, triangle, origin);
      added.line = here > 0 ? 3 + plane : corner.line;
    }
  }
}

// G1. The hull of the triangle does not contain the eye.
void clip_to_guard_band(const Triangle& triangle, Origin origin, GuardPolygon* polygon) {
  polygon->corners = 0;
  bool inside = true;
  for (int i = 0; i < 3; ++i) {  // the line from vertex i to vertex i + 1 is the edge opposite vertex i + 2
    polygon->corner[polygon->corners++] = vertex_corner(triangle.vertex(i), (i + 2) % 3);
    inside = inside && inside_guard_band(triangle.vertex(i), origin);
  }
  if (inside) return;
  GuardPolygon other;
  static_assert(kPlanes % 2 == 0, "the last result stands in *polygon");
  for (int plane = 0; plane < kPlanes; plane += 2) {
    clip(*polygon, plane, triangle, origin, &other);
    clip(other, plane + 1, triangle, origin, polygon);
  }
}

// k for t = (numerator / denominator - offset 2^-(bits + 4)) 2^bits, by its floor and by where t lies above it.
double round_to_integer(double floor_of_t, int above_floor, int above_half, GridRounding rounding) {
  const double up = floor_of_t + 1;
  switch (rounding) {
    case GridRounding::nearest_even:
      if (above_half != 0) return above_half > 0 ? up : floor_of_t;
      return std::fmod(floor_of_t, 2) == 0 ? floor_of_t : up;
    case GridRounding::nearest_up:
      return above_half >= 0 ? up : floor_of_t;
    case GridRounding::truncate:
      return floor_of_t < 0 && above_floor > 0 ? up : floor_of_t;
  }
  return floor_of_t;
}

// The grid position of a coordinate numerator / denominator, which lies within g of the origin, in units of 2^-(bits + 4)
// pixels from there; `offset` is in these units.
std::int64_t snap(const Expansion<8>& numerator, const Expansion<8>& denominator, int offset, const Grid& grid,
                  Rungs* rungs, int origin = 0) {
  const double scale = 1 << grid.bits;
  const auto compare = [&](double twice) {  // the sign of t - twice / 2; all factors are exact
    Expansion<32> rest;
    rest.add_scaled(numerator, 2 * scale);
    rest.add_scaled(denominator, -(twice + offset / 8.0));
    return rest.sign();
  };
  // The estimates, the division and the difference have relative errors below 2^-48 together.
  const double error = snap_error(origin != 0);
  const double estimate = numerator.estimate() / denominator.estimate() * scale - offset / 16.0;
  double floor_of_t = std::floor(estimate);
  const double fraction = estimate - floor_of_t;  // exact
  int above_floor = 1, above_half = fraction > 0.5 ? 1 : -1;
  if (fraction > error && fraction < 1 - error && std::fabs(fraction - 0.5) > error) {
    count(rungs, &Rungs::values_by_filter);
  } else {
    count(rungs, &Rungs::values_by_expansion);
    if (compare(2 * floor_of_t) < 0) {
      floor_of_t -= 1;
    } else if (compare(2 * floor_of_t + 2) >= 0) {
      floor_of_t += 1;
    }
    above_floor = compare(2 * floor_of_t);
    above_half = compare(2 * floor_of_t + 1);
  }
  const double k = round_to_integer(floor_of_t, above_floor, above_half, grid.rounding);
  return 16 * (static_cast<std::int64_t>(k) - std::int64_t{origin} * (1 << grid.bits)) + offset;
}

// Widens a range by z / w; an empty range has low > high. Rounding is monotonic, so the rounded ends are those of the
// exact range.
template <std::size_t kZ, std::size_t kW>
void widen(const Expansion<kZ>& z, const Expansion<kW>& w, DepthRange* range) {
  Expansion<kZ + kW> above_one;
  for (int i = 0; i < z.size(); ++i) above_one.add(z.term(i));
  for (int i = 0; i < w.size(); ++i) above_one.add(-w.term(i));
  const bool below_zero = z.sign() * w.sign()<0, is_above_one = above_one.sign() * w.sign()> 0;
  const float rounded = round_quotient(z, w);
  range->low = std::min(range->low, rounded);
  range->high = std::max(range->high, rounded);
  range->low_below_zero = range->low_below_zero || below_zero;
  range->high_below_zero = range->high_below_zero && below_zero;
  range->low_above_one = range->low_above_one && is_above_one;
  range->high_above_one = range->high_above_one || is_above_one;
}

// The sign of a - b.
int compare(const DepthFraction& a, const DepthFraction& b) {
  Expansion<1440> left;
  Expansion<2880> difference;
  left.add_product_of(b.numerator, a.denominator);
  difference.add_product_of(a.numerator, b.denominator);
  for (int i = 0; i < left.size(); ++i) difference.add(-left.term(i));
  return difference.sign() * a.denominator.sign() * b.denominator.sign();
}

}  // namespace

// If a product m_j x m_k is not 0, the three are multiples of one normal, and the weights l with l_0 m_0 + l_1 m_1 +
// l_2 m_2 = 0 are those multiples, up to a factor: the signs of any component of the products that is not 0 throughout
// tell. Else the three vectors are multiples of one direction (or 0), and the hull misses 0 exactly if they are
// positive multiples of one of them: if a coordinate has one sign, other than 0, in all three.
bool hull_contains_eye(const Triangle& triangle) {
  const EdgeFunction &e0 = triangle.edge(0), &e1 = triangle.edge(1), &e2 = triangle.edge(2);
  const double products[3][3] = {{e0.a, e1.a, e2.a}, {e0.b, e1.b, e2.b}, {e0.c, e1.c, e2.c}};
  for (const auto& l : products) {
    const auto [low, high] = std::minmax({l[0], l[1], l[2]});  // their signs are exact
    if (low != 0 || high != 0) return low >= 0 || high <= 0;
  }
  const Vertex &v0 = triangle.vertex(0), &v1 = triangle.vertex(1), &v2 = triangle.vertex(2);
  const auto one_sign = [](float a, float b, float c) {
    return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
  };
  return !one_sign(v0.x, v1.x, v2.x) && !one_sign(v0.y, v1.y, v2.y) && !one_sign(v0.w, v1.w, v2.w);
}

double snapped_position(float c, float w, int offset, const Grid& grid, Rungs* rungs) {
  Expansion<8> numerator, denominator;
  numerator.add(c), denominator.add(w);
  return static_cast<double>(snap(numerator, denominator, offset, grid, rungs)) / (16 << grid.bits);
}

bool SnappedTriangle::set_up(const Vertex& v0, const Vertex& v1, const Vertex& v2, const Grid& grid, Rungs* rungs,
                             Origin origin) {
  depth_range_known_ = false;
  origin_ = origin;
  if (!triangle_.set_up(v0, v1, v2, rungs) && hull_contains_eye(triangle_)) return false;
  clip_to_guard_band(triangle_, origin, &polygon_);
  for (int n = 0; n < polygon_.corners; ++n) {
    const GuardCorner& corner = polygon_.corner[n];
    point_[n] = {snap(corner.x, corner.w, grid.offset_x, grid, rungs, origin.x),
                 snap(corner.y, corner.w, grid.offset_y, grid, rungs, origin.y)};
  }
  units_per_pixel_ = 1 << (grid.bits + 4);
  return true;
}

PixelBox SnappedTriangle::box(PixelBox limits, double least_offset, double largest_offset) const {
  if (polygon_.corners == 0) return {0, 0, 0, 0};
  Point low = point_[0], high = point_[0];
  for (int n = 1; n < polygon_.corners; ++n) {
    low = {std::min(low.x, point_[n].x), std::min(low.y, point_[n].y)};
    high = {std::max(high.x, point_[n].x), std::max(high.y, point_[n].y)};
  }
  const auto pixels = [this](std::int64_t units) { return static_cast<double>(units) / units_per_pixel_; };  // exact
  const double ox = origin_.x, oy = origin_.y;
  clip_to_reach({pixels(low.x) + ox, pixels(high.x) + ox}, least_offset, largest_offset, &limits.x0, &limits.x1);
  clip_to_reach({pixels(low.y) + oy, pixels(high.y) + oy}, least_offset, largest_offset, &limits.y0, &limits.y1);
  return limits;
}

// Edges that cross the ray from the perturbed sample towards +x, with their direction. Differences of coordinates are
// below 2^31 + 2^18 in magnitude and their products below 2^63; these are compared and not subtracted.
int SnappedTriangle::winding(const Point* corner, int corners, SamplePosition p, TieShift shift) const {
  const auto px = static_cast<std::int64_t>((p.x - origin_.x) * units_per_pixel_);
  const auto py = static_cast<std::int64_t>((p.y - origin_.y) * units_per_pixel_);
  const auto beyond = [&](const Point& a) { return a.y > py || (a.y == py && shift.y < 0); };  // y above the sample's
  int sum = 0;
  for (int n = 0; n < corners; ++n) {
    const Point &from = corner[n], &to = corner[n + 1 < corners ? n + 1 : 0];
    if (beyond(from) == beyond(to)) continue;
    const std::int64_t dx = to.x - from.x, dy = to.y - from.y;
    const std::int64_t left = dx * (py - from.y), right = dy * (px - from.x);  // E(p) = left - right; a = -dy, b = dx
    int sign = left > right ? 1 : left < right ? -1 : 0;
    if (sign == 0) sign = tie_sign(-static_cast<double>(dy), static_cast<double>(dx), shift);
    if (sign == (beyond(to) ? 1 : -1)) sum += sign;
  }
  return sum;
}

bool SnappedTriangle::depth(SamplePosition p, const DrawState& state, float* stored, Rungs* rungs) {
  const DepthMode mode = state.depth_mode;
  know_depth_range();
  const DepthRange& range = depth_range_;
  const bool flat = triangle_.determinant() == 0;
  if (mode == DepthMode::clip) {
    // z clamped to [low, high] is below 0 if high is, or if low and z are; and so for 1.
    if (range.high_below_zero || range.low_above_one) return false;
    if (flat && range.low_below_zero) return false;
    if (!flat && range.low_below_zero && triangle_.compare_depth(p, 0, rungs) < 0) return false;
    if (!flat && range.high_above_one && triangle_.compare_depth(p, 1, rungs) > 0) return false;
  }
  if (state.depth_bias) {
    *stored = biased_depth(p, *state.depth_bias, rungs);
  } else {
    *stored = flat ? range.low : std::clamp(triangle_.rounded_depth(p, rungs), range.low, range.high);
  }
  if (mode == DepthMode::clamp) *stored = std::clamp(*stored, 0.0f, 1.0f);  // rounding is monotonic
  return true;
}

void SnappedTriangle::know_depth_range() {
  if (depth_range_known_) return;
  depth_range_known_ = true;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  depth_range_ = {kInfinity, -kInfinity, false, true, true, false};
  for (int n = 0; n < polygon_.corners; ++n) {
    const DepthFraction z = corner_depth(n);
    widen(z.numerator, z.denominator, &depth_range_);
  }
}

// Z/W of corner n of the polygon.
DepthFraction SnappedTriangle::corner_depth(int n) {
  const GuardCorner& corner = polygon_.corner[n];
  if (corner.guard_x == 0) return {Expansion<60>(corner.z), Expansion<12>(corner.w)};
  const SamplePosition p{origin_.x + kGuardBand * corner.guard_x, origin_.y + kGuardBand * corner.guard_y};
  return {triangle_.exact_depth_numerator(p), triangle_.exact_determinant_value()};
}

// Depth with a bias (I8): the clamped z of G2, without rounding, and then c and s m, whose m is that of the unsnapped
// plane, and 0 where D is.
float SnappedTriangle::biased_depth(SamplePosition p, const DepthBias& bias, Rungs* rungs) {
  const bool flat = triangle_.determinant() == 0;
  DepthFraction low = corner_depth(0), high = low;
  for (int n = 1; n < polygon_.corners; ++n) {
    const DepthFraction z = corner_depth(n);
    if (compare(z, low) < 0) low = z;
    if (compare(z, high) > 0) high = z;
  }
  DepthFraction z = low;
  if (!flat) {
    z = {triangle_.exact_depth_numerator(p), triangle_.exact_determinant_value()};
    const int below = compare(z, low), above = compare(z, high);
    if (below >= 0 && above <= 0) return triangle_.biased_depth(p, bias, rungs);
    z = below < 0 ? low : high;
  }
  count(rungs, &Rungs::values_by_expansion);
  if (flat) {
    Expansion<84> numerator(z.numerator);
    numerator.add_scaled(z.denominator, bias.constant);
    return round_quotient(numerator, z.denominator);
  }
  // (z D + c w D + s m D w) / (w D), for z / w the fraction.
  const Expansion<12>& d = triangle_.exact_determinant_value();
  Expansion<288> denominator, slope;
  denominator.add_product_of(z.denominator, d);
  slope.add_product_of(z.denominator, triangle_.exact_slope_numerator());
  Expansion<1440 + 2 * 288 + 2 * 288> numerator;
  numerator.add_product_of(z.numerator, d);
  numerator.add_scaled(denominator, bias.constant);
  numerator.add_scaled(slope, bias.slope);
  return round_quotient(numerator, denominator);
}

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/exact/line.cpp
namespace surefill_reference {

bool Line::set_up(const Vertex& v0, const Vertex& v1, std::optional<float> width) {
  edge_ = EdgeFunction(v0, v1);
  thin_ = !width.has_value();
  half_ = 0.5 * static_cast<double>(width.value_or(1.0f));
  if ((edge_.a == 0 && edge_.b == 0) || !(v0.w > 0 || v1.w > 0)) return false;
  x_major_ = along_x();
  slope_ = x_major_ ? edge_.b : edge_.a;
  forward_ = x_major_ ? sign_of(edge_.b) : -sign_of(edge_.a);  // S runs along (b, -a)
  end_[0] = {x_major_ ? v0.x : v0.y, v0.w, v0.z}, end_[1] = {x_major_ ? v1.x : v1.y, v1.w, v1.z};
  return true;
}

bool Line::covers(SamplePosition p, TieShift shift, Rungs* rungs) const {
  if (side(p, +1, shift, rungs) < 0 || side(p, -1, shift, rungs) > 0) return false;
  if (!thin_) return within_ends(p, shift);
  return !ends_in_diamond(1, p, shift) && (ends_in_diamond(0, p, shift) || within_ends(p, shift));
}

PixelBox Line::box(PixelBox limits, double least_offset, double largest_offset) const {
  const Vertex &v0 = edge_.from, &v1 = edge_.to;
  const double w[3] = {v0.w, v1.w, v1.w};
  clip_to_reach(widened(reach({v0.x, v1.x, v1.x}, w)), least_offset, largest_offset, &limits.x0, &limits.x1);
  clip_to_reach(widened(reach({v0.y, v1.y, v1.y}, w)), least_offset, largest_offset, &limits.y0, &limits.y1);
  return limits;
}

bool Line::depth(SamplePosition p, DepthMode mode, float* to, Rungs* rungs) const {
  const Mix mix = mix_at(p, end_[0].z, end_[1].z);
  const Approximation q = quotient(mix.sum(), mix.determinant());
  if (mode == DepthMode::clip) {
    const double low = q.value - q.error, high = q.value + q.error;
    if (high < 0 || low > 1) return false;
    if (!(low > 0 && high < 1) && !inside_unit_range(mix)) return false;
  }
  *to = rounded(
      q, [&] { return round_quotient(mix.exact_sum(), mix.exact_determinant()); }, rungs);
  if (mode == DepthMode::clamp) *to = *to < 0 ? 0.0f : *to > 1 ? 1.0f : *to;  // rounding is monotonic
  return true;
}

float Line::attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Rungs* rungs) const {
  if (interpolation == Interpolation::flat) return stored(u[0]);
  if (interpolation == Interpolation::perspective) {
    const Mix mix = mix_at(p, u[0], u[1]);
    return rounded(
        quotient(mix.sum(), mix.weights()), [&] { return round_quotient(mix.exact_sum(), mix.exact_weights()); },
        rungs);
  }
  const Mix mix = mix_at(p, static_cast<double>(u[0]) * end_[0].w, static_cast<double>(u[1]) * end_[1].w);  // 48 bits
  return rounded(
      quotient(mix.sum(), mix.determinant()), [&] { return round_quotient(mix.exact_sum(), mix.exact_determinant()); },
      rungs);
}

bool Line::along_x() const {
  const double a = std::fabs(edge_.a), b = std::fabs(edge_.b);
  if (a != b || edge_.exact) return b >= a;
  const double sa = sign_of(edge_.a), sb = sign_of(edge_.b);
  const double jx = edge_.from.x, jy = edge_.from.y, jw = edge_.from.w;
  const double kx = edge_.to.x, ky = edge_.to.y, kw = edge_.to.w;
  Expansion<4> difference;
  difference.add(sb * (jw * kx)), difference.add(-sb * (jx * kw));
  difference.add(-sa * (jy * kw)), difference.add(sa * (jw * ky));
  return difference.sign() >= 0;
}

int Line::side(SamplePosition p, int s, TieShift shift, Rungs* rungs) const {
  double bound;
  const double value = edge_.value(p, &bound), half = s * std::fabs(slope_) * half_;
  const double estimate = value + half;
  if (std::fabs(estimate) > (bound + 0x1p-50 * std::fabs(half)) * (1 + 0x1p-20) + 0x1p-52 * std::fabs(value)) {
    count(rungs, &Rungs::signs_by_filter);
    return sign_of(estimate);
  }
  count(rungs, &Rungs::signs_by_expansion);
  Expansion<14> exact(edge_.exact_value(p));
  const double factor = s * sign_of(slope_) * half_;
  const double jx = edge_.from.x, jy = edge_.from.y, jw = edge_.from.w;
  const double kx = edge_.to.x, ky = edge_.to.y, kw = edge_.to.w;
  exact.add_product(x_major_ ? jw * kx : jy * kw, factor);
  exact.add_product(x_major_ ? -(jx * kw) : -(jw * ky), factor);
  return exact.sign() != 0 ? exact.sign() : tie_sign(edge_.a, edge_.b, shift);
}

bool Line::ends_in_diamond(int i, SamplePosition p, TieShift shift) const {
  const Vertex& v = i == 0 ? edge_.from : edge_.to;
  if (!(v.w > 0)) return false;
  const double w = v.w, half = 0.5 * w;
  const double u = std::fabs(v.x - p.x * w) + std::fabs(v.y - p.y * w);  // three roundings; the products are exact
  if (std::fabs(u - half) > 0x1p-50 * (u + half)) return u < half;
  for (const int sx : {-1, 1}) {
    for (const int sy : {-1, 1}) {
      Expansion<5> exact;
      exact.add(sx * static_cast<double>(v.x)), exact.add(-sx * (p.x * w));
      exact.add(sy * static_cast<double>(v.y)), exact.add(-sy * (p.y * w));
      exact.add(-half);
      const int moved = shift.y_dominates ? -sy * shift.y : -sx * shift.x;
      if ((exact.sign() != 0 ? exact.sign() : moved) > 0) return false;
    }
  }
  return true;
}

Reach Line::widened(Reach r) const {
  const double low = r.low - half_, high = r.high + half_;
  return {low - 0x1p-50 * (std::fabs(low) + half_), high + 0x1p-50 * (std::fabs(high) + half_)};
}

Line::Mix Line::mix_at(SamplePosition p, double v0, double v1) const {
  const double t = along(p), tw0 = t * end_[0].w, tw1 = t * end_[1].w;  // exact: 27 and 24 bits
  // The determinant t_0 W_1 - t_1 W_0 has the sign of -forward, n_0 = t W_1 - t_1, n_1 = t_0 - t W_0.
  const int n0 = sign_of(tw1 - end_[1].t), n1 = sign_of(end_[0].t - tw0);
  if (end_[0].w > 0 && n1 * forward_ > 0) return {{1, 0}, {0, 0}, {end_[0].w, 0}, {v0, v1}};
  if (end_[1].w > 0 && n0 * forward_ > 0) return {{0, 1}, {0, 0}, {end_[1].w, 0}, {v0, v1}};
  return {{tw1, end_[0].t}, {end_[1].t, tw0}, {end_[0].t * end_[1].w, end_[1].t * end_[0].w}, {v0, v1}};
}

bool Line::inside_unit_range(const Mix& mix) {
  const Expansion<8> sum = mix.exact_sum();
  const Expansion<2> determinant = mix.exact_determinant();
  if (sum.sign() * determinant.sign() < 0) return false;
  Expansion<10> rest(sum);
  rest.add(-determinant.term(0));
  if (determinant.size() > 1) rest.add(-determinant.term(1));
  return rest.sign() * determinant.sign() <= 0;
}

Line::DepthAlong Line::depth_along() const {
  const double t0 = end_[0].t, w0 = end_[0].w, z0 = end_[0].z, t1 = end_[1].t, w1 = end_[1].w, z1 = end_[1].z;
  const double determinant = t0 * w1 - t1 * w0;  // each difference is of exact products
  const double start = (t0 * z1 - t1 * z0) / determinant;
  return {(w1 * z0 - w0 * z1) / determinant, start, 0x1p-50 * std::fabs(start)};
}

Reach Line::reach_of_ends() const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto place = [](const End& end, double without) { return end.w > 0 ? end.t / end.w : without; };
  if (forward_ > 0) return {place(end_[0], -kInfinity), place(end_[1], kInfinity)};
  return {place(end_[1], -kInfinity), place(end_[0], kInfinity)};
}

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/exact/exact_draw.cpp
namespace surefill_reference {

int orientation(const Draw& draw, std::uint32_t position, Rungs* rungs) {
  const EdgeFunction edge(vertex_of(draw, position, 1), vertex_of(draw, position, 2));
  return determinant_sign(edge, vertex_of(draw, position, 0), rungs);
}

bool is_degenerate(const Draw& draw, std::uint32_t position) {
  if (!draw.grid) return draw.conservative != Conservative::touched;  // M4b
  Triangle triangle;
  triangle.set_up(vertex_of(draw, position, 0), vertex_of(draw, position, 1), vertex_of(draw, position, 2));
  return hull_contains_eye(triangle);
}

bool ExactDraw::use(const Draw& draw, std::uint32_t position, Rungs* rungs) {
  if (draw_ == &draw && position_ == position) return covers_something_;
  draw_ = &draw, position_ = position;
  if (!has_triangles(draw)) {
    const Vertex& v = vertex_of(draw, position, 0);
    covers_something_ = is_line() ? line_.set_up(v, vertex_of(draw, position, 1), draw.width)
                                  : point_.set_up(v, draw.width.value_or(1.0f));
    return covers_something_;
  }
  const Vertex &v0 = vertex_of(draw, position, 0), &v1 = vertex_of(draw, position, 1),
               &v2 = vertex_of(draw, position, 2);
  covers_something_ = draw.grid ? snapped_.set_up(v0, v1, v2, *draw.grid, rungs, origin_)
                                : triangle_.set_up(v0, v1, v2, rungs) || draw.conservative == Conservative::touched;
  return covers_something_;
}

PixelBox ExactDraw::box(const PixelBox& limits, double least_offset, double largest_offset) const {
  if (!has_triangles(*draw_)) {
    return is_line() ? line_.box(limits, least_offset, largest_offset)
                     : point_.box(limits, least_offset, largest_offset);
  }
  if (draw_->grid) return snapped_.box(limits, least_offset, largest_offset);
  const bool squares = draw_->conservative != Conservative::none;
  return screen_box(triangle_.vertex(0), triangle_.vertex(1), triangle_.vertex(2), limits, squares ? 0 : least_offset,
                    squares ? 1 : largest_offset);
}

bool ExactDraw::draws_square(int x, int y, Rungs* rungs) const {
  if (triangle_.determinant() == 0) return degenerate_touches(triangle_, x, y);
  const PixelSquare square(triangle_, x, y, rungs);
  switch (draw_->conservative) {
    case Conservative::inner:
      return square.inside();
    case Conservative::overlap:
      return square.overlapped();
    default:
      return square.touched();
  }
}

bool ExactDraw::depth(SamplePosition p, float* stored, Rungs* rungs) {
  if (!has_triangles(*draw_)) {
    return is_line() ? line_.depth(p, draw_->depth_mode, stored, rungs) : point_.depth(draw_->depth_mode, stored);
  }
  return draw_->grid ? snapped_.depth(p, *draw_, stored, rungs) : triangle_.depth(p, *draw_, stored, rungs);
}

bool ExactDraw::has_values(SamplePosition p) const {
  if (!has_triangles(*draw_)) return true;  // I6, I7: everywhere
  return draw_->grid ? snapped_.has_weights(p) : triangle_.plane_in_front(p);
}

SamplePosition ExactDraw::place_of_attributes(const Target& target, int x, int y, TieShift shift) const {
  const SamplePosition centre{x + 0.5, y + 0.5};
  if (target.samples == 1) return place_of_sample(target, x, y, 0);
  if (target.attribute_location == AttributeLocation::centre && has_values(centre)) return centre;
  if (covers(centre, shift)) return centre;
  for (int n = 0; n < target.samples; ++n) {
    const SamplePosition p = place_of_sample(target, x, y, n);
    if (covers(p, shift)) return p;
  }
  return centre;  // not reached: the triangle is seen at a sample of this pixel
}

float ExactDraw::attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Rungs* rungs) {
  if (!has_triangles(*draw_)) return is_line() ? line_.attribute(p, u, interpolation, rungs) : surefill_reference::stored(u[0]);
  return draw_->grid ? snapped_.attribute(p, u, interpolation, rungs) : triangle_.attribute(p, u, interpolation, rungs);
}

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/fragments.cpp
namespace surefill_reference {

bool Layers::allocate(const Target& target, bool named) {
  total_ = sample_total(target), layers_ = static_cast<std::size_t>(target.layers);
  depth_ = target.depth.data();
  if (target.depth.empty()) {
    own_depth_.reset(new (std::nothrow) float[size()]);
    depth_ = own_depth_.get();
  }
  if (depth_ == nullptr) return false;
  if (named) {
    draw_.reset(new (std::nothrow) std::uint32_t[size()]);
    position_.reset(new (std::nothrow) std::uint32_t[size()]);
    if (draw_ == nullptr || position_ == nullptr) return false;
    std::fill(draw_.get(), draw_.get() + size(), kNoDraw);
  }
  for (float* layer = depth_; layer < depth_ + size(); layer += total_) {
    if (target.initial_depth.empty()) {
      std::fill(layer, layer + total_, empty_depth(target.depth_test));
    } else if (target.initial_depth.data() != layer) {
      std::memcpy(layer, target.initial_depth.data(), total_ * sizeof(float));
    }
  }
  return true;
}

void Layers::insert(std::size_t place, std::uint32_t draw, std::uint32_t position, float z) {
  for (std::size_t to = place % total_ + (layers_ - 1) * total_; to > place; to -= total_) {
    if (draw_ != nullptr) put(to, draw_[to - total_], position_[to - total_]);
    depth_[to] = depth_[to - total_];
  }
  replace(place, draw, position, z);
}

bool DrawFragments::counts(Fragment& f) {
  if (draw_.conservative != Conservative::none) {
    return triangle_.draws_square(target_.origin.x + f.x, target_.origin.y + f.y, &rungs_);
  }
  const SamplePosition p = place_of(f);
  if (!triangle_.draws(p, shift_, &rungs_)) return false;
  if (layers_ == nullptr && draw_.depth_mode != DepthMode::clip) return true;
  return triangle_.depth(p, &f.z, &rungs_);
}

bool DrawFragments::counts_of_covered(Fragment& f) {
  if (draw_.conservative == Conservative::overlap) return counts(f);
  return layers_ == nullptr || triangle_.depth(place_of(f), &f.z, &rungs_);
}

void DrawFragments::take_all(const Fragment& f) {
  const std::size_t s = sample_index(target_, f.x, f.y, static_cast<std::size_t>(f.n));
  if (!target_.count.empty()) ++target_.count[s];
  if (!draw_.covered.empty()) {  // the triangle may be met on other threads too
    std::atomic_ref(draw_.covered[f.position]).fetch_add(1, std::memory_order_relaxed);
  }
  if (!target_.winding.empty() && has_triangles(draw_)) {  // M9, modulo 2^32
    const std::uint32_t one = triangle_.is_front(place_of(f), shift_, &rungs_) ? 1u : 0xFFFFFFFFu;
    target_.winding[s] = static_cast<std::int32_t>(static_cast<std::uint32_t>(target_.winding[s]) + one);
  }
  if (layers_ != nullptr) {
    see(f, s);
  } else if (!target_.index.empty()) {  // M4c: kNoTriangle is larger than any index
    target_.index[s] = std::min(target_.index[s], index_of(draw_, f.position));
  }
}

void DrawFragments::see(const Fragment& f, std::size_t s) {
  if (!draw_.depth_write) {  // M5: one layer, whose depth stays
    if (passes(f.z, s) && (layers_->draw(s) != number_ || index_at(s) <= index_of(draw_, f.position))) {
      layers_->put(s, number_, f.position);
    }
    return;
  }
  for (std::size_t place = s; place < layers_->size(); place += layers_->total()) {
    if (!precedes(f, place)) continue;
    layers_->insert(place, number_, f.position, f.z);
    return;
  }
}

// The depth test (V1, V5).
bool DrawFragments::passes(float z, std::size_t place) const {
  const float there = layers_->depth(place);
  return (is_reversed(target_.depth_test) ? z > there : z < there) || (z == there && takes_equal(target_.depth_test));
}

// Does the fragment come before what is there (V1 to V5)? Of equal depths in one draw indices decide, and of equal
// indices positions, in whose order fragments come.
bool DrawFragments::precedes(const Fragment& f, std::size_t place) const {
  if (f.z != layers_->depth(place) || layers_->draw(place) != number_) return passes(f.z, place);
  const std::uint32_t index = index_of(draw_, f.position);
  return takes_equal(target_.depth_test) ? index >= index_at(place) : index < index_at(place);
}

void DrawFragments::shade(std::uint32_t position, int x, int y, std::size_t place) {
  triangle_.use(draw_, position, &rungs_);
  const SamplePosition p = triangle_.place_of_attributes(target_, target_.origin.x + x, target_.origin.y + y, shift_);
  if (!target_.barycentrics.empty()) {
    for (std::size_t i = 0; i < 3; ++i) {
      const float unit[3] = {i == 0 ? 1.0f : 0.0f, i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f};
      target_.barycentrics[3 * place + i] = triangle_.attribute(p, unit, Interpolation::perspective, &rungs_);
    }
  }
  for (std::size_t k = 0; k < target_.attributes.size(); ++k) {
    const AttributeTarget& out = target_.attributes[k];
    if (out.values.empty()) continue;
    const AttributeArray& in = draw_.attributes[k];
    for (std::size_t c = 0; c < out.components; ++c) {
      float u[3] = {};
      for (std::size_t i = 0; i < corners_of(draw_); ++i)
        u[i] = in.values[vertex_index(draw_, position, i) * stride_of(in) + c];
      out.values[place * stride_of(out) + c] = triangle_.attribute(p, u, in.interpolation, &rungs_);
    }
  }
}

namespace {

// The empty image (V1), without depth.
void clear(const Target& target) {
  std::fill(target.count.begin(), target.count.end(), 0u);
  std::fill(target.winding.begin(), target.winding.end(), 0);
  std::fill(target.index.begin(), target.index.end(), kNoTriangle);
  std::fill(target.barycentrics.begin(), target.barycentrics.end(), 0.0f);
  for (const AttributeTarget& attribute : target.attributes) {
    const std::size_t samples = static_cast<std::size_t>(target.layers) * sample_total(target);
    for (std::size_t s = 0; s < samples && !attribute.values.empty(); ++s)
      std::fill_n(&attribute.values[s * stride_of(attribute)], attribute.components, 0.0f);
  }
}

// Attributes are evaluated once per pixel (M1).
void copy_shading(const Target& target, std::size_t from, std::size_t to) {
  if (!target.barycentrics.empty()) {
    for (std::size_t i = 0; i < 3; ++i) target.barycentrics[3 * to + i] = target.barycentrics[3 * from + i];
  }
  for (const AttributeTarget& out : target.attributes) {
    if (out.values.empty()) continue;
    for (std::size_t c = 0; c < out.components; ++c) {
      out.values[to * stride_of(out) + c] = out.values[from * stride_of(out) + c];
    }
  }
}

}  // namespace

FragmentFrame::FragmentFrame(const Target& target, std::span<const Draw> draws)
    : target_(target), draws_(draws), wanted_(wanted_outputs(target)) {
  bool conservative = false;
  for (const Draw& draw : draws) {
    conservative = conservative || draw.conservative != Conservative::none;
    visible_ = visible_ || !draw.visible.empty();
  }
  seen_ = !conservative && (wanted_.depth || visible_);  // M4c's index is of nobody that is seen
}

bool FragmentFrame::begin() {
  if (seen_ && !layers_.allocate(target_, wanted_.visibility || visible_)) return false;
  clear(target_);
  for (const Draw& draw : draws_) {
    std::fill(draw.covered.begin(), draw.covered.end(), 0u);
    std::fill(draw.visible.begin(), draw.visible.end(), 0u);
  }
  return true;
}

void FragmentFrame::finish(Rungs& rungs) {
  if (!seen_ || !(wanted_.visibility || visible_)) return;
  for (std::size_t d = 0; d < draws_.size(); ++d) show(static_cast<std::uint32_t>(d), rungs);
}

// What one draw shows, once all are drawn.
void FragmentFrame::show(std::uint32_t number, Rungs& rungs) {
  const Draw& draw = draws_[number];
  const auto samples = static_cast<std::size_t>(target_.samples), width = static_cast<std::size_t>(target_.width);
  DrawFragments fragments(target_, draw, number, nullptr, rungs);
  for (std::size_t place = 0; place < layers_.size(); ++place) {
    if (layers_.draw(place) != number) continue;
    const std::uint32_t position = layers_.position(place);
    if (place < layers_.total() && !draw.visible.empty()) ++draw.visible[position];
    if (!target_.index.empty()) target_.index[place] = index_of(draw, position);
    if (!wanted_.shading) continue;
    const std::size_t s = place % layers_.total();
    if (s % samples != 0 && layers_.draw(place - 1) == number && layers_.position(place - 1) == position) {
      copy_shading(target_, place - 1, place);
    } else {
      fragments.shade(position, static_cast<int>(s / samples % width), static_cast<int>(s / samples / width), place);
    }
  }
}

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/surefill.cpp
//
// The public calls: check the arguments, set the floating-point state, take the path.



namespace surefill_reference {
namespace {

// The standard sample locations of Direct3D 11 and Vulkan (S4), in 1/16 pixel.
constexpr SampleLocation kLocations1[] = {{8, 8}};
constexpr SampleLocation kLocations2[] = {{12, 12}, {4, 4}};
constexpr SampleLocation kLocations4[] = {{6, 2}, {14, 6}, {2, 10}, {10, 14}};
constexpr SampleLocation kLocations8[] = {{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}};
constexpr SampleLocation kLocations16[] = {{9, 9},  {7, 5}, {5, 10}, {12, 7}, {3, 6}, {10, 13}, {13, 11}, {11, 3},
                                           {6, 14}, {8, 1}, {4, 2},  {2, 12}, {0, 8}, {15, 4},  {14, 15}, {1, 0}};

// Does somebody ask for an output of samples or of triangles?
bool asks_for_outputs(const Target& target, std::span<const Draw> draws) {
  const bool numbers = std::any_of(draws.begin(), draws.end(),
                                   [](const Draw& draw) { return !draw.covered.empty() || !draw.visible.empty(); });
  return wanted_outputs(target).depth || !target.count.empty() || !target.winding.empty() || numbers;
}

// Neither is inlined: they need the engine's floating-point state.
[[gnu::noinline]] Status draw(const Target& target, std::span<const Draw> draws,
                              [[maybe_unused]] const Options& options, Diagnostics& diagnostics) {
  diagnostics.path = "reference";
  return reference::render(target, draws, diagnostics.rungs);
}

[[gnu::noinline]] Status visit(const Target& target, std::span<const Draw> draws, const CoverageVisitor& visitor,
                               [[maybe_unused]] const Options& options, Diagnostics& diagnostics) {
  diagnostics.path = "reference";
  return reference::visit_coverage(target, draws, visitor, diagnostics.rungs);
}

// What is asked for beside the image.
[[gnu::noinline]] void report(std::span<const Draw> draws, Statistics* statistics, const Options& options,
                              const Diagnostics& diagnostics) {
  if (statistics != nullptr) *statistics = statistics_of(draws);
  if (options.diagnostics != nullptr) *options.diagnostics = diagnostics;
}

}  // namespace

Context::Context() noexcept = default;

Context::~Context() {
}

SampleLocation sample_location(int samples, int n) noexcept {
  if (n < 0 || n >= samples) n = 0;
  switch (samples) {
    case 2:
      return kLocations2[n];
    case 4:
      return kLocations4[n];
    case 8:
      return kLocations8[n];
    case 16:
      return kLocations16[n];
    default:
      return kLocations1[0];
  }
}

Status render(const Target& target, std::span<const Draw> draws, Statistics* statistics) noexcept {
  return render(target, draws, statistics, {});
}

Status render(const Target& target, std::span<const Draw> draws, Statistics* statistics,
              const Options& options) noexcept {
  if (!is_exact_build()) return Status::bad_build;
  if (const Status status = check_call(target, draws, statistics, options); status != Status::ok) return status;
  FloatEnvironment environment;
  CallersCode callers{environment, options.executor, {}};
  Diagnostics diagnostics;
  const Status status = draw(target, draws, callers.with_executor(options), diagnostics);
  if (status == Status::ok) report(draws, statistics, options, diagnostics);
  return status;
}

Status visit_coverage(const Target& target, std::span<const Draw> draws, const CoverageVisitor& visitor,
                      Statistics* statistics, const Options& options) noexcept {
  if (!is_exact_build()) return Status::bad_build;
  if (const Status status = check_call(target, draws, statistics, options); status != Status::ok) return status;
  if (asks_for_outputs(target, draws) || target.layers != 1) return Status::target_outputs;
  if (visitor.visit == nullptr) return Status::visitor;
  FloatEnvironment environment;
  CallersCode callers{environment, options.executor, visitor};
  Diagnostics diagnostics;
  const Status status =
      visit(target, draws, {CallersCode::visit_blocks, &callers}, callers.with_executor(options), diagnostics);
  if (status == Status::ok) report(draws, statistics, options, diagnostics);
  return status;
}

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/arguments.cpp
//
// B2: every argument is checked before anything is written.



namespace surefill_reference {
namespace {

constexpr std::uint64_t kLargestIndex = std::numeric_limits<std::uint32_t>::max();

template <typename T>
bool null_but_not_empty(std::span<T> s) {
  return s.data() == nullptr && !s.empty();
}

// Empty (not asked for), or a buffer of exactly `size` elements. Sizes are computed in 64 bits, whatever std::size_t has.
template <typename T>
bool fits(std::span<T> buffer, std::uint64_t size) {
  return buffer.empty() || (buffer.data() != nullptr && buffer.size() == size);
}

bool size_ok(const Target& target) {
  const auto good = [](int size) { return size >= 1 && size <= kMaxTargetSize; };
  return good(target.width) && good(target.height);
}

bool samples_ok(const Target& target) {
  const int n = target.samples;
  return n == 1 || n == 2 || n == 4 || n == 8 || n == 16;
}

// Of a target whose size and samples are good: at most 2^32.
std::uint64_t samples_of(const Target& target) {
  return static_cast<std::uint64_t>(target.width) * static_cast<std::uint64_t>(target.height) *
         static_cast<std::uint64_t>(target.samples);
}

bool layers_ok(const Target& target) {
  return target.layers >= 1 && target.layers <= kMaxLayers;
}

bool origin_ok(const Target& target) {
  const auto good = [](int place) { return place >= -kMaxOrigin && place <= kMaxOrigin; };
  return good(target.origin.x) && good(target.origin.y);
}

bool locations_ok(const Target& target) {
  const auto good = [](int place) { return place >= 0 && place <= 15; };
  if (!fits(target.sample_locations, static_cast<std::uint64_t>(target.samples))) return false;
  for (const SampleLocation& location : target.sample_locations) {
    if (!good(location.x) || !good(location.y)) return false;
  }
  return true;
}

// Of a good number of components.
bool fits(const AttributeTarget& image, std::uint64_t samples) {
  const std::uint64_t stride = stride_of(image), components = image.components, size = image.values.size();
  if (stride <= components) return stride == components && fits(image.values, components * samples);
  if (null_but_not_empty(image.values)) return false;
  // Of up to 2^36 samples and 2^32 - 1 floats each, the product is compared as a quotient.
  return size == 0 || (size >= components && (size - components) / stride >= samples - 1);
}

Status validate_target(const Target& target, Outputs& outputs) {
  if (!size_ok(target)) return Status::target_size;
  if (!samples_ok(target)) return Status::target_samples;
  if (!layers_ok(target)) return Status::target_layers;
  if (!origin_ok(target)) return Status::target_origin;
  if (!locations_ok(target)) return Status::target_sample_locations;
  const std::uint64_t total = samples_of(target), in_layers = static_cast<std::uint64_t>(target.layers) * total;
  if (!fits(target.count, total)) return Status::target_count;
  if (!fits(target.winding, total)) return Status::target_winding;
  if (!fits(target.index, in_layers)) return Status::target_index;
  if (!fits(target.depth, in_layers)) return Status::target_depth;
  if (!fits(target.barycentrics, 3 * in_layers)) return Status::target_barycentrics;
  if (null_but_not_empty(target.attributes) || target.attributes.size() > kMaxAttributes)
    return Status::target_attributes;
  for (const AttributeTarget& attribute : target.attributes) {
    if (attribute.components < 1 || attribute.components > kMaxComponents) return Status::target_attributes;
    if (!fits(attribute, in_layers)) return Status::target_attributes;
  }
  if (!fits(target.initial_depth, total)) return Status::target_initial_depth;
  if (target.depth_test > DepthTest::greater_equal) return Status::target_depth_test;
  if (target.attribute_location > AttributeLocation::centroid) return Status::target_attribute_location;

  // The initial depth may be the depth buffer itself, of one layer, but not overlap it otherwise.
  const bool same = target.layers == 1 && !target.depth.empty() && target.initial_depth.data() == target.depth.data();
  const bool apart = outputs.add_buffers(target) && (same || !outputs.touched_by(Bytes(target.initial_depth))) &&
                     !outputs.touched_by(Bytes(target.attributes)) && !outputs.touched_by(Bytes::of(&target)) &&
                     !outputs.touched_by(Bytes(target.sample_locations));
  return apart ? Status::ok : Status::target_overlap;
}

Status validate_attributes(const Target& target, const Draw& draw) {
  if (null_but_not_empty(draw.attributes) || draw.attributes.size() > kMaxAttributes ||
      draw.attributes.size() < target.attributes.size()) {
    return Status::draw_attributes;
  }
  for (std::size_t k = 0; k < draw.attributes.size(); ++k) {
    const AttributeArray& attribute = draw.attributes[k];
    if (attribute.components < 1 || attribute.components > kMaxComponents) return Status::draw_attributes;
    if (k < target.attributes.size() && attribute.components != target.attributes[k].components) {
      return Status::draw_attributes;
    }
    if (attribute.stride != 0 && attribute.stride < attribute.components) return Status::draw_attributes;
    const std::uint64_t stride = stride_of(attribute);
    // Below 2^32 vertices and strides, so nothing overflows.
    const std::uint64_t needed = draw.vertices.empty() ? 0 : (draw.vertices.size() - 1) * stride + attribute.components;
    if (null_but_not_empty(attribute.values) || attribute.values.size() < needed) return Status::draw_attributes;
    if (attribute.interpolation > Interpolation::flat) return Status::draw_attribute_interpolation;
  }
  return Status::ok;
}

// B5. Without an early end, so that it is vector code.
bool has_no_triangle(std::span<const std::uint32_t> identifiers) {
  bool found = false;
  for (const std::uint32_t identifier : identifiers) found |= identifier == kNoTriangle;
  return found;
}

// Does every index name a vertex? First by signs, which is vector code on every processor: of up to 2^31 vertices an
// index is in range if it and its distance to the last are below 2^31. What that does not settle, the largest does.
bool indices_in_range(const Draw& draw) {
  const auto last = static_cast<std::uint32_t>(draw.vertices.size() - 1);
  std::uint32_t signs = 0, largest = 0;
  for (const std::uint32_t index : draw.indices) signs |= index | (last - index);
  if (signs >> 31 == 0) return true;
  for (const std::uint32_t index : draw.indices) largest = std::max(largest, index);
  return draw.indices.empty() || largest < draw.vertices.size();
}

Status validate_draw(const Target& target, const Draw& draw, const Outputs& outputs) {
  if (draw.primitive > Primitive::points) return Status::draw_primitive;
  const std::uint64_t vertices = draw.vertices.size(), triangles = triangles_of(draw);
  if (null_but_not_empty(draw.vertices) || vertices > kLargestIndex) return Status::draw_vertices;
  if (null_but_not_empty(draw.indices) || draw.indices.size() % corners_of(draw) != 0 || triangles >= kLargestIndex) {
    return Status::draw_indices;
  }
  if (!draw.identifiers.empty() && (draw.identifiers.data() == nullptr || draw.identifiers.size() != triangles)) {
    return Status::draw_identifiers;
  }
  if (has_no_triangle(draw.identifiers)) return Status::draw_identifiers;
  if (draw.identifiers.empty() && triangles > kLargestIndex - draw.first_index) return Status::draw_first_index;
  if (const Status status = validate_attributes(target, draw); status != Status::ok) return status;
  const bool needs_step = draw.grid || !has_triangles(draw);
  if (draw.fill_rule > FillRule::open || (needs_step && !moves_samples(draw.fill_rule))) return Status::draw_fill_rule;
  if (draw.front_face > FrontFace::counter_clockwise) return Status::draw_front_face;
  if (draw.cull > Cull::back) return Status::draw_cull;
  if (draw.depth_mode > DepthMode::clamp) return Status::draw_depth_mode;
  if (draw.grid) {
    const Grid& grid = *draw.grid;
    const auto offset_ok = [](int offset) { return offset >= 0 && offset <= 15; };
    if (grid.bits < 0 || grid.bits > 12 || !offset_ok(grid.offset_x) || !offset_ok(grid.offset_y) ||
        grid.rounding > GridRounding::truncate || !has_triangles(draw)) {
      return Status::draw_grid;
    }
  }
  if (draw.depth_bias &&
      !(std::isfinite(draw.depth_bias->constant) && std::isfinite(draw.depth_bias->slope) && has_triangles(draw))) {
    return Status::draw_depth_bias;
  }
  if (draw.width && !(std::isfinite(*draw.width) && *draw.width > 0)) return Status::draw_width;
  if (draw.primitive == Primitive::lines && !draw.width && target.samples != 1) return Status::draw_width;
  if (target.layers > 1 && !draw.depth_write) return Status::target_layers;
  if (draw.conservative > Conservative::touched) return Status::draw_conservative;
  if (draw.conservative != Conservative::none) {
    const Wanted wanted = wanted_outputs(target);
    if (wanted.shading || !target.depth.empty() || !target.winding.empty() || target.samples != 1 ||
        draw.depth_mode != DepthMode::none || draw.grid || !has_triangles(draw)) {
      return Status::draw_conservative;
    }
    if (target.layers > 1) return Status::target_layers;
    if (!target.sample_locations.empty()) return Status::target_sample_locations;
  }
  if (!fits(draw.covered, triangles)) return Status::draw_covered;
  if (!fits(draw.visible, triangles)) return Status::draw_visible;
  bool apart = !outputs.touched_by(Bytes(draw.vertices)) && !outputs.touched_by(Bytes(draw.indices)) &&
               !outputs.touched_by(Bytes(draw.identifiers)) && !outputs.touched_by(Bytes(draw.attributes));
  for (const AttributeArray& attribute : draw.attributes) apart = apart && !outputs.touched_by(Bytes(attribute.values));
  if (!apart) return Status::target_overlap;
  return indices_in_range(draw) ? Status::ok : Status::draw_index_out_of_range;
}

// M10: is it a frame whose conservative draws may have these outputs, and are they apart from each other?
Status validate_numbers(std::span<const Draw> draws) {
  const bool conservative =
      std::any_of(draws.begin(), draws.end(), [](const Draw& draw) { return draw.conservative != Conservative::none; });
  for (std::size_t d = 0; d < draws.size(); ++d) {
    const Bytes covered(draws[d].covered), visible(draws[d].visible);
    if (conservative && !draws[d].visible.empty()) return Status::draw_visible;
    if (covered.overlaps(visible)) return Status::target_overlap;
    const std::span<const Draw> before = draws.first(covered.empty() && visible.empty() ? 0 : d);
    for (const Draw& other : before) {
      const Bytes theirs[] = {Bytes(other.covered), Bytes(other.visible)};
      for (const Bytes& bytes : theirs) {
        if (covered.overlaps(bytes) || visible.overlaps(bytes)) return Status::target_overlap;
      }
    }
  }
  return Status::ok;
}

Status validate_frame(const Target& target, std::span<const Draw> draws, Outputs& outputs) {
  const bool null = null_but_not_empty(draws);
  if (!null) outputs.add_numbers(draws);
  if (const Status status = validate_target(target, outputs); status != Status::ok) return status;
  if (null) return Status::draws;
  if (outputs.touched_by(Bytes(draws))) return Status::target_overlap;
  for (const Draw& draw : draws) {
    if (const Status status = validate_draw(target, draw, outputs); status != Status::ok) return status;
  }
  return outputs.has_numbers() ? validate_numbers(draws) : Status::ok;
}

}  // namespace

std::size_t sample_total(const Target& target) noexcept {
  if (!size_ok(target) || !samples_ok(target)) return 0;
  const std::uint64_t largest = std::numeric_limits<std::size_t>::max();
  return static_cast<std::size_t>(std::min(samples_of(target), largest));  // no buffer has so many elements
}

Status validate(const Target& target, std::span<const Draw> draws) noexcept {
  Outputs outputs;
  return validate_frame(target, draws, outputs);
}

Status check_call(const Target& target, std::span<const Draw> draws, const Statistics* statistics,
                  const Options& options) noexcept {
  if (options.threads < 1 || options.threads > kMaxThreads) return Status::options_threads;
  if (options.path > Path::reference) return Status::options_path;
  Outputs outputs;
  outputs.add(Bytes::of(statistics));
  if (!outputs.add(Bytes::of(options.diagnostics))) return Status::target_overlap;
  if (const Status status = validate_frame(target, draws, outputs); status != Status::ok) return status;
  const bool touched = outputs.touched_by(Bytes::of(&options)) || outputs.touched_by(Bytes::of(options.context)) ||
                       outputs.numbers_touch(Bytes::of(statistics)) ||
                       outputs.numbers_touch(Bytes::of(options.diagnostics));
  return touched ? Status::target_overlap : Status::ok;
}

const char* status_text(Status status) noexcept {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::out_of_memory:
      return "out of memory";
    case Status::target_size:
      return "the target's width or height is outside 1..16384";
    case Status::target_samples:
      return "the target's samples are not 1, 2, 4, 8 or 16";
    case Status::target_count:
      return "the count buffer's size is not that of the target";
    case Status::target_index:
      return "the index buffer's size is not that of the target's layers";
    case Status::target_depth:
      return "the depth buffer's size is not that of the target's layers";
    case Status::target_barycentrics:
      return "the barycentrics buffer's size is not 3 floats for each sample of the target's layers";
    case Status::target_attributes:
      return "an attribute target has components outside 1..4, a wrong size or stride, or there are over 16";
    case Status::target_initial_depth:
      return "the initial depth's size is not that of the target";
    case Status::target_overlap:
      return "an output overlaps another one, or a buffer, list or struct that the call reads";
    case Status::target_depth_test:
      return "the depth test is not an enumerator of DepthTest";
    case Status::target_attribute_location:
      return "the attribute location is not an enumerator of AttributeLocation";
    case Status::draws:
      return "the list of draws is null but not empty";
    case Status::draw_vertices:
      return "a draw's vertex buffer is null or too large";
    case Status::draw_indices:
      return "a draw's indices are null, no multiple of 3 (of lines: of 2), or too many";
    case Status::draw_index_out_of_range:
      return "a draw has an index that names no vertex";
    case Status::draw_identifiers:
      return "a draw's identifiers are neither empty nor one for each triangle, or one is 2^32 - 1";
    case Status::draw_first_index:
      return "a draw's first index plus its triangles exceed 2^32 - 1";
    case Status::draw_attributes:
      return "a draw's attribute arrays are too few, too short, or have other components than the target";
    case Status::draw_attribute_interpolation:
      return "an attribute's interpolation is not an enumerator of Interpolation";
    case Status::draw_fill_rule:
      return "a draw's fill rule is not an enumerator of FillRule, or is closed or open with a grid, lines or points";
    case Status::draw_front_face:
      return "a draw's front face is not an enumerator of FrontFace";
    case Status::draw_cull:
      return "a draw's culling is not an enumerator of Cull";
    case Status::draw_depth_mode:
      return "a draw's depth mode is not an enumerator of DepthMode";
    case Status::draw_conservative:
      return "a draw's conservative mode is not an enumerator of Conservative, or the frame has more than count and "
             "index, several samples, a depth mode, a grid, lines or points";
    case Status::draw_grid:
      return "a draw's grid has bits outside 0..12, an offset outside 0..15 or an unknown rounding, or is of lines or "
             "points";
    case Status::viewport:
      return "a number of the viewport is not finite, or an enumerator is unknown";
    case Status::options_threads:
      return "the number of threads is outside 1..256";
    case Status::options_path:
      return "the path is not an enumerator of Path";
    case Status::query_boxes:
      return "the boxes or rectangles of the query are null or hold a number that is not finite";
    case Status::query_answers:
      return "the answers of the query are null or not one for each box";
    case Status::visitor:
      return "the visitor's function is null";
    case Status::bad_build:
      return "the library was compiled with options that break exact arithmetic, such as -ffast-math or FMA "
             "contraction";
    case Status::to_pixel_vertices:
      return "to_pixel's vertices or results are null, not equally many, or overlap what the call reads";
    case Status::target_outputs:
      return "the target of visit_coverage asks for an output or for layers";
    case Status::target_origin:
      return "the target's origin is outside -4194304..4194304";
    case Status::target_sample_locations:
      return "the sample locations are neither empty nor one for each sample, one is outside 0..15, or a draw is "
             "conservative";
    case Status::target_layers:
      return "the layers are outside 1..16, or above 1 with a draw that is conservative or writes no depth";
    case Status::target_winding:
      return "the winding buffer's size is not that of the target";
    case Status::draw_depth_bias:
      return "a draw's depth bias is not finite, or is of lines or points";
    case Status::draw_covered:
      return "a draw's covered numbers are neither empty nor one for each triangle";
    case Status::draw_visible:
      return "a draw's visible numbers are neither empty nor one for each triangle, or a draw is conservative";
    case Status::draw_primitive:
      return "a draw's primitive is not an enumerator of Primitive";
    case Status::draw_width:
      return "a draw's width is not finite and above 0, or its lines have none where there are several samples";
    case Status::draw_scissor:
      return "an occluder of a safe buffer has a scissor";
    case Status::draw_depth_write:
      return "an occluder of a safe buffer has depth write off";
    case Status::occluder_positions:
      return "an occluder mesh's positions are null, too many, incomplete, or less than 3 floats apart";
    case Status::occluder_mesh:
      return "an occluder's mesh is null";
    case Status::occluder_vertices:
      return "two vertices of an occluder that lie at one place of its mesh differ in X, Y or W";
  }
  return "unknown status";
}

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/reference.cpp
namespace surefill_reference::reference {
namespace {

// Calls sink(Fragment) for each sample of numbers [first, last) that M2 counts: triangle by triangle, and of each by
// blocks of 8 x 8 pixels, which begin at the target's corner (M8).
template <typename Sink>
void traverse(const Target& target, const Draw& draw, DrawFragments& fragments, int first, int last, Rungs& rungs,
              const Sink& sink) {
  const PixelBox region = region_of(target, draw);
  const Origin& o = target.origin;
  double least = 1, largest = 0;  // of the coordinates of a pixel's samples
  for (int n = 0; n < target.samples; ++n) {
    const SamplePosition offset = sample_offset(target, n);
    least = std::min({least, offset.x, offset.y}), largest = std::max({largest, offset.x, offset.y});
  }
  for (std::size_t t = 0; t < triangles_of(draw); ++t) {
    const auto position = static_cast<std::uint32_t>(t);
    if (region.empty() || !is_finite(draw, position) || !fragments.triangle().use(draw, position, &rungs)) continue;
    if (fragments.triangle().is_culled()) continue;
    PixelBox box = fragments.triangle().box(region, least, largest);
    if (box.empty()) continue;
    box = {box.x0 - o.x, box.y0 - o.y, box.x1 - o.x, box.y1 - o.y};
    for (int by = box.y0 & ~7; by < box.y1; by += 8) {
      for (int bx = box.x0 & ~7; bx < box.x1; bx += 8) {
        for (int y = std::max(by, box.y0); y < std::min(by + 8, box.y1); ++y) {
          for (int x = std::max(bx, box.x0); x < std::min(bx + 8, box.x1); ++x) {
            for (int n = first; n < last; ++n) {
              Fragment fragment{position, x, y, n};
              if (fragments.counts(fragment)) sink(fragment);
            }
          }
        }
      }
    }
  }
}

}  // namespace

void draw(const Target& target, const Draw& draw, std::uint32_t number, Layers* layers, Rungs& rungs) noexcept {
  DrawFragments fragments(target, draw, number, layers, rungs);
  traverse(target, draw, fragments, 0, target.samples, rungs, [&](const Fragment& f) { fragments.take(f); });
}

Status render(const Target& target, std::span<const Draw> draws, Rungs& rungs) noexcept {
  FragmentFrame frame(target, draws);
  if (!frame.begin()) return Status::out_of_memory;
  for (std::size_t d = 0; d < draws.size(); ++d) {
    draw(target, draws[d], static_cast<std::uint32_t>(d), frame.layers(), rungs);
  }
  frame.finish(rungs);
  return Status::ok;
}

Status visit_coverage(const Target& target, std::span<const Draw> draws, const CoverageVisitor& visitor,
                      Rungs& rungs) noexcept {
  for (int n = 0; n < target.samples; ++n) {
    for (std::size_t d = 0; d < draws.size(); ++d) {
      DrawFragments fragments(target, draws[d], static_cast<std::uint32_t>(d), nullptr, rungs);
      CoverageBlock block{fragments.number(), 0, 0, 0, n, 0};
      const auto flush = [&] {
        if (block.mask != 0) visitor.visit(visitor.context, {&block, 1});
        block.mask = 0;
      };
      traverse(target, draws[d], fragments, n, n + 1, rungs, [&](const Fragment& f) {
        if (f.position != block.triangle || (f.x & ~7) != block.x || (f.y & ~7) != block.y) {
          flush();
          block.triangle = f.position, block.x = f.x & ~7, block.y = f.y & ~7;
        }
        block.mask |= std::uint64_t{1} << (8 * (f.y & 7) + (f.x & 7));
      });
      flush();
    }
  }
  return Status::ok;
}

}  // namespace surefill_reference::reference

// ---------------------------------------------------------------- src/statistics.cpp
namespace surefill_reference {

Statistics statistics_of(std::span<const Draw> draws) noexcept {
  Statistics sum;
  for (const Draw& draw : draws) {
    for (std::size_t t = 0; t < triangles_of(draw); ++t) {
      const auto position = static_cast<std::uint32_t>(t);
      if (!is_finite(draw, position)) {
        ++sum.dropped;
        continue;
      }
      const int sign = has_triangles(draw) ? orientation(draw, position) : 0;
      if (!has_triangles(draw)) {
        ++(ExactDraw().use(draw, position) ? sum.rasterized : sum.degenerate);
      } else if (sign == 0 && is_degenerate(draw, position)) {
        ++sum.degenerate;
      } else if (!draw.grid && culls(draw, sign)) {
        ++sum.culled;
      } else {
        ++sum.rasterized;
      }
    }
  }
  return sum;
}

}  // namespace surefill_reference

// ---------------------------------------------------------------- src/viewport.cpp
//
// The viewport map (S3): sums of at most four products of two float32, exact in double, rounded once.


namespace surefill_reference {
namespace {

using Sum = Expansion<4>;

// The float32 nearest to the sum as IEEE 754 has it: beyond range infinity, too small a zero of its sign, exactly 0 is
// +0.
float round_sum(const Sum& sum) {
  const double estimate = sum.estimate();
  const double error = std::fabs(estimate) * 0x1p-50;
  const float low = static_cast<float>(estimate - error), high = static_cast<float>(estimate + error);
  if (low == high) return low;
  return nearest_of_neighbours(low, high, [&](double midpoint) {
    Expansion<5> rest;
    for (int i = 0; i < sum.size(); ++i) rest.add(sum.term(i));
    rest.add(-midpoint);
    return rest.sign();
  });
}

// Adds a * b for float32 values, one of them perhaps halved: at most 48 bits, exact.
void add(Sum& sum, double a, double b) {
  sum.add(a * b);
}

Vertex map(const Viewport& viewport, const ClipVertex& v) {
  if (!(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w))) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    return {nan, nan, nan, nan};
  }
  const double half_width = viewport.width / 2.0, half_height = viewport.height / 2.0;
  const double near_depth = viewport.near_depth, far_depth = viewport.far_depth;
  const double y_sign = viewport.clip_y == ClipY::up ? -1 : 1;
  Sum x, y, z;
  add(x, v.x, half_width);
  add(x, v.w, viewport.x);
  add(x, v.w, half_width);
  add(y, v.y, y_sign * half_height);
  add(y, v.w, viewport.y);
  add(y, v.w, half_height);
  if (viewport.clip_depth == ClipDepth::zero_to_one) {
    add(z, v.z, far_depth);
    add(z, -v.z, near_depth);
    add(z, v.w, near_depth);
  } else {
    add(z, v.z, far_depth / 2);
    add(z, -v.z, near_depth / 2);
    add(z, v.w, far_depth / 2);
    add(z, v.w, near_depth / 2);
  }
  return {round_sum(x), round_sum(y), round_sum(z), v.w + 0.0f};
}

// Not inlined: it needs the engine's floating-point state.
[[gnu::noinline]] bool is_finite(const Viewport& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.width) && std::isfinite(v.height) &&
         std::isfinite(v.near_depth) && std::isfinite(v.far_depth);
}

// Nor this.
[[gnu::noinline]] void map_all(const Viewport& viewport, std::span<const ClipVertex> vertices, std::span<Vertex> out) {
  for (std::size_t i = 0; i < vertices.size(); ++i) out[i] = map(viewport, vertices[i]);
}

}  // namespace

Status to_pixel(const Viewport& viewport, std::span<const ClipVertex> vertices, std::span<Vertex> out) noexcept {
  if (!is_exact_build()) return Status::bad_build;
  const FloatEnvironment environment;
  if (!is_finite(viewport)) return Status::viewport;
  if (viewport.clip_depth > ClipDepth::minus_one_to_one || viewport.clip_y > ClipY::down) return Status::viewport;
  if (vertices.size() != out.size() || (vertices.data() == nullptr && !vertices.empty()) ||
      (out.data() == nullptr && !out.empty()) || Bytes(out).overlaps(Bytes(vertices)) ||
      Bytes(out).overlaps(Bytes::of(&viewport))) {
    return Status::to_pixel_vertices;
  }
  map_all(viewport, vertices, out);
  return Status::ok;
}

}  // namespace surefill_reference
