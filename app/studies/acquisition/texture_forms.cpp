#include "app/studies/acquisition/texture_forms.h"

#include <cmath>
#include <numbers>
#include <random>

#include "acquisition/simulation/simulated_surface.h"
#include "acquisition/texture/fit_texture.h"
#include "app/studies/query_timing.h"
#include "scene/fourier/exact_phase.h"
#include "scene/fourier/series_cells.h"
#include "scene/fourier/texture_evaluator.h"

namespace patina {
namespace {

__extension__ using Quad = __float128;

// omega x less whole turns, to 1e-24.
long double truePhase(double omega, double x) {
  const Quad turn =
      2 * (static_cast<Quad>(std::numbers::pi) + static_cast<Quad>(1.22464679914735317636e-16) +
           static_cast<Quad>(-2.99476980971833966530e-33));
  const Quad angle = static_cast<Quad>(omega) * static_cast<Quad>(x);
  return static_cast<long double>(angle - turn * std::nearbyint(static_cast<double>(angle / turn)));
}

double trueSum(const FourierSeries& series, double omega, double x) {
  const long double phase = truePhase(omega, x);
  long double sum = series.mean;
  for (std::size_t i = 0; i < series.a.size(); ++i) {
    const long double angle = static_cast<long double>(i + 1) * phase;
    sum += series.a[i] * std::cos(angle) + series.b[i] * std::sin(angle);
  }
  return static_cast<double>(sum);
}

FourierTexture milledTexture(std::uint32_t seed, int harmonics) {
  FitOptions1d options;
  options.harmonics = harmonics;
  return fitTexture(milledPoints(seed), options).texture;
}

template <class Point, class Form>
WorkPrecisionRow measured(const std::vector<Point>& places, const std::vector<double>& due,
                          double rms, const Form& form, int passes) {
  WorkPrecisionRow row;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double off = std::abs(form(places[i]).value - due[i]) / rms;
    row.error += off * off / static_cast<double>(places.size());
    row.error_max = std::max(row.error_max, off);
  }
  row.error = std::sqrt(row.error);
  row.ns = nsPerQuery(
      places,
      [&](const Point& place) {
        const SeriesValue sum = form(place);
        return sum.value + sum.slope;
      },
      passes);
  return row;
}

FourierTexture planeOf(const FourierTexture& products) {
  FourierTexture plane = products;
  plane.kind = TextureKind::plane;
  plane.products.clear();
  const auto terms = [](const FourierSeries& series) {
    std::vector<double> all{series.mean};
    for (std::size_t i = 0; i < series.a.size(); ++i) {
      all.push_back(series.a[i]);
      all.push_back(series.b[i]);
    }
    return all;
  };
  const std::vector<double> along_x = terms(products.products[0].along_x);
  for (const double p : terms(products.products[0].along_y))
    for (const double q : along_x) plane.plane.push_back(p * q);
  return plane;
}

} // namespace

std::vector<ProfilePoint> milledPoints(std::uint32_t seed) {
  constexpr double kLength = 28e-3, kStep = 5e-6;
  std::vector<ProfilePoint> points;
  for (const double height : milledProfile(seed, kLength, kStep))
    points.push_back({kStep * static_cast<double>(points.size()), height, 0});
  return points;
}

