#include "field/sampling/field_sampler.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "field/analytic_fields.h"

namespace patina {
namespace {

using namespace test;

constexpr double kSphereRadius = 0.05;
constexpr double kDegree = M_PI / 180;

double orderOf(double error_coarse, double error_fine) {
  return std::log2(error_coarse / error_fine);
}

// T-K01a: at a cell's centre the trilinear error on a sphere is h^2/(4 r), outwards always.
TEST(FieldSampler, TrilinearErrorOnASphereMatchesTheTheory) {
  const FieldGrid grid = cubeGrid(kSphereRadius, 150);
  const auto field = sampledField(sphereDistance(kSphereRadius), grid);
  const FieldSampler sampler(*field, Sampler::kim);
  std::mt19937 random(1);
  double worst = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vec3 q = grid.toGrid(randomDirection(random) * kSphereRadius);
    const Vec3 centre = q.array().floor() + 0.5;
    const double r = grid.toWorld(centre).norm() / grid.voxel;
    const double ratio = (sampler.phiAtGrid(centre) - (r - kSphereRadius / grid.voxel)) * 4 * r;
    worst = std::max(worst, std::abs(ratio - 1));
  }
  EXPECT_LT(worst, 1e-3); // the stored values are floats: 5e-7 of 4e-3 voxels
}

// T-K01b: a plane of any orientation is exact, up to the rounding of the stored floats.
TEST(FieldSampler, PlanesAreExact) {
  const FieldGrid grid = cubeGrid(kSphereRadius, 64);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> along(-0.6 * kSphereRadius, 0.6 * kSphereRadius);
  const double float_eps = std::numeric_limits<float>::epsilon();
  for (int n = 0; n < 5; ++n) {
    const Vec3 normal = randomDirection(random);
    const auto plane = [&](const Vec3& p) { return normal.dot(p); };
    const auto field = sampledField(plane, grid);
    for (const auto& [kind, label, caption] : kSamplers) {
      const FieldSampler sampler(*field, kind);
      for (int m = 0; m < 500; ++m) {
        Vec3 p(along(random), along(random), along(random));
        p -= normal * (normal.dot(p) - 0.05 * along(random));
        const GridSample sample = sampler.at(p);
        ASSERT_EQ(sample.region, FieldRegion::band);
        EXPECT_NEAR(sample.phi, plane(p), 4 * float_eps * 8 * grid.voxel);
        EXPECT_LT((sample.gradient - normal).norm(), 8 * float_eps * 8);
      }
    }
  }
}

struct Errors {
  double value = 0, value_max = 0; // [m]
  double angle = 0, angle_max = 0; // [rad]
};

// rms and largest error at points within `reach` metres of a shape's surface.
Errors errorsOn(const Distance& distance, double half, int resolution, Sampler kind, double reach,
                double rim = 0) {
  const FieldGrid grid = cubeGrid(half, resolution);
  const auto field = sampledField(distance, grid);
  const FieldSampler sampler(*field, kind);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-half - reach, half + reach);
  const auto gradient = [&](const Vec3& p) {
    const double step = 1e-6;
    Vec3 g;
    for (int a = 0; a < 3; ++a)
      g[a] = distance(p + step * Vec3::Unit(a)) - distance(p - step * Vec3::Unit(a));
    return Vec3(g.normalized());
  };
  Errors errors;
  int count = 0;
  while (count < 20000) {
    const Vec3 p(coordinate(random), coordinate(random), coordinate(random));
    const double exact = distance(p);
    if (std::abs(exact) > reach) continue;
    if (rim > 0 && std::abs(p.z()) < rim) continue;
    ++count;
    const GridSample sample = sampler.at(p);
    const double value = std::abs(sample.phi - exact);
    const double angle = angleBetween(sample.gradient, gradient(p));
    errors.value += value * value;
    errors.angle += angle * angle;
    errors.value_max = std::max(errors.value_max, value);
    errors.angle_max = std::max(errors.angle_max, angle);
  }
  errors.value = std::sqrt(errors.value / count);
  errors.angle = std::sqrt(errors.angle / count);
  return errors;
}

