// The field list of MATH 2.8, each case with its expected behaviour.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "core/error.h"
#include "field/construction/build_field.h"
#include "field/sampling/field_sampler.h"
#include "geometry/mesh/shapes.h"
#include "geometry/tree/triangle_tree.h"
#include "support/node_values.h"

namespace patina {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

FieldSpec cells(int resolution, double band = 8) {
  FieldSpec spec;
  spec.resolution = resolution;
  spec.band = band;
  return spec;
}

FieldSpec voxels(double voxel, double band = 8) {
  FieldSpec spec;
  spec.voxel = voxel;
  spec.band = band;
  return spec;
}

BuiltField built(const TriangleMesh& mesh, const FieldSpec& spec) {
  Progress progress;
  BuiltField result = buildField(mesh, spec, progress);
  result.field = withSamples(result.field);
  return result;
}

std::string failure(const TriangleMesh& mesh, const FieldSpec& spec) {
  try {
    built(mesh, spec);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
  for (Vec3& p : mesh.positions) p += by;
  return mesh;
}

TriangleMesh oneTriangle() {
  TriangleMesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(0.03, 0, 0.004), Vec3(0.01, 0.02, 0)};
  mesh.triangles = {Triangle{0, 1, 2}};
  return mesh;
}

// Upward cone with its apex at the origin, closed by a fan.
TriangleMesh cone(double radius, double height, int around) {
  TriangleMesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(0, 0, -height)};
  for (int i = 0; i < around; ++i) {
    const double angle = 2 * std::numbers::pi * i / around;
    mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), -height);
  }
  for (int i = 0; i < around; ++i) {
    const int here = 2 + i, next = 2 + (i + 1) % around;
    mesh.triangles.push_back({0, here, next});
    mesh.triangles.push_back({1, next, here});
  }
  return mesh;
}

void forNodes(const SurfaceField& field, const std::function<void(const Vec3&, float)>& visit) {
  for (int k = 0; k < field.grid.nodes[2]; ++k)
    for (int j = 0; j < field.grid.nodes[1]; ++j)
      for (int i = 0; i < field.grid.nodes[0]; ++i)
        visit(field.grid.toWorld(Vec3(i, j, k)), test::phiAt(field, i, j, k));
}

// T-K01e at every stored node: largest difference of |phi| from the tree's distance [voxel].
double worstDistance(const SurfaceField& field, const TriangleMesh& mesh) {
  const TriangleTree tree(mesh);
  double worst = 0;
  forNodes(field, [&](const Vec3& p, float phi) {
    const double d = tree.closestPoint(p).distance / field.grid.voxel;
    const double stored = std::abs(static_cast<double>(phi));
    worst = std::max(worst, stored < kBackground ? std::abs(stored - d) : field.band - d);
  });
  return worst;
}

std::size_t insideNodes(const SurfaceField& field) {
  std::size_t count = 0;
  forNodes(field, [&](const Vec3&, float phi) { count += phi < 0; });
  return count;
}

void expectFinite(const FieldSampler& sampler, const Vec3& p) {
  const GridSample sample = sampler.at(p);
  EXPECT_TRUE(std::isfinite(sample.phi)) << p.transpose();
  EXPECT_TRUE(sample.gradient.allFinite()) << p.transpose();
}

TEST(FieldExtremes, EmptyMeshIsANamedError) {
  EXPECT_NE(failure(TriangleMesh(), cells(60)).find("no triangle"), std::string::npos);
}

TEST(FieldExtremes, MeshOfNothingButDefectsIsAnError) {
  TriangleMesh mesh = oneTriangle();
  mesh.positions[2] = mesh.positions[1];
  EXPECT_NE(failure(mesh, cells(60)).find("no triangle"), std::string::npos);
  mesh.positions[2] = Vec3(kNan, 0, 0);
  EXPECT_NE(failure(mesh, cells(60)).find("no triangle"), std::string::npos);
}

