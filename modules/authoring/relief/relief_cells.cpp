#include "authoring/relief/relief_cells.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <tbb/parallel_for.h>

namespace patina {
namespace {

constexpr std::size_t kTexels = kTileSide * kTileSide;
constexpr std::uint8_t kEast = 1, kNorth = 2, kRising = 4, kFalling = 8;

std::size_t place(int i, int j) {
  return static_cast<std::size_t>(j * kTileSide + i);
}

// Texels of a square that are joined within it, each named by its first one.
class Parts {
 public:
  Parts() { std::iota(first_.begin(), first_.end(), std::int16_t{0}); }
  std::size_t of(std::size_t texel) {
    while (static_cast<std::size_t>(first_[texel]) != texel) {
      const auto up = static_cast<std::size_t>(first_[texel]);
      first_[texel] = first_[up];
      texel = up;
    }
    return texel;
  }
  void join(std::size_t a, std::size_t b) {
    const std::size_t x = of(a), y = of(b);
    first_[std::max(x, y)] = static_cast<std::int16_t>(std::min(x, y));
  }

 private:
  std::array<std::int16_t, kTexels> first_{};
};

// Texels that are joined over the side of a square, as cells of here and there. Two cells are
// neighbours if each has most of its pairs with the other.
class Border {
 public:
  void add(std::int16_t here, std::int16_t there) {
    for (Pair& pair : pairs_)
      if (pair.here == here && pair.there == there) {
        ++pair.count;
        return;
      }
    pairs_.push_back({here, there, 1});
  }
  template <class Visit> void forNeighbours(const Visit& visit) const {
    for (const Pair& pair : pairs_) {
      const bool most = std::all_of(pairs_.begin(), pairs_.end(), [&](const Pair& other) {
        return (other.here != pair.here && other.there != pair.there) || &other == &pair ||
               other.count < pair.count || (other.count == pair.count && &pair < &other);
      });
      if (most) visit(pair.here, pair.there);
    }
  }
  void clear() { pairs_.clear(); }

 private:
  struct Pair {
    std::int16_t here, there;
    int count;
  };
  std::vector<Pair> pairs_;
};

float leastDiagonal(const Spread& spread) {
  return std::min({(spread.ii + spread.jj) / 6, spread.ii, spread.jj});
}

} // namespace

Conductance::Conductance(const Spread& spread) {
  const float diagonal =
      std::max(std::abs(spread.ij), std::min({(spread.ii + spread.jj) / 6, spread.ii, spread.jj}));
  along_i = std::max(spread.ii - diagonal, 0.0F);
  along_j = std::max(spread.jj - diagonal, 0.0F);
  rising = 0.5F * (diagonal + spread.ij);
  falling = 0.5F * (diagonal - spread.ij);
}

double mostRate(const Spread& spread) {
  return 2 * static_cast<double>(spread.ii + spread.jj - leastDiagonal(spread));
}

Spline::Spline(int side) {
  for (int i = 0; i < kTileSide; ++i) {
    const double u = (i % side + 0.5) / side - 0.5;
    const auto n = static_cast<std::size_t>(i);
    weight_[0][n] = static_cast<float>(0.5 * (0.5 - u) * (0.5 - u));
    weight_[1][n] = static_cast<float>(0.75 - u * u);
    weight_[2][n] = static_cast<float>(0.5 * (0.5 + u) * (0.5 + u));
  }
}

ReliefCells::ReliefCells(const TriangleMesh& mesh, const CornerUvs& uvs, const TexelMap& texels,
                         const std::vector<TexelMetric>& metrics, std::vector<Spread> spreads,
                         int side)
    : mesh_(mesh), uvs_(uvs), texels_(texels), metrics_(metrics), spreads_(std::move(spreads)),
      side_(side), across_(texels.width / kTileSide), along_(texels.height / kTileSide),
      spline_(side), tiles_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(along_)) {}

