// The servo's evaluator of a Fourier texture, against sums in quadruple precision (A19 to A21).
#include "scene/fourier/texture_evaluator.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/fourier/haptic_texture.h"
#include "scene/fourier/reduced_phase.h"
#include "support/least_time.h"

namespace patina {
namespace {

__extension__ using Quad = __float128;

// cos and sin by their series, after halving the angle into [-pi/4, pi/4].
struct Turn {
  Quad cosine, sine;
};
Turn turnOf(Quad angle) {
  const Quad pi = static_cast<Quad>(3.14159265358979311600e0) +
                  static_cast<Quad>(1.22464679914735317636e-16) +
                  static_cast<Quad>(-2.99476980971833966530e-33);
  const auto turns = static_cast<long long>(static_cast<double>(angle / (2 * pi)));
  angle -= static_cast<Quad>(turns) * 2 * pi;
  angle /= 1024;
  Quad term = 1, cosine = 0, sine = 0;
  for (int n = 0; n < 24; n += 2) {
    cosine += term;
    term *= angle / (n + 1);
    sine += term;
    term *= -angle / (n + 2);
  }
  for (int i = 0; i < 10; ++i) {
    const Quad c = cosine * cosine - sine * sine;
    sine = 2 * sine * cosine;
    cosine = c;
  }
  return {cosine, sine};
}

struct Sum {
  double height, slope;
};
Sum sumAt(const FourierTexture& texture, double x) {
  const Turn one = turnOf(static_cast<Quad>(texture.omega) * static_cast<Quad>(x));
  Quad c = 1, s = 0, height = 0, slope = 0;
  for (std::size_t j = 0; j < texture.series.a.size(); ++j) {
    const Quad next = c * one.cosine - s * one.sine;
    s = s * one.cosine + c * one.sine;
    c = next;
    const Quad a = texture.series.a[j], b = texture.series.b[j],
               w = static_cast<Quad>(texture.omega) * static_cast<int>(j + 1);
    height += a * c + b * s;
    slope += w * (b * c - a * s);
  }
  return {static_cast<double>(height), static_cast<double>(slope)};
}

FourierTexture lineOf(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1e-5);
  FourierTexture texture;
  texture.omega = 2 * std::numbers::pi / 0.0307;
  for (int j = 0; j < n; ++j) {
    texture.series.a.push_back(normal(random) / std::sqrt(j + 1.0));
    texture.series.b.push_back(normal(random) / std::sqrt(j + 1.0));
  }
  texture.low = minHeight(texture);
  return texture;
}

FourierTexture planeOf(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1e-5);
  FourierTexture texture;
  texture.kind = TextureKind::plane;
  texture.omega = 2 * std::numbers::pi / 0.02;
  for (int i = 0; i < (2 * n + 1) * (2 * n + 1); ++i) texture.plane.push_back(normal(random) / n);
  return texture;
}

TEST(TextureEvaluator, IsTheSumOfAllTermsToTwelveDigits) {
  for (const int n : {1, 5, 128}) {
    const FourierTexture texture = lineOf(n, static_cast<unsigned>(n));
    const double high = rmsHeight(texture), steep = rmsSlope(texture);
    const TextureEvaluator at(texture);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-0.2, 0.2);
    for (int i = 0; i < 2000; ++i) {
      const double x = any(random);
      const Sum due = sumAt(texture, x);
      const TextureValue got = at.at(x);
      ASSERT_NEAR(got.height, due.height, 1e-12 * high) << n << " " << x;
      ASSERT_NEAR(got.gradient.x(), due.slope, 1e-12 * steep);
      ASSERT_EQ(got.gradient.y(), 0);
    }
  }
}

// T-A19d
TEST(TextureEvaluator, KeepsItsPhaseAfterABillionPeriods) {
  const FourierTexture texture = lineOf(128, 3);
  const TextureEvaluator at(texture);
  const double high = rmsHeight(texture);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(0, 1);
  for (const double periods : {1e3, 1e6, 1e9})
    for (int i = 0; i < 500; ++i) {
      const double x = (periods + any(random)) * period(texture);
      ASSERT_NEAR(at.at(x).height, sumAt(texture, x).height, 1e-12 * high) << periods;
      ASSERT_NEAR(at.at(-x).height, sumAt(texture, -x).height, 1e-12 * high) << periods;
    }
}

