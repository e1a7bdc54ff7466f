#include "scene/fourier/fourier_texture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/fourier/reduced_phase.h"
#include "scene/fourier/series_sum.h"

namespace patina {
namespace {

bool areFinite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

std::string problemOfSeries(const FourierSeries& series, std::size_t due) {
  if (series.a.size() != series.b.size()) return "a and b are not equally long";
  if (series.a.size() != due) return "series are not equally long";
  if (!std::isfinite(series.mean) || !areFinite(series.a) || !areFinite(series.b))
    return "a coefficient is not a finite number";
  return {};
}

std::string problemOfTerms(const FourierTexture& texture) {
  switch (texture.kind) {
  case TextureKind::line:
    if (texture.series.a.empty()) return "there are no harmonics";
    return problemOfSeries(texture.series, texture.series.a.size());
  case TextureKind::spectrum:
    if (texture.series.a.empty()) return "there are no harmonics";
    if (!texture.series.b.empty()) return "a spectrum has amplitudes only, no b";
    for (const double amplitude : texture.series.a)
      if (!(amplitude >= 0) || !std::isfinite(amplitude))
        return "an amplitude is negative or not a finite number";
    return {};
  case TextureKind::products:
    if (texture.products.empty() || texture.products[0].along_x.a.empty())
      return "there are no harmonics";
    for (const FourierProduct& product : texture.products)
      for (const FourierSeries* series : {&product.along_x, &product.along_y})
        if (std::string problem = problemOfSeries(*series, texture.products[0].along_x.a.size());
            !problem.empty())
          return problem;
    return {};
  case TextureKind::plane:
    break;
  }
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(texture.plane.size())));
  if (side < 3) return "there are no harmonics";
  if (side % 2 == 0 || side * side != texture.plane.size())
    return "the plane's coefficients are not a square of an odd side";
  return areFinite(texture.plane) ? "" : "a coefficient is not a finite number";
}