// Counts nodes with a negative distance, and those of them in front of the plane through `on`.
std::array<std::size_t, 2> insideAndInFront(const SurfaceField& field, const Vec3& on,
                                            const Vec3& normal) {
  std::array<std::size_t, 2> count{};
  for (int k = 0; k < field.grid.nodes[2]; ++k)
    for (int j = 0; j < field.grid.nodes[1]; ++j)
      for (int i = 0; i < field.grid.nodes[0]; ++i) {
        if (!(test::phiAt(field, i, j, k) < 0)) continue;
        ++count[0];
        count[1] += normal.dot(field.grid.toWorld(Vec3(i, j, k)) - on) > 1e-9;
      }
  return count;
}

TEST(FieldExtremes, OneTriangleHasExactDistancesAndABackSide) {
  const TriangleMesh mesh = oneTriangle();
  const auto field = built(mesh, cells(60)).field;
  const Vec3 a = mesh.corner(0, 0);
  const Vec3 normal = (mesh.corner(0, 1) - a).cross(mesh.corner(0, 2) - a).normalized();
  const TriangleTree tree(mesh);
  double worst = 0;
  std::size_t stored = 0; // in front; behind is the plate's back
  forNodes(*field, [&](const Vec3& p, float phi) {
    if (normal.dot(p - a) < 0 || !(phi < kBackground)) return;
    const double d = tree.closestPoint(p).distance / field->grid.voxel;
    worst = std::max(worst, std::abs(static_cast<double>(phi) - d)), ++stored;
  });
  EXPECT_LT(worst, 1e-4);
  EXPECT_GT(stored, 1000U);
  const auto [inside, in_front] = insideAndInFront(*field, a, normal);
  EXPECT_GT(inside, 100U);
  EXPECT_EQ(in_front, 0U);
}

TEST(FieldExtremes, ZeroAreaFacesAreDroppedAndCounted) {
  const TriangleMesh ball = icosphere(0.05, 6);
  TriangleMesh mesh = ball;
  const auto last = static_cast<std::int32_t>(mesh.positions.size());
  mesh.positions.emplace_back(0.2, 0, 0); // far from the ball: would show in any distance
  mesh.positions.emplace_back(0.3, 0, 0);
  mesh.positions.emplace_back(0.4, 0, 0);
  mesh.triangles.insert(mesh.triangles.begin(), {last, last + 1, last + 2});
  mesh.triangles.push_back({3, 3, 5});
  const BuiltField clean = built(ball, cells(60)), dirty = built(mesh, cells(60));
  EXPECT_EQ(dirty.report.dropped_triangles, 2U);
  ASSERT_EQ(clean.field->block_index, dirty.field->block_index);
  for (std::size_t slot = 0; slot < clean.field->blockCount(); ++slot) {
    ASSERT_EQ(clean.field->distance[slot]->phi(), dirty.field->distance[slot]->phi());
    for (std::size_t n = 0; n < kBlockNodes; ++n) {
      const std::int32_t face = clean.field->face[slot]->at(n);
      ASSERT_EQ(dirty.field->face[slot]->at(n), face < 0 ? -1 : face + 1); // numbering of the input
    }
  }
}

TEST(FieldExtremes, NanAndInfiniteVerticesCostOnlyTheirFaces) {
  for (double bad : {kNan, kInfinity, -kInfinity}) {
    TriangleMesh mesh = icosphere(0.05, 6);
    std::size_t faces = 0;
    for (const Triangle& t : mesh.triangles) faces += std::count(t.begin(), t.end(), 20) > 0;
    mesh.positions[20].y() = bad;
    const BuiltField result = built(mesh, cells(60));
    EXPECT_EQ(result.report.dropped_triangles, faces);
    const FieldSampler sampler(*result.field, Sampler::high);
    EXPECT_LT(sampler.at(Vec3::Zero()).phi, -0.03);
    std::size_t broken = 0;
    forNodes(*result.field, [&](const Vec3&, float phi) { broken += !std::isfinite(phi); });
    EXPECT_EQ(broken, 0U);
  }
}