// T-K05a and F1: the blend of nodal gradients is second order in direction, as trilinear is in
// value; F15: the average with the Taylor blend is third order.
TEST(FieldSampler, OrdersOnASphereMatchTheTheory) {
  Errors kim[3], high[3];
  for (int level = 0; level < 3; ++level) {
    const int resolution = (48 << level) + 16; // the voxel halves each time
    const Distance sphere = sphereDistance(kSphereRadius);
    kim[level] = errorsOn(sphere, kSphereRadius, resolution, Sampler::kim, 0.02 * kSphereRadius);
    high[level] = errorsOn(sphere, kSphereRadius, resolution, Sampler::high, 0.02 * kSphereRadius);
  }
  for (int level = 0; level < 2; ++level) {
    EXPECT_GE(orderOf(kim[level].angle, kim[level + 1].angle), 1.9);
    EXPECT_NEAR(orderOf(kim[level].value, kim[level + 1].value), 2, 0.1);
    // At 48 cells a diameter some deep nodes count as creased, so the error does not halve.
    EXPECT_GE(orderOf(high[level].value, high[level + 1].value), 2.8);
    EXPECT_EQ(high[level].angle, kim[level].angle);
  }
  // The voxel of a 150^3 grid lies between the last two levels.
  EXPECT_LT(high[2].value, kim[2].value / 500);
}

// The force accuracy that the contact test requires of a perfect field at 150^3.
TEST(FieldSampler, MeetsTheForceAccuracyOnASphere) {
  const FieldGrid grid = cubeGrid(kSphereRadius, 150);
  const auto field = sampledField(sphereDistance(kSphereRadius), grid);
  const FieldSampler sampler(*field, Sampler::high);
  double angle = 0, angle_max = 0, depth = 0, depth_max = 0;
  const int count = 20000;
  for (int i = 0; i < count; ++i) {
    const double t = 0.001 * i;
    const double theta = M_PI / 2 + 0.17 + 1.1 * std::sin(2 * M_PI * 0.11 * t);
    const double phi = 0.7 + 2 * M_PI * 0.37 * t;
    const double d = kSphereRadius * (0.03 + 0.02 * std::sin(2 * M_PI * 1.3 * t));
    const Vec3 n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    const GridSample sample = sampler.at((kSphereRadius - d) * n);
    ASSERT_EQ(sample.region, FieldRegion::band);
    const double a = angleBetween(sample.gradient, n) / kDegree;
    const double e = std::abs(-sample.phi - d) / d * 100;
    angle += a / count;
    depth += e / count;
    angle_max = std::max(angle_max, a);
    depth_max = std::max(depth_max, e);
  }
  EXPECT_LT(angle, 0.005);
  EXPECT_LT(angle_max, 0.02);
  EXPECT_LT(depth, 0.001);
  EXPECT_LT(depth_max, 0.01);
}

// T-K01c and T-K05c: at a box's edges value and direction lose their order in the largest error;
// the rms direction keeps 1/2, because the wrong strip narrows like h. Nodes hold the slope of
// their own side, so that the strip is one cell wide, and within it any direction may come out.
TEST(FieldSampler, BoxEdgesLimitTheOrder) {
  const Vec3 half(0.04, 0.033, 0.027);
  Errors coarse = errorsOn(boxDistance(half), 0.04, 48 + 16, Sampler::kim, 0.001);
  Errors fine = errorsOn(boxDistance(half), 0.04, 192 + 16, Sampler::kim, 0.001);
  EXPECT_NEAR(orderOf(coarse.value_max, fine.value_max) / 2, 1, 0.25);
  EXPECT_NEAR(orderOf(coarse.value, fine.value) / 2, 1.5, 0.3);
  EXPECT_NEAR(orderOf(coarse.angle, fine.angle) / 2, 0.5, 0.15);
  EXPECT_GT(fine.angle_max / kDegree, 40);
  EXPECT_LT(fine.angle_max / kDegree, 90);
}

