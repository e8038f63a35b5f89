// SPDX-License-Identifier: Apache-2.0
//
// Which records each tile draws. Some neighbouring triangles of a draw form a piece, which one thread sets up; the
// pieces of a chunk follow each other as the triangles do, so within a tile the lists of all pieces, one after another,
// are in the order of the draws and triangles.
#ifndef SUREFILL_SRC_FAST_LISTS_HPP
#define SUREFILL_SRC_FAST_LISTS_HPP

#include "fast/record.hpp"

namespace surefill::fast {

// The tiles of the target.
struct TileGrid {
  int columns = 0, rows = 0;
  std::size_t tiles() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

struct Piece {
  const DrawJob* job = nullptr;
  std::uint32_t next = 0, end = 0;  // triangles that are not set up yet; some are left over where lists are full
  Record* records = nullptr;        // room for kPieceRecords
  std::uint32_t size = 0;           // of records
  std::uint32_t* begin =
      nullptr;  // room for two more than there are tiles: items[begin[t] .. begin[t + 1]) are of tile t
  std::uint16_t* items = nullptr;  // room for kPiecePairs: numbers of records
};

// A pair of a tile and a record, while a piece is set up.
inline std::uint32_t pair_of(std::size_t tile, std::uint32_t record) {
  return static_cast<std::uint32_t>(tile) << 16 | record;
}
static_assert(kPieceRecords <= 1 << 16 && (kMaxTargetSize / kTileSize) * (kMaxTargetSize / kTileSize) <= 1 << 16);

// The lists of a piece, by counting: `begin` holds at t + 2 how many pairs tile t has, else 0.
inline void sort_pairs(const TileGrid& grid, const std::uint32_t* pairs, std::size_t size, Piece& piece) {
  const std::size_t tiles = grid.tiles();
  for (std::size_t t = 2; t < tiles + 2; ++t) piece.begin[t] += piece.begin[t - 1];
  for (std::size_t i = 0; i < size; ++i)
    piece.items[piece.begin[(pairs[i] >> 16) + 1]++] = static_cast<std::uint16_t>(pairs[i]);
}

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_FAST_LISTS_HPP