TEST(TextureEvaluator, IsTheSumOfTermsForAPlane) {
  const FourierTexture texture = planeOf(12, 2);
  const double high = rmsHeight(texture), steep = rmsSlope(texture);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-0.05, 0.05);
  const TextureEvaluator at(texture);
  for (int i = 0; i < 500; ++i) {
    const double x = any(random), y = any(random);
    ASSERT_NEAR(at.at(x, y).height, height(texture, x, y), 1e-12 * high);
    ASSERT_LT((at.at(x, y).gradient - gradient(texture, x, y)).norm(), 1e-12 * steep);
  }
}

// Products and drawn spectra through their tables, and a whole plane of 128 harmonics.
TEST(TextureEvaluator, IsTheSumOfTermsForProductsAndSpectra) {
  std::mt19937 random(12);
  std::normal_distribution<double> normal;
  const auto series = [&](double scale) {
    FourierSeries drawn;
    for (int j = 1; j <= 24; ++j) {
      drawn.a.push_back(scale * normal(random) / j);
      drawn.b.push_back(scale * normal(random) / j);
    }
    return drawn;
  };
  FourierTexture products;
  products.kind = TextureKind::products;
  products.omega = 300;
  products.products = {{series(1), series(1e-5)}, {series(1), series(2e-5)}};
  products.low = minHeight(products);
  FourierTexture spectrum;
  spectrum.kind = TextureKind::spectrum;
  spectrum.omega = 300;
  spectrum.seed = 5;
  for (int j = 1; j <= 24; ++j) spectrum.series.a.push_back(1e-5 / j);
  spectrum.low = minHeight(spectrum);
  for (const FourierTexture& texture : {products, spectrum}) {
    const TextureEvaluator table(texture);
    for (int i = 0; i < 500; ++i) {
      const double x = 0.01 * normal(random), y = 0.01 * normal(random);
      const TextureValue at = table.at(x, y);
      ASSERT_NEAR(at.height, height(texture, x, y), 2e-12 * rmsHeight(texture));
      ASSERT_LT((at.gradient - gradient(texture, x, y)).norm(), 2e-12 * rmsSlope(texture));
    }
  }
}

// Each term in long double with phases in quadruple precision; the gradient by the phases.
struct PlaneSum {
  double height;
  Vec2 gradient;
};
PlaneSum planeSumAt(const FourierTexture& texture, double x, double y) {
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(texture.plane.size())));
  const auto terms = [&](double at, std::vector<long double>& u, std::vector<long double>& du) {
    const Turn one = turnOf(static_cast<Quad>(texture.omega) * static_cast<Quad>(at));
    u = {1};
    du = {0};
    Quad c = 1, s = 0;
    for (std::size_t j = 1; 2 * j < side + 1; ++j) {
      const Quad next = c * one.cosine - s * one.sine;
      s = s * one.cosine + c * one.sine;
      c = next;
      const auto n = static_cast<long double>(j);
      for (const Quad value : {c, s}) u.push_back(static_cast<long double>(value));
      for (const long double value : {-static_cast<long double>(s), static_cast<long double>(c)})
        du.push_back(n * value);
    }
  };
  std::vector<long double> ux, dux, uy, duy;
  terms(x, ux, dux);
  terms(y, uy, duy);
  long double sum = 0, along_x = 0, along_y = 0;
  for (std::size_t r = 0; r < side; ++r)
    for (std::size_t c = 0; c < side; ++c) {
      if (r + c == 0) continue;
      const long double term = texture.plane[r * side + c];
      sum += uy[r] * ux[c] * term;
      along_x += uy[r] * dux[c] * term;
      along_y += duy[r] * ux[c] * term;
    }
  return {static_cast<double>(sum),
          texture.omega * Vec2(static_cast<double>(along_x), static_cast<double>(along_y))};
}