// SplitMix64 (Steele, Lea & Flood 2014): the same numbers on every machine.
double drawnTurn(std::uint64_t& state) {
  std::uint64_t z = state += 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

using Terms = Eigen::VectorXd;

struct PlaneTerms {
  Terms u, slopes;
  PlaneTerms(double phase, int count) : u(2 * count + 1), slopes(2 * count + 1) {
    fillTerms(phase, count, u.data(), slopes.data());
  }
};

using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Height and gradient by the phases, summed term by term.
struct Place {
  double height = 0;
  Vec2 gradient = Vec2::Zero();
};

class Heights {
 public:
  explicit Heights(const FourierTexture& texture)
      : texture_(texture), count_(harmonics(texture)), series_(seriesOf(texture)) {}

  bool isFlatAlongY() const { return !series_.a.empty(); }

  Place at(double x, double y) const {
    if (isFlatAlongY()) {
      const SeriesValue sum = sumDirectly(series_, x);
      return {sum.value - series_.mean, {sum.slope, 0}};
    }
    Place place;
    if (texture_.kind == TextureKind::products) {
      for (const FourierProduct& product : texture_.products) {
        const SeriesValue q = sumDirectly(product.along_x, x), p = sumDirectly(product.along_y, y);
        place.height += p.value * q.value - product.along_x.mean * product.along_y.mean;
        place.gradient += Vec2(p.value * q.slope, p.slope * q.value);
      }
      return place;
    }
    const PlaneTerms u(x, count_), v(y, count_);
    const Eigen::Map<const Square> plane(texture_.plane.data(), u.u.size(), u.u.size());
    const Terms along_y = plane * u.u;
    return {v.u.dot(along_y) - plane(0, 0), {v.u.dot(plane * u.slopes), v.slopes.dot(along_y)}};
  }

  // Samples a period at n by n points (1 row if it does not depend on y), row by row.
  Square samples(int n) const {
    Square terms(n, 2 * count_ + 1), slopes(1, 2 * count_ + 1);
    for (int i = 0; i < n; ++i)
      fillTerms(2 * std::numbers::pi * i / n, count_, terms.row(i).data(), slopes.data());
    const auto onPlaces = [&](const FourierSeries& series) {
      Terms coefficients(2 * count_ + 1);
      coefficients[0] = series.mean;
      for (int j = 0; j < count_; ++j) {
        coefficients[2 * j + 1] = series.a[static_cast<std::size_t>(j)];
        coefficients[2 * j + 2] = series.b[static_cast<std::size_t>(j)];
      }
      return Terms(terms * coefficients);
    };
    if (isFlatAlongY()) return onPlaces(series_).transpose().array() - series_.mean;
    if (texture_.kind == TextureKind::products) {
      Square heights = Square::Zero(n, n);
      for (const FourierProduct& product : texture_.products) {
        heights += onPlaces(product.along_y) * onPlaces(product.along_x).transpose();
        heights.array() -= product.along_x.mean * product.along_y.mean;
      }
      return heights;
    }
    const Eigen::Map<const Square> plane(texture_.plane.data(), terms.cols(), terms.cols());
    return (terms * plane * terms.transpose()).array() - plane(0, 0);
  }

 private:
  const FourierTexture& texture_;
  int count_;
  FourierSeries series_;
};

// Descends by steps along the axes, halved when no neighbour is lower.
double bottomFrom(const Heights& heights, double x, double y, double step) {
  double least = heights.at(x, y).height;
  for (const double smallest = 1e-8 * step; step > smallest;) {
    const double before = least;
    for (const int to : {-1, 1}) {
      if (const double h = heights.at(x + to * step, y).height; h < least) {
        least = h;
        x += to * step;
      }
      if (heights.isFlatAlongY()) continue;
      if (const double h = heights.at(x, y + to * step).height; h < least) {
        least = h;
        y += to * step;
      }
    }
    if (!(least < before)) step /= 2;
  }
  return least;
}

double power(const FourierSeries& series, bool of_slope) {
  double sum = of_slope ? 0 : series.mean * series.mean;
  for (std::size_t i = 0; i < series.a.size(); ++i) {
    const double j = of_slope ? static_cast<double>(i + 1) : 1;
    sum += j * j * (series.a[i] * series.a[i] + series.b[i] * series.b[i]) / 2;
  }
  return sum;
}

// Returns the mean of the product of two series, or of their slopes by the phase.
double common(const FourierSeries& f, const FourierSeries& g, bool of_slope) {
  double sum = of_slope ? 0 : f.mean * g.mean;
  for (std::size_t i = 0; i < f.a.size(); ++i) {
    const double j = of_slope ? static_cast<double>(i + 1) : 1;
    sum += j * j * (f.a[i] * g.a[i] + f.b[i] * g.b[i]) / 2;
  }
  return sum;
}

// Mean squares of h and of its gradient by the phases.
struct Power {
  double height = 0, slope = 0;
};

Power powerOf(const FourierTexture& texture) {
  Power total;
  if (texture.kind == TextureKind::plane) {
    const auto side = static_cast<std::size_t>(2 * harmonics(texture) + 1);
    for (std::size_t r = 0; r < side; ++r)
      for (std::size_t c = 0; c < side; ++c) {
        if (r == 0 && c == 0) continue;
        const auto k = static_cast<double>((r + 1) / 2), j = static_cast<double>((c + 1) / 2);
        const double h = texture.plane[r * side + c];
        const double mean = h * h * (r > 0 ? 0.5 : 1) * (c > 0 ? 0.5 : 1);
        total.height += mean;
        total.slope += (j * j + k * k) * mean;
      }
  } else if (texture.kind == TextureKind::products) {
    double mean = 0;
    for (const FourierProduct& f : texture.products) {
      mean += f.along_x.mean * f.along_y.mean;
      for (const FourierProduct& g : texture.products) {
        const double x = common(f.along_x, g.along_x, false);
        const double y = common(f.along_y, g.along_y, false);
        total.height += x * y;
        total.slope += common(f.along_x, g.along_x, true) * y;
        total.slope += x * common(f.along_y, g.along_y, true);
      }
    }
    total.height = std::max(0.0, total.height - mean * mean);
  } else {
    const FourierSeries series = seriesOf(texture);
    total = {power(series, false) - series.mean * series.mean, power(series, true)};
  }
  return total;
}

} // namespace