// T-K05b: direction and value do not jump across a cell's face.
TEST(FieldSampler, IsContinuousAcrossCellAndBlockFaces) {
  const FieldGrid grid = cubeGrid(kSphereRadius, 100);
  const auto field = sampledField(sphereDistance(kSphereRadius), grid);
  std::mt19937 random(5);
  const double step = 1e-9 / grid.voxel;
  for (const auto& [kind, label, caption] : kSamplers) {
    const FieldSampler sampler(*field, kind);
    for (int n = 0; n < 3000; ++n) {
      Vec3 q = grid.toGrid(randomDirection(random) * kSphereRadius * 0.98);
      const int axis = n % 3;
      q[axis] = n % 2 ? std::round(q[axis]) : 8 * std::round(q[axis] / 8);
      const Vec3 other = step * Vec3::Unit(axis);
      const GridSample a = sampler.atGrid(q - other), b = sampler.atGrid(q + other);
      if (a.region != FieldRegion::band || b.region != FieldRegion::band) continue;
      EXPECT_LT(angleBetween(a.gradient, b.gradient), 1e-6);
      EXPECT_NEAR(a.phi, b.phi, 5e-6);
    }
  }
}

TEST(FieldSampler, PhiAloneEqualsPhiWithGradient) {
  const FieldGrid grid = cubeGrid(kSphereRadius, 64);
  const auto field = sampledField(torusDistance(0.033, 0.016), grid);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> anywhere(-5, 70);
  for (const auto& [kind, label, caption] : kSamplers) {
    const FieldSampler sampler(*field, kind);
    for (int n = 0; n < 20000; ++n) {
      const Vec3 q(anywhere(random), anywhere(random), anywhere(random));
      EXPECT_EQ(sampler.phiAtGrid(q), sampler.atGrid(q).phi);
    }
  }
}

TEST(FieldSampler, DepthGrowsMonotonicallyAndContinuouslyBeyondTheBand) {
  const FieldGrid grid = cubeGrid(kSphereRadius, 150);
  const auto field = sampledField(sphereDistance(kSphereRadius), grid);
  std::mt19937 random(7);
  for (const auto& [kind, label, caption] : kSamplers) {
    const FieldSampler sampler(*field, kind);
    for (int ray = 0; ray < 50; ++ray) {
      const Vec3 n = randomDirection(random);
      double last = 0;
      for (double depth = 0.01; depth < 45; depth += 0.01) {
        const GridSample sample =
            sampler.atGrid(grid.toGrid(n * (kSphereRadius - depth * grid.voxel)));
        ASSERT_LT(sample.phi, last + 1e-3) << depth;
        ASSERT_LT(last - sample.phi, 0.1) << depth;
        ASSERT_NEAR(-sample.phi, depth, 1.8) << depth;
        const FieldRegion expected = depth > 5.25 ? FieldRegion::interior : FieldRegion::band;
        ASSERT_TRUE(sample.region == expected || std::abs(depth - 5.25) < 0.05) << depth;
        ASSERT_LT(angleBetween(sample.gradient, n), 0.4);
        last = sample.phi;
      }
    }
  }
}

TEST(FieldSampler, NarrowBandsAreExactAtTheSurface) {
  std::mt19937 random(12);
  for (const double band : {2.0, 2.5, 2.75, 3.0}) {
    const FieldGrid grid = cubeGrid(kSphereRadius, 100, band);
    const auto field = sampledField(sphereDistance(kSphereRadius), grid, band);
    for (const auto& [kind, label, caption] : kSamplers) {
      const FieldSampler sampler(*field, kind);
      for (int n = 0; n < 2000; ++n) {
        const Vec3 normal = randomDirection(random);
        const double depth = -0.2 + 2e-4 * n;
        const GridSample sample =
            sampler.atGrid(grid.toGrid(normal * (kSphereRadius - depth * grid.voxel)));
        ASSERT_EQ(sample.region, FieldRegion::band) << band << " " << depth;
        ASSERT_NEAR(sample.phi, -depth, 0.01) << band;
        ASSERT_LT(angleBetween(sample.gradient, normal), 0.01) << band;
      }
    }
  }
}