// Equal harmonics, and those of a rough surface; also after a billion periods.
TEST(TextureEvaluator, IsTheSumOfTermsOverAWholePlane) {
  for (const double falls : {0., 1.}) {
    FourierTexture plane = planeOf(128, 13);
    for (std::size_t i = 0; i < plane.plane.size(); ++i)
      plane.plane[i] /= std::pow(1. + std::hypot((i % 257 + 1) / 2, (i / 257 + 1) / 2), falls);
    const double high = rmsHeight(plane), steep = rmsSlope(plane);
    const TextureEvaluator table(plane);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-1, 1);
    double worst = 0, worst_slope = 0;
    for (int i = 0; i < 300; ++i) {
      const double reach = (i % 3 ? 1. : 1e9) * period(plane);
      const double x = reach * any(random), y = reach * any(random);
      const TextureValue at = table.at(x, y);
      const PlaneSum due = planeSumAt(plane, x, y);
      worst = std::max(worst, std::abs(at.height - due.height) / high);
      worst_slope = std::max(worst_slope, (at.gradient - due.gradient).norm() / steep);
    }
    std::printf("falling %.0f: height %.2e, gradient %.2e, %.1f MB\n", falls, worst, worst_slope,
                1e-6 * static_cast<double>(table.bytes()));
    EXPECT_LE(worst, 1e-12);
    EXPECT_LE(worst_slope, 1e-12);
  }
}

// Holds for any rounding of a ring's steps and of the product of position and frequency.
TEST(PeriodicCells, FindStepAndPositionFarAway) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-1, 1);
  for (const int steps : {1, 7, 8, 512, 4096})
    for (const double reach : {1., 1e4, 1e9})
      for (int i = 0; i < 300; ++i) {
        const double omega = 300 + any(random), x = any(random) * reach * kTwoPiHigh / omega;
        const CellPosition place = PeriodicCells(omega, steps).at(x);
        ASSERT_GE(place.step, 0);
        ASSERT_LT(place.step, steps);
        ASSERT_GE(place.fraction, -1e-9);
        ASSERT_LE(place.fraction, 1 + 1e-9);
        const Turn due = turnOf(static_cast<Quad>(omega) * static_cast<Quad>(x)),
                   got =
                       turnOf((static_cast<Quad>(place.step) + static_cast<Quad>(place.fraction)) *
                              2 * static_cast<Quad>(std::numbers::pi) / steps);
        ASSERT_NEAR(static_cast<double>(got.cosine), static_cast<double>(due.cosine), 2e-15);
        ASSERT_NEAR(static_cast<double>(got.sine), static_cast<double>(due.sine), 2e-15);
      }
}

// A constant factor needs no finer a table than any other.
TEST(TextureEvaluator, TableIsSmallForAProductWithAConstant) {
  FourierTexture texture;
  texture.kind = TextureKind::products;
  texture.omega = 300;
  FourierSeries wave, level;
  for (int j = 1; j <= 64; ++j) {
    wave.a.push_back(1e-5 / j);
    wave.b.push_back(0);
  }
  level.mean = 1;
  level.a.assign(64, 0);
  level.b.assign(64, 0);
  texture.products = {{wave, level}};
  texture.low = minHeight(texture);
  const TextureEvaluator table(texture);
  FourierTexture line = texture;
  line.kind = TextureKind::line;
  line.series = wave;
  line.products.clear();
  EXPECT_LT(table.bytes(), 2 * TextureEvaluator(line).bytes());
  for (int i = 0; i < 100; ++i)
    EXPECT_NEAR(table.at(1e-4 * i, 3e-4 * i).height, height(texture, 1e-4 * i, 3e-4 * i), 1e-17);
}

TEST(TextureEvaluator, GradientIsTheDerivativeOfTheHeight) {
  const FourierTexture texture = lineOf(128, 9);
  const TextureEvaluator at(texture);
  for (int i = 0; i < 200; ++i) {
    const double x = 1e-4 * i, d = 1e-8;
    EXPECT_NEAR((at.at(x + d).height - at.at(x - d).height) / (2 * d), at.at(x).gradient.x(),
                1e-5 * rmsSlope(texture));
  }
}

