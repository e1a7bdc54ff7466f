#include "authoring/relief/relief_window.h"

#include <cmath>

#include <tbb/parallel_for.h>

namespace patina {
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

// visit(cell, place) of those that are shown.
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
  // The tile where a neighbour of a cell lies: its own, or the next one.
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

// The lesser of two conductances: the cells' own rates bound the spectrum.
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
      link(kRising, next_[east][kToNorth], place + stride_ + 1, &Conductance::rising);
    if (west != place && next_[west][kToNorth] != west)
      link(kFalling, next_[west][kToNorth], place + stride_ - 1, &Conductance::falling);
  });
}

// The nine places about one, i fastest, as far as there are neighbours: what would go on beyond a
// chart's edge stays at it.
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

// Of the values of a cell's texels and of 1, by the spline's weights for the cells about: i
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
    // Columns first, all of a row at once.
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

std::vector<float> ReliefWindow::gathered(const TiledImage& image) const {
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

void ReliefWindow::spread(const std::vector<float>& values, const TexelBox& part,
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
    std::array<std::array<float, kTileSide>, 3> row{}; // along i, by the squares below, here, above
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
