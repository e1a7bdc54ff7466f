#include "authoring/relief/relief_window.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <tbb/parallel_for.h>

namespace patina {
namespace {

constexpr std::size_t kTexels = kTileSide * kTileSide;
constexpr std::uint8_t kJoinsEast = 1, kJoinsNorth = 2, kJoinsDiagonal = 4, kJoinsAntiDiagonal = 8;

std::size_t place(int i, int j) {
  return static_cast<std::size_t>(j * kTileSide + i);
}

// Connected texels of a square, each part named by its first texel.
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

// Texels connected over the side of a square, as pairs of cells. Two cells are neighbours if each
// has most of its pairs with the other.
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

float minDiagonal(const DiffusionTensor& tensor) {
  return std::min({(tensor.ii + tensor.jj) / 6, tensor.ii, tensor.jj});
}

} // namespace

Conductance::Conductance(const DiffusionTensor& tensor) {
  const float both =
      std::max(std::abs(tensor.ij), std::min({(tensor.ii + tensor.jj) / 6, tensor.ii, tensor.jj}));
  along_i = std::max(tensor.ii - both, 0.0F);
  along_j = std::max(tensor.jj - both, 0.0F);
  diagonal = 0.5F * (both + tensor.ij);
  anti_diagonal = 0.5F * (both - tensor.ij);
}

double maxDecayRate(const DiffusionTensor& tensor) {
  return 2 * static_cast<double>(tensor.ii + tensor.jj - minDiagonal(tensor));
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
                         const std::vector<TexelMetric>& metrics,
                         std::vector<DiffusionTensor> tensors, int side)
    : mesh_(mesh), uvs_(uvs), texels_(texels), metrics_(metrics), tensors_(std::move(tensors)),
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
      if (TexelRows::joined(own, here[n + 1], 1, 0)) joined |= kJoinsEast;
      if (TexelRows::joined(own, above[n], 0, 1)) joined |= kJoinsNorth;
      if (TexelRows::joined(own, above[n + 1], 1, 1)) joined |= kJoinsDiagonal;
      if (TexelRows::joined(own, above[n - 1], -1, 1)) joined |= kJoinsAntiDiagonal;
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
      if (right && (joined & kJoinsEast)) parts.join(place(i, j), place(i + 1, j));
      if (up && (joined & kJoinsNorth)) parts.join(place(i, j), place(i, j + 1));
      if (up && right && (joined & kJoinsDiagonal)) parts.join(place(i, j), place(i + 1, j + 1));
      if (up && left && (joined & kJoinsAntiDiagonal)) parts.join(place(i, j), place(i - 1, j + 1));
    }
  std::array<std::int16_t, kTexels> count{};
  for (std::size_t t = 0; t < kTexels; ++t)
    if (face[t] >= 0) ++count[parts.of(t)];

  std::array<std::int16_t, kTexels> cell_at; // indexed by the first texel of a part
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
  std::vector<DiffusionTensor> tensors(tile->cells.size());
  for (std::size_t t = 0; t < kTexels; ++t) {
    tile->cell_of[t] = -1;
    if (face[t] < 0) continue;
    tile->cell_of[t] = cell_at[parts.of(t)];
    const auto c = static_cast<std::size_t>(tile->cell_of[t]);
    const auto f = static_cast<std::size_t>(face[t]);
    ++tile->cells[c].texels;
    tile->cells[c].area += std::sqrt(metrics_[f].determinant());
    tensors[c].ii += tensors_[f].ii;
    tensors[c].ij += tensors_[f].ij;
    tensors[c].jj += tensors_[f].jj;
  }
  for (std::size_t c = 0; c < tensors.size(); ++c) {
    Cell& cell = tile->cells[c];
    if (cell.texels == 0) continue;
    const float factor = cell.area / static_cast<float>(cell.texels);
    const DiffusionTensor& sum = tensors[c];
    cell.conductance = Conductance({factor * sum.ii, factor * sum.ij, factor * sum.jj});
  }
  return tile;
}