TEST(FieldSampler, DeepPointsWithoutACoarseLayerReportTheBand) {
  const FieldGrid grid = cubeGrid(kSphereRadius, 64);
  SurfaceField bare = sampleFunction(sphereDistance(kSphereRadius), grid, 8);
  bare.coarse.clear();
  const auto field = withSamples(std::make_shared<const SurfaceField>(std::move(bare)));
  const GridSample sample = FieldSampler(*field, Sampler::high).at(Vec3(0.001, 0, 0));
  EXPECT_EQ(sample.region, FieldRegion::interior);
  EXPECT_NEAR(sample.phi, -8 * grid.voxel, 1e-15);
  EXPECT_EQ(sample.gradient, Vec3::Zero());
}

TEST(FieldSampler, PhiOutsideTheBandIsALowerBoundOfTheDistance) {
  const FieldGrid grid = cubeGrid(kSphereRadius, 64);
  const Distance torus = torusDistance(0.033, 0.016);
  const auto field = sampledField(torus, grid);
  const FieldSampler sampler(*field, Sampler::kim);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> anywhere(-3 * kSphereRadius, 3 * kSphereRadius);
  int outside = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p(anywhere(random), anywhere(random), anywhere(random));
    const GridSample sample = sampler.at(p);
    if (sample.region != FieldRegion::outside) continue;
    ++outside;
    ASSERT_LE(sample.phi, torus(p) + 1e-6);
    ASSERT_GT(sample.phi, 6 * grid.voxel);
    ASSERT_EQ(sample.gradient, Vec3::Zero());
  }
  EXPECT_GT(outside, 10000);
}

TEST(FieldSampler, ReturnsFiniteNumbersOrNothingForAnyPoint) {
  const FieldGrid grid = cubeGrid(kSphereRadius, 40);
  const auto field = sampledField(sphereDistance(kSphereRadius), grid);
  const double inf = std::numeric_limits<double>::infinity();
  const double odd[] = {0.0,     -0.0,         20,           40,           39.999999999, 41,
                        -1e-300, 5e-324,       1e18,         -1e300,       1e300,        inf,
                        -inf,    std::nan(""), 2147483648.0, -2147483649.0};
  for (const auto& [kind, label, caption] : kSamplers) {
    const FieldSampler sampler(*field, kind);
    for (const double x : odd)
      for (const double y : odd)
        for (const double z : odd) {
          const Vec3 q(x, y, z);
          const GridSample sample = sampler.atGrid(q);
          EXPECT_TRUE(sample.gradient.allFinite());
          EXPECT_FALSE(std::isnan(sample.phi));
          EXPECT_EQ(sample.region == FieldRegion::invalid, q.hasNaN());
          EXPECT_TRUE(!q.hasNaN() || sample.phi == inf);
          EXPECT_EQ(sampler.faceNear(q), -1);
        }
  }
}

TEST(FieldSampler, IsIndependentOfTheScale) {
  const auto small = sampledField(sphereDistance(0.05), cubeGrid(0.05, 150));
  const auto large = sampledField(sphereDistance(10), cubeGrid(10, 150));
  const FieldSampler a(*small, Sampler::high), b(*large, Sampler::high);
  std::mt19937 random(9);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 unit = randomDirection(random) * 0.97;
    const GridSample s = a.at(unit * 0.05), l = b.at(unit * 10);
    EXPECT_NEAR(l.phi / 10, s.phi / 0.05, 1e-6 * 0.03);
    EXPECT_LT((s.gradient - l.gradient).norm(), 2e-6);
  }
}

