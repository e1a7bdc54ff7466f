// The servo's form of a Fourier texture, against sums in quadruple precision (A19 to A21).
#include "scene/fourier/texture_evaluator.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/fourier/felt_texture.h"
#include "support/least_time.h"

namespace patina {
namespace {

__extension__ using Quad = __float128;

// cos and sin by their series, of an angle that is first brought to [-pi/4, pi/4] by halving.
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
  texture.low = leastHeight(texture);
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
    for (const double tolerance : {0., 1e-12, 1e-5}) {
      const TextureEvaluator at(texture, tolerance);
      const double allowed = std::max(tolerance, 1e-12);
      std::mt19937 random(7);
      std::uniform_real_distribution<double> any(-0.2, 0.2);
      for (int i = 0; i < 2000; ++i) {
        const double x = any(random);
        const Sum due = sumAt(texture, x);
        const TextureValue got = at.at(x);
        ASSERT_NEAR(got.height, due.height, allowed * high) << n << " " << tolerance << " " << x;
        ASSERT_NEAR(got.gradient.x(), due.slope, allowed * steep);
        ASSERT_EQ(got.gradient.y(), 0);
      }
    }
  }
}

// T-A19d
TEST(TextureEvaluator, KnowsItsPhaseAfterABillionPeriods) {
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

TEST(TextureEvaluator, OfAPlaneIsTheSumOfItsTerms) {
  const FourierTexture texture = planeOf(12, 2);
  const double high = rmsHeight(texture), steep = rmsSlope(texture);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-0.05, 0.05);
  for (const double tolerance : {1e-12, 1e-5}) {
    const TextureEvaluator at(texture, tolerance);
    for (int i = 0; i < 500; ++i) {
      const double x = any(random), y = any(random);
      ASSERT_NEAR(at.at(x, y).height, height(texture, x, y), 2 * tolerance * high + 1e-13 * high);
      ASSERT_LT((at.at(x, y).gradient - gradient(texture, x, y)).norm(),
                2 * tolerance * steep + 1e-13 * steep);
    }
  }
}

// Products and drawn spectra through their tables, and a whole plane of 128 harmonics.
TEST(TextureEvaluator, OfProductsAndSpectraIsTheSumOfTheirTerms) {
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
  products.low = leastHeight(products);
  FourierTexture spectrum;
  spectrum.kind = TextureKind::spectrum;
  spectrum.omega = 300;
  spectrum.seed = 5;
  for (int j = 1; j <= 24; ++j) spectrum.series.a.push_back(1e-5 / j);
  spectrum.low = leastHeight(spectrum);
  for (const FourierTexture& texture : {products, spectrum})
    for (const double tolerance : {1e-12, 1e-5}) {
      const TextureEvaluator table(texture, tolerance);
      const double most = std::max(2 * tolerance, 4e-13);
      for (int i = 0; i < 500; ++i) {
        const double x = 0.01 * normal(random), y = 0.01 * normal(random);
        const TextureValue at = table.at(x, y);
        ASSERT_NEAR(at.height, height(texture, x, y), most * rmsHeight(texture));
        ASSERT_LT((at.gradient - gradient(texture, x, y)).norm(), most * rmsSlope(texture));
      }
    }
}

TEST(TextureEvaluator, OfAWholePlaneIsTheSumOfItsTerms) {
  std::mt19937 random(13);
  std::normal_distribution<double> normal;
  FourierTexture plane;
  plane.kind = TextureKind::plane;
  plane.omega = 2 * std::numbers::pi / 0.05;
  plane.plane.resize(257 * 257);
  for (double& each : plane.plane) each = 1e-7 * normal(random);
  plane.plane[0] = 0;
  plane.low = leastHeight(plane);
  for (const double tolerance : {1e-12, 1e-5}) {
    const TextureEvaluator table(plane, tolerance);
    const double most = std::max(2 * tolerance, 4e-12); // rounding of 66,000 terms
    for (int i = 0; i < 20; ++i) {
      const double x = 0.02 * normal(random), y = 0.02 * normal(random);
      const TextureValue at = table.at(x, y);
      EXPECT_NEAR(at.height, height(plane, x, y), most * rmsHeight(plane));
      EXPECT_LT((at.gradient - gradient(plane, x, y)).norm(), most * rmsSlope(plane));
    }
  }
}

// A factor that is the same everywhere asks for no finer a table than any other.
TEST(TextureEvaluator, OfAProductWithAConstantIsSmall) {
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
  texture.low = leastHeight(texture);
  const TextureEvaluator table(texture);
  FourierTexture line = texture;
  line.kind = TextureKind::line;
  line.series = wave;
  line.products.clear();
  EXPECT_LT(table.bytes(), 2 * TextureEvaluator(line).bytes());
  for (int i = 0; i < 100; ++i)
    EXPECT_NEAR(table.at(1e-4 * i, 3e-4 * i).height, height(texture, 1e-4 * i, 3e-4 * i), 1e-17);
}

TEST(TextureEvaluator, TheGradientIsTheHeightsDerivative) {
  const FourierTexture texture = lineOf(128, 9);
  const TextureEvaluator at(texture);
  for (int i = 0; i < 200; ++i) {
    const double x = 1e-4 * i, d = 1e-8;
    EXPECT_NEAR((at.at(x + d).height - at.at(x - d).height) / (2 * d), at.at(x).gradient.x(),
                1e-5 * rmsSlope(texture));
  }
}

TEST(FeltTexture, RefusesALowThatIsNotItsLowest) {
  FourierTexture texture = lineOf(8, 1);
  EXPECT_NO_THROW(feltTexture(texture));
  const double low = texture.low;
  for (const double wrong : {-1., 2 * low, 0.3 * low, 0.}) {
    texture.low = wrong;
    EXPECT_THROW(feltTexture(texture), Error) << wrong;
  }
  FourierTexture plane = planeOf(6, 3);
  plane.low = leastHeight(plane);
  EXPECT_NO_THROW(feltTexture(plane));
}

TEST(TextureEvaluator, WhereThereIsNoPlaceThereIsAValue) {
  const TextureEvaluator at(lineOf(8, 1));
  for (const double x : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300})
    EXPECT_EQ(at.at(x).height, at.at(0).height);
  EXPECT_THROW(TextureEvaluator(FourierTexture{}), Error);
  EXPECT_THROW(TextureEvaluator(lineOf(8, 1), 1.5), Error);
}

PATINA_TIMED_TEST(TextureEvaluator, IsFarQuickerThanTheSum) {
  const FourierTexture line = lineOf(128, 4), plane = planeOf(128, 4);
  const TextureEvaluator fast(line), exact(plane), quick(plane, 1e-5);
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
        // Every term by itself.
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
      test::leastSeconds({many(fast, 4000), direct(line, 400), many(exact, 400), direct(plane, 20),
                          many(quick, 4000)});
  const double line_ratio = t[0] / 4000 / (t[1] / 400), plane_ratio = t[2] / 400 / (t[3] / 20),
               quick_ratio = t[4] / 4000 / (t[3] / 20);
  std::printf("line %.1f ns of %.0f; plane %.2f us of %.1f, to 1e-5 %.1f ns\n", t[0] / 4000 * 1e9,
              t[1] / 400 * 1e9, t[2] / 400 * 1e6, t[3] / 20 * 1e6, t[4] / 4000 * 1e9);
  EXPECT_LE(line_ratio, 0.1);
  EXPECT_LE(plane_ratio, 1);
  EXPECT_LE(quick_ratio, 0.02);
}

} // namespace
} // namespace patina