TEST(HapticTexture, RejectsALowThatDiffersFromItsMinimum) {
  FourierTexture texture = lineOf(8, 1);
  EXPECT_NO_THROW(hapticTexture(texture));
  const double low = texture.low;
  for (const double wrong : {-1., 2 * low, 0.3 * low, 0.}) {
    texture.low = wrong;
    EXPECT_THROW(hapticTexture(texture), Error) << wrong;
  }
  FourierTexture plane = planeOf(6, 3);
  plane.low = minHeight(plane);
  EXPECT_NO_THROW(hapticTexture(plane));
}

TEST(TextureEvaluator, ReturnsAValueForNonFiniteCoordinates) {
  const TextureEvaluator at(lineOf(8, 1));
  for (const double x : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300})
    EXPECT_EQ(at.at(x).height, at.at(0).height);
  EXPECT_THROW(TextureEvaluator(FourierTexture{}), Error);
}

TEST(TextureEvaluator, IsZeroWithoutWaves) {
  FourierTexture line, plane, products;
  line.omega = plane.omega = products.omega = 300;
  line.series = {1e-3, {0, 0}, {0, 0}};
  plane.kind = TextureKind::plane;
  plane.plane.assign(9, 0);
  products.kind = TextureKind::products;
  products.products = {{{2, {0}, {0}}, {1e-3, {0}, {0}}}};
  for (const FourierTexture& flat : {line, plane, products}) {
    const TextureValue at = TextureEvaluator(flat).at(0.01, 0.02);
    EXPECT_EQ(at.height, 0);
    EXPECT_EQ(at.gradient, Vec2::Zero());
  }
}

PATINA_TIMED_TEST(TextureEvaluator, IsFarQuickerThanTheSum) {
  const FourierTexture line = lineOf(128, 4), plane = planeOf(128, 4);
  const TextureEvaluator fast(line), exact(plane);
  volatile double kept = 0;
  const auto many = [&](const TextureEvaluator& at, int times) {
    return [&kept, &at, times] {
      double sum = 0;
      for (int i = 0; i < times; ++i) sum += at.at(1e-5 * i, 2e-5 * i).height;
      kept = sum;
    };
  };
  const auto direct = [&](const FourierTexture& texture, int times) {
    return [&kept, &texture, times] {
      double sum = 0;
      for (int i = 0; i < times; ++i) {
        // Each term is evaluated separately.
        const double x = 1e-5 * i, y = 2e-5 * i;
        if (texture.kind == TextureKind::line) {
          for (std::size_t j = 0; j < texture.series.a.size(); ++j) {
            const double angle = texture.omega * static_cast<double>(j + 1) * x;
            sum += texture.series.a[j] * std::cos(angle) + texture.series.b[j] * std::sin(angle);
          }
          continue;
        }
        const auto side = static_cast<std::size_t>(std::sqrt(texture.plane.size()));
        const auto u = [&](std::size_t k, double at) {
          const double angle = texture.omega * static_cast<double>((k + 1) / 2) * at;
          return k == 0 ? 1 : k % 2 ? std::cos(angle) : std::sin(angle);
        };
        std::vector<double> ux(side), uy(side);
        for (std::size_t k = 0; k < side; ++k) {
          ux[k] = u(k, x);
          uy[k] = u(k, y);
        }
        for (std::size_t r = 0; r < side; ++r)
          for (std::size_t c = 0; c < side; ++c) sum += uy[r] * ux[c] * texture.plane[r * side + c];
      }
      kept = sum;
    };
  };
  const std::vector<double> t =
      test::minSeconds({many(fast, 4000), direct(line, 400), many(exact, 4000), direct(plane, 20)});
  const double line_ratio = t[0] / 4000 / (t[1] / 400), plane_ratio = t[2] / 4000 / (t[3] / 20);
  std::printf("line %.1f ns of %.0f; plane %.2f us of %.1f\n", t[0] / 4000 * 1e9, t[1] / 400 * 1e9,
              t[2] / 4000 * 1e6, t[3] / 20 * 1e6);
  EXPECT_LE(line_ratio, 0.1);
  EXPECT_LE(plane_ratio, 1 / 25.);
}

} // namespace
} // namespace patina