TEST(FieldSampler, FaceNearIsTheFaceOfTheNearestStoredNode) {
  const FieldGrid grid = cubeGrid(kSphereRadius, 40, 3);
  SurfaceField field = sampleFunction(sphereDistance(kSphereRadius), grid, 3);
  // Each node stores its own index as its face.
  for (std::size_t slot = 0; slot < field.blockCount(); ++slot) {
    FaceNodes faces{};
    const auto phi = field.distance[slot]->phi();
    for (int n = 0; n < kBlockNodes; ++n) {
      const auto& at = field.block_at[slot];
      const int i = 8 * at[0] + n % 8, j = 8 * at[1] + n / 8 % 8, k = 8 * at[2] + n / 64;
      const auto index = static_cast<std::size_t>(n);
      faces.face[index] = std::abs(phi[index]) < kBackground ? (k * 64 + j) * 64 + i : -1;
    }
    field.face.push_back(std::make_shared<const FaceBlock>(faces));
  }
  const auto sampled = withSamples(std::make_shared<const SurfaceField>(std::move(field)));
  const FieldSampler sampler(*sampled, Sampler::kim);
  std::mt19937 random(10);
  std::uniform_real_distribution<double> depth(-2, 2);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p = randomDirection(random) * (kSphereRadius + depth(random) * grid.voxel * 0.1);
    const Vec3 node = grid.toGrid(p).array().round();
    const auto expected = static_cast<std::int32_t>((node.z() * 64 + node.y()) * 64 + node.x());
    EXPECT_EQ(sampler.faceNear(p), expected);
  }
  EXPECT_EQ(sampler.faceNear(Vec3::Zero()), -1);
  EXPECT_EQ(sampler.faceNear(Vec3(1, 1, 1)), -1);
}

TEST(FieldSampler, NeedsTheSampleLayerAndAKnownName) {
  const SurfaceField bare =
      sampleFunction(sphereDistance(kSphereRadius), cubeGrid(kSphereRadius, 40), 8);
  EXPECT_THROW(FieldSampler(bare, Sampler::kim), std::invalid_argument);
  EXPECT_EQ(parseSampler("kim"), Sampler::kim);
  EXPECT_EQ(parseSampler(name(Sampler::high)), Sampler::high);
  EXPECT_THROW(parseSampler("cubic"), Error);
}

// P02. Across a crease the gradient is the derivative of the value, by central differences within a
// cell; elsewhere it is the blend of nodal gradients, bit for bit.
TEST(FieldSampler, ResolvesACreaseByTheDerivativeOfTheValue) {
  FieldGrid grid;
  grid.voxel = 1e-3;
  grid.origin = Vec3::Constant(-0.016);
  grid.nodes = {33, 33, 33};
  const auto box = [](const Vec3& p) {
    const Vec3 q = p.cwiseAbs() - Vec3(0.008, 0.007, 0.006);
    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
  };
  const auto field =
      withSamples(std::make_shared<const SurfaceField>(sampleFunction(box, grid, 12)));
  std::mt19937 random(4);
  std::uniform_real_distribution<double> cell(8, 24), inside(0.1, 0.9);
  for (const Sampler sampler : {Sampler::kim, Sampler::high}) {
    const FieldSampler reader(*field, sampler);
    double apart = 0;
    int smooth = 0, creased = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3 corner(std::floor(cell(random)), std::floor(cell(random)),
                        std::floor(cell(random)));
      const Vec3 q = corner + Vec3(inside(random), inside(random), inside(random));
      const SurfaceSample at = reader.surfaceAtGrid(q);
      if (at.region != FieldRegion::band) continue;
      EXPECT_NEAR(at.phi, reader.phiAtGrid(q), 2e-6);
      if (at.normal_dispersion == 0) {
        EXPECT_EQ(at.gradient, reader.atGrid(q).gradient);
        ++smooth;
      }
      if (at.normal_dispersion < 0.02) continue;
      ++creased;
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = 0.05 * Vec3::Unit(axis);
        const double slope = (reader.phiAtGrid(q + step) - reader.phiAtGrid(q - step)) / (2 * 0.05);
        EXPECT_NEAR(at.gradient[axis], slope, 2e-3);
      }
      apart = std::max(apart, (at.gradient - reader.atGrid(q).gradient).norm());
    }
    EXPECT_GT(apart, 0.1);
    EXPECT_GT(smooth, 500);
    EXPECT_GT(creased, 500);
  }
}

} // namespace
} // namespace patina