TEST(FieldExtremes, WorksAMillionSizesAwayAsAtTheOrigin) {
  const TriangleMesh mesh = torus(0.04, 0.015, 60, 30);
  const Vec3 away(0.1e6, -0.1e6, 0.1e6);
  const auto here = built(mesh, cells(80)).field;
  const auto there = built(moved(mesh, away), cells(80)).field;
  const FieldSampler sample_here(*here, Sampler::high), sample_there(*there, Sampler::high);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-0.06, 0.06);
  int compared = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p(unit(random), unit(random), unit(random) / 3);
    const GridSample a = sample_here.at(p), b = sample_there.at(p + away);
    if (a.region != FieldRegion::band || b.region != FieldRegion::band) continue;
    ++compared;
    ASSERT_NEAR(a.phi, b.phi, here->grid.voxel / 100);
  }
  EXPECT_GT(compared, 5000);
}

TEST(FieldExtremes, BoxOfOneToAThousandIsExactAlongItsLength) {
  for (const Vec3& size : {Vec3(0.1, 0.1, 1e-4), Vec3(0.1, 1e-4, 1e-4)}) {
    const TriangleMesh mesh = box(size);
    const auto coarse = built(mesh, cells(100)).field;
    EXPECT_LT(worstDistance(*coarse, mesh), 1e-3);
    // Voxels of a quarter of the thickness, about one end only.
    const TriangleMesh end = box(Vec3(size.x() / 100, size.y() > 1e-3 ? 1e-3 : 1e-4, 1e-4));
    const auto fine = built(end, voxels(2.4e-5, 4)).field;
    EXPECT_LT(worstDistance(*fine, end), 1e-4);
    EXPECT_GT(insideNodes(*fine), 0U);
  }
}

// Two sheets enclose no inside; an offset surface still gives contact.
TEST(FieldExtremes, PlateThinnerThanAVoxel) {
  const Vec3 size(0.05, 0.05, 2e-4);
  const TriangleMesh mesh = box(size, 4);
  const auto field = built(mesh, voxels(1e-3)).field;
  EXPECT_LT(worstDistance(*field, mesh), 1e-4);
  std::size_t wrong = 0;
  forNodes(*field, [&](const Vec3& p, float phi) {
    wrong += phi < 0 && (p.cwiseAbs() - size / 2).maxCoeff() > 1e-9;
  });
  EXPECT_EQ(wrong, 0U);
  const FieldSampler sampler(*field, Sampler::kim);
  for (double z : {-4e-3, -2.5e-3, 2.5e-3, 4e-3}) {
    const GridSample sample = sampler.at(Vec3(0.0031, -0.0042, z));
    EXPECT_NEAR(sample.phi, std::abs(z) - 1e-4, 1e-6);
    EXPECT_NEAR(sample.gradient.z(), z > 0 ? 1 : -1, 1e-5);
  }
}

TEST(FieldExtremes, ConeTip) {
  const TriangleMesh mesh = cone(0.005, 0.05, 48);
  const auto field = built(mesh, cells(100)).field;
  EXPECT_LT(worstDistance(*field, mesh), 1e-4);
  const FieldSampler sampler(*field, Sampler::high);
  const double h = field->grid.voxel;
  for (int i = -40; i <= 40; ++i) expectFinite(sampler, Vec3(0, 0, 0.1 * i * h));
  EXPECT_NEAR(sampler.at(Vec3(0, 0, 3 * h)).phi, 3 * h, 0.2 * h);
  EXPECT_GT(sampler.at(Vec3(0, 0, 3 * h)).gradient.z(), 0.8);
  EXPECT_LT(sampler.at(Vec3(0, 0, -0.04)).phi, 0);
}