std::string problemOf(const FourierTexture& texture) {
  if (!(texture.omega > 0) || !std::isfinite(texture.omega))
    return "the fundamental is not a positive number";
  if (texture.compliance && (!(*texture.compliance > 0) || !std::isfinite(*texture.compliance)))
    return "the compliance is not a positive number";
  if (!(texture.low <= 0) || !std::isfinite(texture.low)) return "low is not a number below 0";
  if (std::string problem = problemOfTerms(texture); !problem.empty()) return problem;
  const bool plane = texture.kind == TextureKind::products || texture.kind == TextureKind::plane;
  const int most = plane ? kMaxPlaneHarmonics : kMaxHarmonics;
  return harmonics(texture) <= most ? ""
                                    : "there are more than " + std::to_string(most) + " harmonics";
}

int harmonics(const FourierTexture& texture) {
  if (texture.kind == TextureKind::plane)
    return (static_cast<int>(std::lround(std::sqrt(texture.plane.size()))) - 1) / 2;
  const FourierSeries& series =
      texture.kind == TextureKind::products ? texture.products.front().along_x : texture.series;
  return static_cast<int>(series.a.size());
}

double period(const FourierTexture& texture) {
  return 2 * std::numbers::pi / texture.omega;
}

FourierSeries seriesOf(const FourierTexture& texture) {
  if (texture.kind == TextureKind::line) return texture.series;
  FourierSeries series;
  if (texture.kind != TextureKind::spectrum) return series;
  std::uint64_t state = texture.seed;
  for (const double amplitude : texture.series.a) {
    const double phase = 2 * std::numbers::pi * drawnTurn(state);
    series.a.push_back(amplitude * std::cos(phase));
    series.b.push_back(amplitude * std::sin(phase));
  }
  return series;
}

double height(const FourierTexture& texture, double x, double y) {
  return Heights(texture).at(reducePhase(x, texture.omega), reducePhase(y, texture.omega)).height;
}

Vec2 gradient(const FourierTexture& texture, double x, double y) {
  return texture.omega *
         Heights(texture).at(reducePhase(x, texture.omega), reducePhase(y, texture.omega)).gradient;
}

double slope(const FourierTexture& texture, double x) {
  return gradient(texture, x)[0];
}

double minHeight(const FourierTexture& texture) {
  constexpr std::size_t kFollowed = 8; // number of lowest samples refined
  const Heights heights(texture);
  const int n = (heights.isFlatAlongY() ? 16 : 8) * harmonics(texture);
  const Square samples = heights.samples(n);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(samples.size()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Eigen::Index>(i);
  const std::size_t followed = std::min(kFollowed, order.size());
  std::partial_sort(
      order.begin(), order.begin() + static_cast<std::ptrdiff_t>(followed), order.end(),
      [&](Eigen::Index i, Eigen::Index j) { return samples.data()[i] < samples.data()[j]; });
  const double step = 2 * std::numbers::pi / n;
  double least = 0;
  for (std::size_t i = 0; i < followed; ++i)
    least = std::min(least, bottomFrom(heights, static_cast<double>(order[i] % n) * step,
                                       static_cast<double>(order[i] / n) * step, step / 2));
  return least;
}

double rmsHeight(const FourierTexture& texture) {
  return std::sqrt(powerOf(texture).height);
}

double rmsSlope(const FourierTexture& texture) {
  return texture.omega * std::sqrt(powerOf(texture).slope);
}

} // namespace patina
