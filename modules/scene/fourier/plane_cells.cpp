#include "scene/fourier/plane_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/processor.h"
#include "core/types.h"

#define PATINA_KERNEL cells_plain
#include "scene/fourier/plane_cells_kernel.h"

namespace patina {

#if defined(__x86_64__)
namespace cells_avx2 {
PlaneValue lookInto(const ExactRing& ring, const void* cells, double x, double y) noexcept;
}
#endif

namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int kPowers = 8;
constexpr int kFewest = 8, kStep = 8; // cells a period
constexpr double kPeak = 5;           // errors over their root mean square

auto lookOfThisProcessor() {
#if defined(__x86_64__)
  if (hasAvx2()) return &cells_avx2::lookInto;
#endif
  return &cells_plain::lookInto;
}

// What a harmonic lacks over a cell, root mean squares over cell and phase; slope by the phase.
// exp(i r t) = sum of (2 - [n = 0]) i^n J_n(r) T_n(t), of which eight are kept.
struct Lack {
  double value, slope;
};
Lack lackOf(int harmonic, int cells) {
  const double half = std::numbers::pi / cells, next = 2 * std::cyl_bessel_j(8., harmonic * half);
  // Of T_8 a half, of its derivative 64 * 2.02: the mean of sin(8 a)^2 / sin(a) is 2.02.
  return {next * std::sqrt(0.5), next * std::sqrt(64 * 2.02) / half};
}

// Mean squares of a plane's harmonics, by their number along one axis: plain, and times the square
// of the number along the other.
struct Powers {
  std::vector<double> plain, steep;
};

Powers powersAlong(const Rows& plane, int harmonics) {
  Powers powers{std::vector<double>(static_cast<std::size_t>(harmonics + 1)),
                std::vector<double>(static_cast<std::size_t>(harmonics + 1))};
  for (int r = 0; r < plane.rows(); ++r)
    for (int c = 0; c < plane.cols(); ++c) {
      const double mean = (r > 0 ? 0.5 : 1) * (c > 0 ? 0.5 : 1) * plane(r, c) * plane(r, c);
      const int j = (c + 1) / 2, k = (r + 1) / 2;
      powers.plain[static_cast<std::size_t>(j)] += mean;
      powers.steep[static_cast<std::size_t>(j)] += mean * k * k;
    }
  return powers;
}

bool enough(const std::array<Powers, 2>& axes, int harmonics, int cells, double value_error,
            double slope_error) {
  double value = 0, slope = 0;
  for (int j = 1; j <= harmonics; ++j) {
    const Lack lack = lackOf(j, cells);
    for (const Powers& axis : axes) {
      const double plain = axis.plain[static_cast<std::size_t>(j)];
      value += lack.value * lack.value * plain;
      slope += lack.slope * lack.slope * plain +
               lack.value * lack.value * axis.steep[static_cast<std::size_t>(j)];
    }
  }
  return kPeak * std::sqrt(value) <= value_error && kPeak * std::sqrt(slope) <= slope_error;
}

// Of Chebyshev's polynomials: row n, column the power.
Eigen::Matrix<double, kPowers, kPowers> chebyshev() {
  Eigen::Matrix<double, kPowers, kPowers> t = Eigen::Matrix<double, kPowers, kPowers>::Zero();
  t(0, 0) = t(1, 1) = 1;
  for (int n = 2; n < kPowers; ++n) {
    t.row(n).tail<kPowers - 1>() = 2 * t.row(n - 1).head<kPowers - 1>();
    t.row(n) -= t.row(n - 2);
  }
  return t;
}

// Rows: cell upon cell its powers; columns the plane's terms 1, cos, sin, cos 2 ...
Rows powersOf(int harmonics, int cells) {
  const auto t = chebyshev();
  const double half = std::numbers::pi / cells;
  Rows out = Rows::Zero(kPowers * cells, 2 * harmonics + 1);
  for (int cell = 0; cell < cells; ++cell) out(kPowers * cell, 0) = 1;
  for (int j = 1; j <= harmonics; ++j) {
    std::array<double, kPowers> weight{}; // of i^power
    for (int n = 0; n < kPowers; ++n) {
      const double bessel = (n == 0 ? 1 : 2) * std::cyl_bessel_j(static_cast<double>(n), j * half);
      for (int power = n % 2; power <= n; power += 2)
        weight[static_cast<std::size_t>(power)] +=
            ((n - power) % 4 == 0 ? 1 : -1) * bessel * t(n, power);
    }
    for (int cell = 0; cell < cells; ++cell) {
      const double c = std::cos(j * (2 * cell + 1) * half), s = std::sin(j * (2 * cell + 1) * half);
      const std::array<double, 4> of_cos{c, -s, -c, s}, of_sin{s, c, -s, -c};
      for (int power = 0; power < kPowers; ++power) {
        const double w = weight[static_cast<std::size_t>(power)];
        out(kPowers * cell + power, 2 * j - 1) = w * of_cos[static_cast<std::size_t>(power % 4)];
        out(kPowers * cell + power, 2 * j) = w * of_sin[static_cast<std::size_t>(power % 4)];
      }
    }
  }
  return out;
}

} // namespace

std::optional<PlaneCells> PlaneCells::of(const std::vector<double>& plane, int harmonics,
                                         double omega, double value_error, double slope_error) {
  const int side = 2 * harmonics + 1;
  Rows coefficients = Eigen::Map<const Rows>(plane.data(), side, side);
  coefficients(0, 0) = 0;
  const std::array<Powers, 2> axes{powersAlong(coefficients, harmonics),
                                   powersAlong(coefficients.transpose(), harmonics)};
  int cells = kFewest;
  while (!enough(axes, harmonics, cells, value_error, slope_error)) {
    cells += kStep;
    if (sizeof(Cell) * static_cast<std::size_t>(cells * cells) > kMostBytes) return std::nullopt;
  }
  PlaneCells made;
  made.look_ = lookOfThisProcessor();
  made.ring_ = ExactRing(omega, cells);
  made.cells_.resize(static_cast<std::size_t>(cells * cells));
  const Rows powers = powersOf(harmonics, cells);
  const Rows along_x = coefficients * powers.transpose();
  Rows row(kPowers, along_x.cols());
  for (int y = 0; y < cells; ++y) {
    row.noalias() = powers.middleRows<kPowers>(kPowers * y) * along_x;
    for (int x = 0; x < cells; ++x) {
      Cell& cell = made.cells_[static_cast<std::size_t>(y * cells + x)];
      for (int i = 0; i < kPowers; ++i)
        for (int k = 0; k < kPowers; ++k)
          cell.power[i][k] = static_cast<float>(row(k, kPowers * x + i));
    }
  }
  return made;
}

PlaneValue PlaneCells::atPlainly(double x, double y) const noexcept {
  return cells_plain::lookInto(ring_, cells_.data(), x, y);
}

} // namespace patina