TEST(FieldExtremes, SmallestAndLargeGrids) {
  const double radius = 0.05;
  const TriangleMesh mesh = icosphere(radius, 16);
  EXPECT_NE(failure(mesh, cells(18)).find("resolution"), std::string::npos);
  EXPECT_NE(failure(mesh, cells(8)).find("resolution"), std::string::npos);
  EXPECT_NE(failure(mesh, voxels(1e-6)).find("voxel"), std::string::npos);
  for (const FieldSpec& spec : {cells(19), cells(8, 2), cells(400, 3)}) {
    const auto field = built(mesh, spec).field;
    const FieldSampler sampler(*field, Sampler::high);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = 1.2 * radius * Vec3(unit(random), unit(random), unit(random));
      expectFinite(sampler, p);
      const double truth = p.norm() - radius;
      if (std::abs(truth) > field->grid.voxel) {
        EXPECT_EQ(sampler.at(p).phi < 0, truth < 0);
      }
    }
  }
}

TEST(FieldExtremes, OpenMeshIsExactAndReportsAmbiguousSigns) {
  TriangleMesh mesh = icosphere(0.05, 12);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.positions[static_cast<std::size_t>(t[0])].z() > 0.03;
  });
  const BuiltField bowl = built(mesh, cells(80));
  EXPECT_LT(worstDistance(*bowl.field, mesh), 1e-4);
  EXPECT_GT(bowl.report.ambiguous_signs, 0U);
  const FieldSampler sampler(*bowl.field, Sampler::kim);
  EXPECT_LT(sampler.at(Vec3(0, 0, -0.045)).phi, 0); // deep in the bowl
  EXPECT_GT(sampler.at(Vec3(0, 0, -0.055)).phi, 0);
  EXPECT_GT(sampler.at(Vec3(0, 0, 0.048)).phi, 0); // above its mouth
}

TEST(FieldExtremes, FlatSheetIsInsideOnlyBehindItsFront) {
  const BuiltField flat = built(sheet(0.1, 0.1, 10), cells(60));
  const auto [inside, in_front] = insideAndInFront(*flat.field, Vec3::Zero(), Vec3::UnitZ());
  EXPECT_GT(inside, 100U);
  EXPECT_EQ(in_front, 0U);
}

TEST(FieldExtremes, MeshWithItsOwnInverseEqualsTheMesh) {
  const TriangleMesh mesh = torus(0.04, 0.015, 60, 30);
  TriangleMesh inverse = mesh;
  for (Triangle& t : inverse.triangles) std::swap(t[1], t[2]);
  const auto once = built(mesh, cells(80)).field;
  for (const TriangleMesh& both : {joined(mesh, inverse), joined(inverse, mesh), inverse}) {
    const auto field = built(both, cells(80)).field;
    ASSERT_EQ(once->block_index, field->block_index);
    for (std::size_t slot = 0; slot < once->blockCount(); ++slot) {
      const auto a = once->distance[slot]->phi(), b = field->distance[slot]->phi();
      for (std::size_t n = 0; n < kBlockNodes; ++n) ASSERT_NEAR(a[n], b[n], 1e-4);
    }
  }
}

class TipOfBall : public testing::TestWithParam<Sampler> {
 protected:
  static constexpr double kRadius = 0.05;
  std::shared_ptr<const SurfaceField> field_ = built(icosphere(kRadius, 30), cells(80)).field;
  FieldSampler sampler_{*field_, GetParam()};
};

