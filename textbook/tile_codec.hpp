// SPDX-License-Identifier: Apache-2.0
//
// A lossless codec for tiles of 8 x 8 depths or colours, of the kind that saves a GPU its bandwidth: constant, plane
// with corrections, raw.
//
// Source: J. Hasselgren and T. Akenine-Moeller, Efficient Depth Buffer Compression, 2006 (a survey; DDPCM and plane
// encoding).
#ifndef SUREFILL_TEXTBOOK_TILE_CODEC_HPP
#define SUREFILL_TEXTBOOK_TILE_CODEC_HPP

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace surefill::textbook {

inline constexpr int kCodecTile = 8;
using Lane = std::array<std::int32_t, 64>;         // rows from the top
using DepthTile = std::array<float, 64>;           // no NaN
using ColourTile = std::array<std::uint32_t, 64>;  // 4 channels of 8 bits

// Floats in their order as integers: neighbours differ by 1, so depths on a plane are nearly affine within a binade.
inline std::int32_t ordered(float value) {
  const auto bits = std::bit_cast<std::int32_t>(value);
  return bits >= 0 ? bits : static_cast<std::int32_t>(0x80000000u - static_cast<std::uint32_t>(bits) - 1u);
}
inline float from_ordered(std::int32_t n) {
  const auto bits = n >= 0 ? static_cast<std::uint32_t>(n) : 0x80000000u - static_cast<std::uint32_t>(n) - 1u;
  return std::bit_cast<float>(bits);
}

// The plane through the tile's corner and the last samples of its first row and column, in 1/7 units.
struct LanePlane {
  std::int64_t corner, along_x, along_y;
  std::int64_t at(int x, int y) const {
    const std::int64_t sevenths = along_x * x + along_y * y;
    return corner + (sevenths >= 0 ? (sevenths + 3) / 7 : -((3 - sevenths) / 7));
  }
};

enum class TileCode : std::uint8_t { constant, plane, raw };

// Bytes: code (and the width of the corrections), then what it needs. `value_bytes` of a raw value: 4, or 1 for a
// channel.
class LaneCodec {
 public:
  explicit LaneCodec(int value_bytes) : value_bytes_(value_bytes) {}

  void encode(const Lane& lane, std::vector<std::uint8_t>& out) const {
    const LanePlane plane{lane[0], std::int64_t{lane[7]} - lane[0], std::int64_t{lane[56]} - lane[0]};
    int width = 0;  // corrections in [-2^(width - 1), 2^(width - 1)); 0: there are none
    bool constant = true;
    for (int s = 0; s < 64; ++s) {
      const std::int64_t value = lane[static_cast<std::size_t>(s)], rest = value - plane.at(s % 8, s / 8);
      while (width == 0 ? rest != 0
                        : rest < -(std::int64_t{1} << (width - 1)) || rest >= std::int64_t{1} << (width - 1)) {
        ++width;
      }
      constant = constant && value == lane[0];
    }
    if (constant) {
      out.push_back(static_cast<std::uint8_t>(TileCode::constant));
      put(static_cast<std::uint64_t>(lane[0]), value_bytes_, out);
    } else if (3 * value_bytes_ + 8 * width < 64 * value_bytes_) {
      out.push_back(static_cast<std::uint8_t>(static_cast<int>(TileCode::plane) + 4 * width));
      for (const std::int32_t value : {lane[0], lane[7], lane[56]})
        put(static_cast<std::uint64_t>(value), value_bytes_, out);
      put_corrections(lane, plane, width, out);
    } else {
      out.push_back(static_cast<std::uint8_t>(TileCode::raw));
      for (const std::int32_t value : lane) put(static_cast<std::uint64_t>(value), value_bytes_, out);
    }
  }

  // Reads what encode wrote from `bytes` and moves it on.
  Lane decode(const std::uint8_t*& bytes) const {
    Lane lane;
    const int head = *bytes++, width = head / 4;
    switch (static_cast<TileCode>(head % 4)) {
      case TileCode::constant:
        lane.fill(get(bytes));
        break;
      case TileCode::plane: {
        const std::int64_t corner = get(bytes), right = get(bytes), below = get(bytes);
        const LanePlane plane{corner, right - corner, below - corner};
        for (int s = 0; s < 64; ++s) {
          lane[static_cast<std::size_t>(s)] =
              static_cast<std::int32_t>(plane.at(s % 8, s / 8) + correction(bytes, s * width, width));
        }
        bytes += 8 * width;
        break;
      }
      default:
        for (std::int32_t& value : lane) value = get(bytes);
    }
    return lane;
  }

 private:
  static void put(std::uint64_t value, int count, std::vector<std::uint8_t>& out) {
    for (int k = 0; k < count; ++k) out.push_back(static_cast<std::uint8_t>(value >> (8 * k) & 0xFFu));
  }
  std::int32_t get(const std::uint8_t*& bytes) const {
    std::uint32_t value = 0;
    for (int k = 0; k < value_bytes_; ++k) value |= static_cast<std::uint32_t>(*bytes++) << (8 * k);
    return static_cast<std::int32_t>(value);
  }

  // 64 corrections of `width` bits are 8 width bytes.
  static void put_corrections(const Lane& lane, const LanePlane& plane, int width, std::vector<std::uint8_t>& out) {
    const std::size_t start = out.size();
    out.resize(start + static_cast<std::size_t>(8 * width), 0);
    for (int s = 0; s < 64; ++s) {
      const auto rest = static_cast<std::uint64_t>(lane[static_cast<std::size_t>(s)] - plane.at(s % 8, s / 8));
      for (int k = 0; k < width; ++k) {
        const int bit = s * width + k;
        if ((rest >> k & 1u) != 0) {
          std::uint8_t& byte = out[start + static_cast<std::size_t>(bit / 8)];
          byte = static_cast<std::uint8_t>(byte | 1u << (bit % 8));
        }
      }
    }
  }
  static std::int64_t correction(const std::uint8_t* bytes, int first_bit, int width) {
    std::uint64_t value = 0;
    for (int k = 0; k < width; ++k) {
      const int bit = first_bit + k;
      value |= static_cast<std::uint64_t>(bytes[bit / 8] >> (bit % 8) & 1u) << k;
    }
    const std::uint64_t sign = width == 0 ? 0 : std::uint64_t{1} << (width - 1);
    return static_cast<std::int64_t>(value) - static_cast<std::int64_t>((value & sign) << 1);
  }

  int value_bytes_;
};

inline std::vector<std::uint8_t> encode(const DepthTile& tile) {
  Lane lane;
  for (std::size_t s = 0; s < 64; ++s) lane[s] = ordered(tile[s]);
  std::vector<std::uint8_t> bytes;
  LaneCodec(4).encode(lane, bytes);
  return bytes;
}
inline DepthTile decode_depth(const std::vector<std::uint8_t>& bytes) {
  const std::uint8_t* at = bytes.data();
  const Lane lane = LaneCodec(4).decode(at);
  DepthTile tile;
  for (std::size_t s = 0; s < 64; ++s) tile[s] = from_ordered(lane[s]);
  return tile;
}

inline std::vector<std::uint8_t> encode(const ColourTile& tile) {
  std::vector<std::uint8_t> bytes;
  for (unsigned channel = 0; channel < 4; ++channel) {
    Lane lane;
    for (std::size_t s = 0; s < 64; ++s) lane[s] = static_cast<std::int32_t>(tile[s] >> (8 * channel) & 0xFFu);
    LaneCodec(1).encode(lane, bytes);
  }
  return bytes;
}
inline ColourTile decode_colour(const std::vector<std::uint8_t>& bytes) {
  const std::uint8_t* at = bytes.data();
  ColourTile tile{};
  for (unsigned channel = 0; channel < 4; ++channel) {
    const Lane lane = LaneCodec(1).decode(at);
    for (std::size_t s = 0; s < 64; ++s) tile[s] |= static_cast<std::uint32_t>(lane[s]) << (8 * channel);
  }
  return tile;
}

}  // namespace surefill::textbook

#endif  // SUREFILL_TEXTBOOK_TILE_CODEC_HPP