WorkPrecisionTable lineForms(const StudyOptions& options, Progress& progress) {
  WorkPrecisionTable table = tableOf(
      "Height and slope of 128 harmonics so many periods away (T-A19d), against a sum in long "
      "double of a phase in quadruple precision",
      "of rms");
  const FourierTexture texture = milledTexture(3, 128);
  const FourierSeries& series = texture.series;
  const double omega = texture.omega, rms = rmsHeight(texture);
  const RotatedSeries rotated(series);
  const SeriesCells cells(series, 1e-12 * rms, 1e-12 * rmsSlope(texture) / omega, 1);
  const TextureEvaluator fine(texture, 1e-12), coarse(texture, 1e-5);
  const auto ask = [](const TextureEvaluator& at) {
    return [&at](double x) {
      const TextureValue value = at.at(x);
      return SeriesValue{value.height, value.gradient.x()};
    };
  };
  for (const double periods : {1., 1e6, 1e9}) {
    progress.throwIfCancelled();
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(0, 1);
    std::vector<double> places, due;
    for (int i = 0; i < (options.quick ? 300 : 3000); ++i) {
      places.push_back((periods + any(random)) * period(texture));
      due.push_back(trueSum(series, omega, places.back()));
    }
    const auto add = [&](const char* form, const char* phase, double bytes, const auto& sum) {
      WorkPrecisionRow row = measured(places, due, rms, sum, 7);
      row.knobs = {{"form", form}, {"phase", phase}, {"periods", periods}};
      row.bytes = bytes;
      table.rows.push_back(row);
    };
    const auto coefficients = static_cast<double>(16 * series.a.size());
    add("direct", "double", coefficients, [&](double x) { return sumDirectly(series, omega * x); });
    add("direct", "exact", coefficients,
        [&](double x) { return sumDirectly(series, exactPhase(x, omega)); });
    add("rotated", "exact", static_cast<double>(rotated.bytes()),
        [&](double x) { return rotated.at(exactPhase(x, omega)); });
    add("table 1e-12", "double", static_cast<double>(cells.bytes()),
        [&](double x) { return cells.at(std::remainder(omega * x, kTurn)); });
    add("table 1e-12", "exact", static_cast<double>(fine.bytes()), ask(fine));
    add("table 1e-5", "exact", static_cast<double>(coarse.bytes()), ask(coarse));
  }
  return table;
}

WorkPrecisionTable planeForms(const StudyOptions& options, Progress& progress) {
  WorkPrecisionTable table = tableOf("Height and gradient of N x N harmonics (A21), against the "
                                     "product of two sums in long double",
                                     "of rms");
  for (const int n : {16, 32, 64, 128}) {
    const FourierTexture products = crossCorrelation(milledTexture(3, n), milledTexture(4, n)),
                         plane = planeOf(products);
    const FourierProduct& product = products.products[0];
    const double rms = rmsHeight(products);
    std::mt19937 random(6);
    std::uniform_real_distribution<double> any(-10, 10);
    std::vector<Vec2> places;
    std::vector<double> due;
    for (int i = 0; i < (options.quick ? 100 : 1000); ++i) {
      const double x = any(random) * period(plane), y = any(random) * period(plane);
      places.emplace_back(x, y);
      due.push_back(trueSum(product.along_x, plane.omega, x) *
                    trueSum(product.along_y, plane.omega, y));
    }
    const auto add = [&](const char* form, double bytes, double seconds, const auto& sum) {
      progress.throwIfCancelled();
      WorkPrecisionRow row = measured(places, due, rms, sum, options.quick ? 3 : 7);
      row.knobs = {{"form", form}, {"N", n}};
      row.bytes = bytes;
      row.more = {{"made in [ms]", 1e3 * seconds}};
      table.rows.push_back(row);
    };
    add("direct", static_cast<double>(8 * plane.plane.size()), 0, [&](const Vec2& p) {
      const Vec2 slopes = gradient(plane, p.x(), p.y());
      return SeriesValue{height(plane, p.x(), p.y()), slopes.x() + slopes.y()};
    });
    const auto addTable = [&](const char* form, const FourierTexture& texture, double tolerance) {
      const double begin = threadSeconds();
      const TextureEvaluator at(texture, tolerance);
      const double seconds = threadSeconds() - begin;
      add(form, static_cast<double>(at.bytes()), seconds, [&](const Vec2& p) {
        const TextureValue value = at.at(p.x(), p.y());
        return SeriesValue{value.height, value.gradient.sum()};
      });
    };
    addTable("rows, rotated", plane, 0);
    addTable("products, table 1e-12", products, 1e-12);
    addTable("window 1e-12", plane, 1e-12);
    addTable("cells 1e-5", plane, 1e-5);
  }
  return table;
}

} // namespace patina