TEST_P(TipOfBall, IsOutsideWithALowerBoundBeyondTheGrid) {
  for (const Vec3& p : {Vec3(0.2, 0, 0), Vec3(-3, 5, 1), Vec3(0, 0, 1e9), Vec3(1e300, 0, -1e300)}) {
    const GridSample sample = sampler_.at(p);
    EXPECT_EQ(sample.region, FieldRegion::outside);
    EXPECT_GT(sample.phi, 0);
    EXPECT_LE(sample.phi, p.norm() - kRadius + 1e-3 * kRadius);
    EXPECT_TRUE(sample.gradient.allFinite());
    EXPECT_EQ(sampler_.faceNear(p), -1);
  }
  EXPECT_GT(sampler_.at(Vec3(kInfinity, 0, 0)).phi, 0);
  const GridSample nowhere = sampler_.at(Vec3(0, kNan, 0));
  EXPECT_EQ(nowhere.region, FieldRegion::invalid);
  EXPECT_EQ(nowhere.phi, kInfinity);
}

TEST_P(TipOfBall, IsContinuousOnNodesEdgesAndFaces) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> index(1, 78);
  std::uniform_real_distribution<double> unit(0, 1);
  int in_band = 0;
  for (int n = 0; n < 20000; ++n) {
    Vec3 q(index(random), index(random), index(random));
    const float stored = test::phiAt(*field_, static_cast<int>(q[0]), static_cast<int>(q[1]),
                                     static_cast<int>(q[2]));
    if (std::abs(stored) > 4) continue; // coarse values replace them farther out
    ++in_band;
    EXPECT_NEAR(sampler_.atGrid(q).phi, stored, 1e-5); // on a node
    const int free = n % 3;
    if (n % 2) q[free] += unit(random);                // on an edge
    if (n % 4 == 3) q[(free + 1) % 3] += unit(random); // on a face
    const GridSample on = sampler_.atGrid(q);
    for (int axis = 0; axis < 3; ++axis)
      for (double side : {-1e-9, 1e-9}) {
        Vec3 beside = q;
        beside[axis] += side;
        const GridSample near = sampler_.atGrid(beside);
        EXPECT_NEAR(on.phi, near.phi, 1e-6); // floats of a few voxels
        EXPECT_LT((on.gradient - near.gradient).norm(), 1e-6);
      }
  }
  EXPECT_GT(in_band, 500);
}

TEST_P(TipOfBall, IsFiniteAtTheMedialAxis) {
  const FieldSampler sampler(*field_, GetParam());
  const GridSample centre = sampler.at(Vec3::Zero());
  EXPECT_TRUE(centre.gradient.allFinite());
  EXPECT_LT(centre.gradient.norm(), 0.2); // no direction is better than another
  // The same holds if a coarse node lies at the centre: that of 80 cells lies on a block's corner.
  const Vec3 q = field_->grid.toGrid(Vec3::Zero()) / kBlockSide;
  EXPECT_LT((q - Vec3(q.array().round())).norm(), 1e-6);
  for (const Vec3& p : {Vec3(0.3, 0, 0), Vec3(0, -0.3, 0), Vec3(0.2, 0.2, -0.2)}) {
    const Vec3 g = sampler.at(kRadius * p).gradient; // off the axis there is a direction
    EXPECT_GT(g.dot(p.normalized()), 0.7);
  }
  EXPECT_LT(centre.phi, -8 * field_->grid.voxel);
  for (int i = 0; i < 300; ++i) {
    const double s = 1e-3 * std::pow(10.0, -i / 15.0);
    expectFinite(sampler, Vec3(s, -s / 3, s / 2));
  }
}

TEST_P(TipOfBall, IsFiniteAtTheMedialAxisOfAPlate) {
  const auto field = built(box(Vec3(0.05, 0.05, 0.004), 2), voxels(1e-3)).field;
  const FieldSampler sampler(*field, GetParam());
  for (int i = -50; i <= 50; ++i) {
    const GridSample sample = sampler.at(Vec3(2e-4 * i, 1e-4 * i, 0));
    EXPECT_NEAR(sample.phi, -0.002, 0.0005);
    EXPECT_LT(sample.gradient.norm(), 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(FieldExtremes, TipOfBall, testing::Values(Sampler::kim, Sampler::high),
                         [](const auto& which) { return std::string(name(which.param)); });

} // namespace
} // namespace patina