void ReliefCells::link(std::size_t index) {
  CellTile& tile = *tiles_[index];
  const int ti = static_cast<int>(index) % across_, tj = static_cast<int>(index) / across_;
  Border border;
  // Links over the line between texels `low` and `low + step` for `side` texels along the other
  // axis; at least one side of the line lies in this tile.
  const auto over = [&](const CellTile& from, const CellTile& to, bool east, int line, int first) {
    border.clear();
    for (int n = first; n < first + side_; ++n) {
      const int end = (line + 1) % kTileSide;
      const std::size_t a = east ? place(line, n) : place(n, line),
                        b = east ? place(end, n) : place(n, end);
      if (from.joined[a] & (east ? kJoinsEast : kJoinsNorth))
        border.add(from.cell_of[a], to.cell_of[b]);
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
  std::size_t sum = tensors_.size() * sizeof(DiffusionTensor);
  for (const auto& tile : tiles_)
    if (tile) sum += sizeof(CellTile) + tile->cells.size() * sizeof(Cell);
  return sum;
}

namespace {

constexpr float kNothing = 0;

std::size_t inTile(int i, int j) {
  return static_cast<std::size_t>((j % kTileSide) * kTileSide + i % kTileSide);
}

} // namespace

TexelBox grown(const TexelBox& box, int by, const TexelBox& image) {
  return {std::max(box.i0 - by, image.i0), std::max(box.j0 - by, image.j0),
          std::min(box.i1 + by, image.i1), std::min(box.j1 + by, image.j1)};
}

TexelBox scaled(const TexelBox& box, int by) {
  return {box.i0 * by, box.j0 * by, box.i1 * by, box.j1 * by};
}

ReliefWindow::ReliefWindow(const ReliefCells& cells, const TexelBox& squares)
    : cells_(cells), box_(squares), stride_(static_cast<std::size_t>(width(squares)) + 2),
      grid_(stride_ * static_cast<std::size_t>(squares.j1 - squares.j0 + 2)) {
  const int side = cells.squares();
  const auto in_tile = static_cast<std::size_t>(side * side);
  std::size_t size = grid_;
  tile_box_ = {box_.i0 / side, box_.j0 / side, (box_.i1 + side - 1) / side,
               (box_.j1 + side - 1) / side};
  forTiles(box_, side, [&](const TexelBox& part) {
    const auto tile = static_cast<std::size_t>(part.j0 / side * cells.across() + part.i0 / side);
    tiles_.push_back({tile, size, part});
    size += cells.tile(tile).cells.size() - in_tile;
  });
  next_.resize(size);
  for (std::size_t place = 0; place < size; ++place)
    next_[place].fill(static_cast<std::uint32_t>(place));
  for (std::size_t p = 0; p < kParts; ++p) parts_[p].resize(p == kPerArea ? size : grid_);
  std::vector<Conductance> conductances(size);
  tbb::parallel_for(std::size_t{0}, tiles_.size(),
                    [&](std::size_t n) { readNext(tiles_[n], conductances); });
  std::vector<std::vector<Link>> links(tiles_.size());
  tbb::parallel_for(std::size_t{0}, tiles_.size(),
                    [&](std::size_t n) { join(tiles_[n], conductances, links[n]); });
  for (const std::vector<Link>& own : links) links_.insert(links_.end(), own.begin(), own.end());
}

std::size_t ReliefWindow::placeOf(const TilePart& part, std::size_t cell) const {
  const auto side = static_cast<std::size_t>(cells_.squares());
  if (cell >= side * side) return part.others + cell - side * side;
  return at(part.squares.i0 / cells_.squares() * cells_.squares() + static_cast<int>(cell % side),
            part.squares.j0 / cells_.squares() * cells_.squares() + static_cast<int>(cell / side));
}

bool ReliefWindow::isIn(const TilePart& part, std::size_t cell) const {
  const int side = cells_.squares();
  if (cell >= static_cast<std::size_t>(side * side)) return true;
  const int i = part.squares.i0 / side * side + static_cast<int>(cell) % side,
            j = part.squares.j0 / side * side + static_cast<int>(cell) / side;
  return i >= part.squares.i0 && i < part.squares.i1 && j >= part.squares.j0 && j < part.squares.j1;
}

// Calls visit(cell, place) for the cells in use.
template <class Visit> void ReliefWindow::forCells(const TilePart& part, const Visit& visit) const {
  const CellTile& tile = cells_.tile(part.tile);
  const int side = cells_.squares();
  for (int j = part.squares.j0; j < part.squares.j1; ++j)
    for (int i = part.squares.i0; i < part.squares.i1; ++i) {
      const auto cell = static_cast<std::size_t>(j % side * side + i % side);
      if (tile.cells[cell].texels > 0) visit(cell, at(i, j));
    }
  for (auto cell = static_cast<std::size_t>(side * side); cell < tile.cells.size(); ++cell)
    visit(cell, placeOf(part, cell));
}

void ReliefWindow::readNext(const TilePart& part, std::vector<Conductance>& conductances) {
  const CellTile& tile = cells_.tile(part.tile);
  const int side = cells_.squares();
  const auto in_tile = static_cast<std::size_t>(side * side);
  // Finds the tile of a cell's neighbour: its own or the next one.
  const auto wide = static_cast<std::size_t>(width(tile_box_));
  const auto own = static_cast<std::size_t>(&part - tiles_.data());
  const int ti = part.squares.i0 / side, tj = part.squares.j0 / side;
  const std::array<const TilePart*, 4> beyond{ti + 1 < tile_box_.i1 ? &tiles_[own + 1] : nullptr,
                                              tj + 1 < tile_box_.j1 ? &tiles_[own + wide] : nullptr,
                                              ti > tile_box_.i0 ? &tiles_[own - 1] : nullptr,
                                              tj > tile_box_.j0 ? &tiles_[own - wide] : nullptr};
  const std::array<std::ptrdiff_t, 4> step{1, static_cast<std::ptrdiff_t>(stride_), -1,
                                           -static_cast<std::ptrdiff_t>(stride_)};
  const auto read = [&](const Cell& cell, std::size_t place, int i, int j, bool largest) {
    if (!(cell.area > 0)) return;
    conductances[place] = cell.conductance;
    parts_[kPerArea][place] = 1 / cell.area;
    const std::array<bool, 4> is_last{i + 1 == box_.i1, j + 1 == box_.j1, i == box_.i0,
                                      j == box_.j0};
    const std::array<bool, 4> leaves{(i + 1) % side == 0, (j + 1) % side == 0, i % side == 0,
                                     j % side == 0};
    for (std::size_t way = 0; way < 4; ++way) {
      if (largest && cell.plain >> way & 1U) {
        if (!is_last[way])
          next_[place][way] =
              static_cast<std::uint32_t>(static_cast<std::ptrdiff_t>(place) + step[way]);
        continue;
      }
      if (cell.next[way] < 0) continue;
      const TilePart* to = leaves[way] ? beyond[way] : &part;
      const auto there = static_cast<std::size_t>(cell.next[way]);
      if (to && isIn(*to, there))
        next_[place][way] = static_cast<std::uint32_t>(placeOf(*to, there));
    }
  };
  for (int j = part.squares.j0; j < part.squares.j1; ++j)
    for (int i = part.squares.i0; i < part.squares.i1; ++i)
      read(tile.cells[static_cast<std::size_t>(j % side * side + i % side)], at(i, j), i, j, true);
  for (std::size_t cell = in_tile; cell < tile.cells.size(); ++cell) {
    const int square = tile.square[cell - in_tile];
    read(tile.cells[cell], part.others + cell - in_tile, ti * side + square % side,
         tj * side + square / side, false);
  }
}

// Uses the smaller of two conductances, so that the cells' own rates bound the spectrum.
void ReliefWindow::join(const TilePart& part, const std::vector<Conductance>& conductances,
                        std::vector<Link>& links) {
  forCells(part, [&](std::size_t, std::size_t place) {
    const auto link = [&](Part to, std::size_t other, std::size_t expected,
                          float Conductance::*along) {
      if (other == place) return;
      const float c = std::min(conductances[place].*along, conductances[other].*along);
      if (place < grid_ && other == expected)
        parts_[to][place] = c;
      else
        links.push_back({place, other, c});
    };
    const std::size_t east = next_[place][kToEast], west = next_[place][kToWest];
    link(kEast, east, place + 1, &Conductance::along_i);
    link(kNorth, next_[place][kToNorth], place + stride_, &Conductance::along_j);
    if (east != place && next_[east][kToNorth] != east)
      link(kDiagonal, next_[east][kToNorth], place + stride_ + 1, &Conductance::diagonal);
    if (west != place && next_[west][kToNorth] != west)
      link(kAntiDiagonal, next_[west][kToNorth], place + stride_ - 1, &Conductance::anti_diagonal);
  });
}

// Returns the 3 x 3 neighbourhood, i fastest. A missing neighbour is replaced by the cell itself,
// which keeps the flow inside the chart.
std::array<std::size_t, 9> ReliefWindow::about(std::size_t place) const {
  std::array<std::size_t, 9> places;
  const std::array<std::size_t, 3> row{next_[place][kToWest], place, next_[place][kToEast]};
  for (std::size_t k = 0; k < 3; ++k) {
    places[k] = next_[row[k]][kToSouth];
    places[3 + k] = row[k];
    places[6 + k] = next_[row[k]][kToNorth];
  }
  return places;
}

// Moments of a cell's texel values and of 1, by the spline weights for the neighbouring cells, i
// fastest.
struct ReliefWindow::Moments {
  std::array<float, 9> value{}, unit{};
};

void ReliefWindow::takeMoments(const TilePart& part, const TiledImage& image,
                               std::vector<Moments>& moments) const {
  const CellTile& tile = cells_.tile(part.tile);
  const float* values = image.tile(part.tile);
  const int side = cells_.side(), squares = cells_.squares();
  const Spline& w = cells_.spline();
  const int i0 = part.squares.i0 % squares * side, i1 = i0 + width(part.squares) * side;
  std::array<float, 3> units{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < static_cast<std::size_t>(side); ++i) units[k] += w[k][i];
  bool with_parts = tile.cells.size() > static_cast<std::size_t>(squares * squares);
  for (int sj = part.squares.j0; sj < part.squares.j1; ++sj) {
    const int j0 = sj % squares * side;
    // Columns first, a whole row at once.
    std::array<std::array<float, kTileSide>, 3> column{};
    for (int j = j0; values && j < j0 + side; ++j) {
      const float* row = values + j * kTileSide;
      for (std::size_t k = 0; k < 3; ++k) {
        const float weight = w[k][static_cast<std::size_t>(j)];
        float* to = column[k].data();
        for (int i = i0; i < i1; ++i) to[i] += weight * row[i];
      }
    }
    for (std::size_t k = 0; k < 9; ++k) {
      std::array<float, kTileSide> sum;
      for (int i = i0; i < i1; ++i) {
        const auto n = static_cast<std::size_t>(i);
        sum[n - static_cast<std::size_t>(i0)] = w[k % 3][n] * column[k / 3][n];
      }
      int count = i1 - i0;
      for (int left = side; left > 1; left /= 2) {
        count /= 2;
        for (std::size_t n = 0; n < static_cast<std::size_t>(count); ++n)
          sum[n] = sum[2 * n] + sum[2 * n + 1];
      }
      for (int n = 0; n < count; ++n) {
        Moments& made = moments[at(part.squares.i0 + n, sj)];
        made.value[k] = sum[static_cast<std::size_t>(n)];
        made.unit[k] = units[k % 3] * units[k / 3];
      }
    }
    for (int si = part.squares.i0; si < part.squares.i1; ++si) {
      const auto cell = static_cast<std::size_t>(sj % squares * squares + si % squares);
      if (tile.cells[cell].texels == side * side) continue;
      moments[at(si, sj)] = {};
      with_parts = with_parts || tile.cells[cell].texels > 0;
    }
  }
  if (!with_parts) return;
  for (int j = 0; j < kTileSide; ++j)
    for (int i = 0; i < kTileSide; ++i) {
      const std::int16_t cell = tile.cell_of[inTile(i, j)];
      if (cell < 0) continue;
      const auto c = static_cast<std::size_t>(cell);
      if (tile.cells[c].texels == side * side || !isIn(part, c)) continue;
      Moments& made = moments[placeOf(part, c)];
      const float value = values ? values[inTile(i, j)] : kNothing;
      for (std::size_t kj = 0; kj < 3; ++kj)
        for (std::size_t ki = 0; ki < 3; ++ki) {
          const float weight =
              w[ki][static_cast<std::size_t>(i)] * w[kj][static_cast<std::size_t>(j)];
          made.value[3 * kj + ki] += weight * value;
          made.unit[3 * kj + ki] += weight;
        }
    }
}

std::vector<float> ReliefWindow::restrict(const TiledImage& image) const {
  std::vector<float> values(size());
  if (cells_.side() == 1) {
    for (const TilePart& part : tiles_)
      if (const float* tile = image.tile(part.tile))
        for (int j = part.squares.j0; j < part.squares.j1; ++j)
          std::copy_n(tile + inTile(part.squares.i0, j), width(part.squares),
                      &values[at(part.squares.i0, j)]);
    return values;
  }
  std::vector<Moments> moments(size());
  tbb::parallel_for(std::size_t{0}, tiles_.size(),
                    [&](std::size_t n) { takeMoments(tiles_[n], image, moments); });
  std::vector<float> weights(size());
  for (std::size_t place = 0; place < size(); ++place) {
    if (!(parts_[kPerArea][place] > 0)) continue;
    const Moments& own = moments[place];
    const std::array<std::size_t, 9> to = about(place);
    for (std::size_t k = 0; k < 9; ++k) {
      values[to[k]] += own.value[k];
      weights[to[k]] += own.unit[k];
    }
  }
  for (std::size_t place = 0; place < size(); ++place)
    if (weights[place] > 0) values[place] /= weights[place];
  return values;
}

void ReliefWindow::prolong(const std::vector<float>& values, const TexelBox& part,
                           TileValues& made) const {
  const int side = cells_.side(), squares = cells_.squares();
  if (side == 1) {
    for (int j = part.j0; j < part.j1; ++j)
      std::copy_n(&values[at(part.i0, j)], width(part), &made[inTile(part.i0, j)]);
    return;
  }
  const int ti = part.i0 / kTileSide, tj = part.j0 / kTileSide;
  const TilePart& own =
      tiles_[static_cast<std::size_t>((tj - tile_box_.j0) * width(tile_box_) + ti - tile_box_.i0)];
  const CellTile& tile = cells_.tile(own.tile);
  const Spline& w = cells_.spline();
  const TexelBox box{part.i0 / side, part.j0 / side, part.i1 / side, part.j1 / side};
  bool with_parts = false;
  for (int sj = box.j0; sj < box.j1; ++sj) {
    std::array<std::array<float, kTileSide>, 3> row{}; // below, here, above
    for (int si = box.i0; si < box.i1; ++si) {
      const auto cell = static_cast<std::size_t>(sj % squares * squares + si % squares);
      with_parts = with_parts || tile.cells[cell].texels < side * side;
      std::array<float, 9> v;
      const std::array<std::size_t, 9> from = about(at(si, sj));
      for (std::size_t k = 0; k < 9; ++k) v[k] = values[from[k]];
      for (std::size_t k = 0; k < 3; ++k)
        for (int i = si % squares * side; i < (si % squares + 1) * side; ++i) {
          const auto n = static_cast<std::size_t>(i);
          row[k][n] = w[0][n] * v[3 * k] + w[1][n] * v[3 * k + 1] + w[2][n] * v[3 * k + 2];
        }
    }
    const int i0 = part.i0 % kTileSide, i1 = i0 + width(part);
    for (int j = sj % squares * side; j < (sj % squares + 1) * side; ++j) {
      const auto m = static_cast<std::size_t>(j);
      float* to = &made[m * kTileSide];
      const float low = w[0][m], here = w[1][m], high = w[2][m];
      for (int i = i0; i < i1; ++i) {
        const auto n = static_cast<std::size_t>(i);
        to[i] = low * row[0][n] + here * row[1][n] + high * row[2][n];
      }
    }
  }
  if (!with_parts) return;
  for (int j = part.j0; j < part.j1; ++j)
    for (int i = part.i0; i < part.i1; ++i) {
      const std::int16_t held = tile.cell_of[inTile(i, j)];
      const auto c = static_cast<std::size_t>(held);
      if (held < squares * squares) continue;
      const std::array<std::size_t, 9> from = about(placeOf(own, c));
      float sum = 0;
      for (std::size_t k = 0; k < 9; ++k)
        sum += w[k % 3][static_cast<std::size_t>(i % kTileSide)] *
               w[k / 3][static_cast<std::size_t>(j % kTileSide)] * values[from[k]];
      made[inTile(i, j)] = sum;
    }
}

} // namespace patina