std::unique_ptr<CellTile> ReliefCells::made(std::size_t index) const {
  auto tile = std::make_unique<CellTile>();
  const int i0 = static_cast<int>(index) % across_ * kTileSide,
            j0 = static_cast<int>(index) / across_ * kTileSide;
  const TexelRows rows(mesh_, uvs_, texels_, metrics_);
  std::vector<TexelOnSurface> here(kTileSide + 2), above(kTileSide + 2);
  std::array<std::int32_t, kTexels> face;
  rows.read(i0 - 1, j0, here);
  for (int j = 0; j < kTileSide; ++j, std::swap(here, above)) {
    rows.read(i0 - 1, j0 + j + 1, above);
    for (int i = 0; i < kTileSide; ++i) {
      const auto n = static_cast<std::size_t>(i) + 1;
      const TexelOnSurface& own = here[n];
      face[place(i, j)] = own.shown ? texels_.ownerAt(i0 + i, j0 + j) : -1;
      std::uint8_t joined = 0;
      if (TexelRows::joined(own, here[n + 1], 1, 0)) joined |= kEast;
      if (TexelRows::joined(own, above[n], 0, 1)) joined |= kNorth;
      if (TexelRows::joined(own, above[n + 1], 1, 1)) joined |= kRising;
      if (TexelRows::joined(own, above[n - 1], -1, 1)) joined |= kFalling;
      tile->joined[place(i, j)] = joined;
    }
  }

  Parts parts;
  const auto sameSquare = [&](int a, int b) { return a / side_ == b / side_; };
  for (int j = 0; side_ > 1 && j < kTileSide; ++j)
    for (int i = 0; i < kTileSide; ++i) {
      const std::uint8_t joined = tile->joined[place(i, j)];
      const bool up = j + 1 < kTileSide && sameSquare(j, j + 1);
      const bool right = i + 1 < kTileSide && sameSquare(i, i + 1);
      const bool left = i > 0 && sameSquare(i, i - 1);
      if (right && (joined & kEast)) parts.join(place(i, j), place(i + 1, j));
      if (up && (joined & kNorth)) parts.join(place(i, j), place(i, j + 1));
      if (up && right && (joined & kRising)) parts.join(place(i, j), place(i + 1, j + 1));
      if (up && left && (joined & kFalling)) parts.join(place(i, j), place(i - 1, j + 1));
    }
  std::array<std::int16_t, kTexels> count{};
  for (std::size_t t = 0; t < kTexels; ++t)
    if (face[t] >= 0) ++count[parts.of(t)];

  std::array<std::int16_t, kTexels> cell_at; // by the first texel of a part
  const auto squares = static_cast<std::size_t>(this->squares() * this->squares());
  tile->cells.resize(squares);
  for (std::size_t s = 0; s < squares; ++s) {
    const int i1 = static_cast<int>(s) % this->squares() * side_,
              j1 = static_cast<int>(s) / this->squares() * side_;
    const auto forFirsts = [&](const auto& visit) {
      for (int j = j1; j < j1 + side_; ++j)
        for (int i = i1; i < i1 + side_; ++i)
          if (count[place(i, j)] > 0) visit(place(i, j));
    };
    std::size_t largest = kTexels;
    forFirsts([&](std::size_t t) {
      if (largest == kTexels || count[t] > count[largest]) largest = t;
    });
    forFirsts([&](std::size_t t) {
      cell_at[t] = static_cast<std::int16_t>(t == largest ? s : tile->cells.size());
      if (t == largest) return;
      tile->cells.emplace_back();
      tile->square.push_back(static_cast<std::int16_t>(s));
    });
  }
  std::vector<Spread> spreads(tile->cells.size());
  for (std::size_t t = 0; t < kTexels; ++t) {
    tile->cell_of[t] = -1;
    if (face[t] < 0) continue;
    tile->cell_of[t] = cell_at[parts.of(t)];
    const auto c = static_cast<std::size_t>(tile->cell_of[t]);
    const auto f = static_cast<std::size_t>(face[t]);
    ++tile->cells[c].texels;
    tile->cells[c].area += std::sqrt(metrics_[f].determinant());
    spreads[c].ii += spreads_[f].ii;
    spreads[c].ij += spreads_[f].ij;
    spreads[c].jj += spreads_[f].jj;
  }
  for (std::size_t c = 0; c < spreads.size(); ++c) {
    Cell& cell = tile->cells[c];
    if (cell.texels == 0) continue;
    const float factor = cell.area / static_cast<float>(cell.texels);
    const Spread& sum = spreads[c];
    cell.conductance = Conductance({factor * sum.ii, factor * sum.ij, factor * sum.jj});
  }
  return tile;
}

void ReliefCells::link(std::size_t index) {
  CellTile& tile = *tiles_[index];
  const int ti = static_cast<int>(index) % across_, tj = static_cast<int>(index) / across_;
  Border border;
  // Over the line between texels `low` and `low + step` for `side` texels along the other axis; of
  // this tile is the one, or the other, or both.
  const auto over = [&](const CellTile& from, const CellTile& to, bool east, int line, int first) {
    border.clear();
    for (int n = first; n < first + side_; ++n) {
      const int end = (line + 1) % kTileSide;
      const std::size_t a = east ? place(line, n) : place(n, line),
                        b = east ? place(end, n) : place(n, end);
      if (from.joined[a] & (east ? kEast : kNorth)) border.add(from.cell_of[a], to.cell_of[b]);
    }
    border.forNeighbours([&](std::int16_t a, std::int16_t b) {
      if (&from == &tile)
        tile.cells[static_cast<std::size_t>(a)].next[east ? kToEast : kToNorth] = b;
      if (&to == &tile) tile.cells[static_cast<std::size_t>(b)].next[east ? kToWest : kToSouth] = a;
    });
  };
  const auto width = static_cast<std::size_t>(across_);
  for (int first = 0; first < kTileSide; first += side_) {
    for (int line = side_ - 1; line + 1 < kTileSide; line += side_) {
      over(tile, tile, true, line, first);
      over(tile, tile, false, line, first);
    }
    constexpr int kLast = kTileSide - 1;
    if (ti + 1 < across_) over(tile, *tiles_[index + 1], true, kLast, first);
    if (tj + 1 < along_) over(tile, *tiles_[index + width], false, kLast, first);
    if (ti > 0) over(*tiles_[index - 1], tile, true, kLast, first);
    if (tj > 0) over(*tiles_[index - width], tile, false, kLast, first);
  }
  const int squares = this->squares();
  for (int square = 0; square < squares * squares; ++square) {
    Cell& cell = tile.cells[static_cast<std::size_t>(square)];
    const int i = square % squares, j = square / squares, last = squares - 1;
    const std::array<int, 4> beside{
        i < last ? square + 1 : square - last, j < last ? square + squares : i,
        i > 0 ? square - 1 : square + last, j > 0 ? square - squares : last * squares + i};
    for (std::size_t way = 0; way < 4; ++way)
      if (cell.next[way] == beside[way]) cell.plain |= static_cast<std::uint8_t>(1U << way);
  }
  tile.linked = true;
}

void ReliefCells::make(const TexelBox& tiles) {
  std::vector<std::size_t> missing, unlinked;
  for (int j = std::max(tiles.j0 - 1, 0); j < std::min(tiles.j1 + 1, along_); ++j)
    for (int i = std::max(tiles.i0 - 1, 0); i < std::min(tiles.i1 + 1, across_); ++i) {
      const auto index = static_cast<std::size_t>(j) * static_cast<std::size_t>(across_) +
                         static_cast<std::size_t>(i);
      if (!tiles_[index]) missing.push_back(index);
      if (i >= tiles.i0 && i < tiles.i1 && j >= tiles.j0 && j < tiles.j1 &&
          !(tiles_[index] && tiles_[index]->linked))
        unlinked.push_back(index);
    }
  tbb::parallel_for(std::size_t{0}, missing.size(),
                    [&](std::size_t n) { tiles_[missing[n]] = made(missing[n]); });
  tbb::parallel_for(std::size_t{0}, unlinked.size(), [&](std::size_t n) { link(unlinked[n]); });
}

std::size_t ReliefCells::bytes() const {
  std::size_t sum = spreads_.size() * sizeof(Spread);
  for (const auto& tile : tiles_)
    if (tile) sum += sizeof(CellTile) + tile->cells.size() * sizeof(Cell);
  return sum;
}

} // namespace patina
