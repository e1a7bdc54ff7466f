// Tests the exact distance and proxy against closed forms and brute force (T-P1).
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "app/studies/contact/oracle.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/shapes.h"
#include "support/judged_scenes.h"
#include "support/winding_sum.h"

namespace patina::test {
namespace {

constexpr double kTiny = 2 * kMinIso; // [m], the distance error at iso 0, along two planes

ExactSurface surfaceOf(TriangleMesh mesh) {
  return ExactSurface({std::move(mesh)});
}

Vec3 randomIn(std::mt19937& random, const Vec3& low, const Vec3& high) {
  std::uniform_real_distribution<double> unit(0, 1);
  return low + Vec3(unit(random), unit(random), unit(random)).cwiseProduct(high - low);
}

TEST(ContactScenes, AreClosedAndFaceOutwardsExceptGalleonAndScan) {
  for (const ContactScene& scene : judgedScenes()) {
    if (scene.name == "galleon" || scene.name == "scan") continue;
    for (const TriangleMesh& mesh : scene.meshes) {
      EXPECT_TRUE(inspect(mesh).watertight) << scene.name;
      EXPECT_GT(volume(mesh), 0) << scene.name;
    }
    Box3 all;
    for (const TriangleMesh& mesh : scene.meshes) all.extend(bounds(mesh));
    EXPECT_NEAR(all.sizes().maxCoeff(), 0.11, 0.03) << scene.name; // longer where it is tilted
  }
}

TEST(ExactDistance, MatchesTheClosedFormOfABox) {
  const Vec3 half(0.05, 0.04, 0.03);
  const ExactSurface surface = surfaceOf(box(2 * half));
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = randomIn(random, -1.5 * half, 1.5 * half);
    const Vec3 q = p.cwiseAbs() - half;
    const double expected = q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
    EXPECT_NEAR(surface.distance(p), expected, 1e-15);
  }
}

TEST(ExactDistance, HasTheSignOfTheWindingNumber) {
  for (const char* name : {"L", "room", "groove", "torus", "rough", "pottery"}) {
    const ContactScene scene = contactScene(name);
    const ExactSurface surface(scene.meshes);
    const Box3 box = surface.bounds();
    std::mt19937 random(2);
    int inside = 0;
    for (int i = 0; i < 400; ++i) {
      const Vec3 p = randomIn(random, box.min(), box.max());
      const bool in = windingNumberBruteForce(scene.meshes[0], p) > 0.5;
      EXPECT_EQ(surface.distance(p) < 0, in) << name << ' ' << p.transpose();
      inside += in;
    }
    EXPECT_GT(inside, 10) << name;
  }
}

TEST(ExactDistance, IsTheMinimumOverThePartsOfAUnion) {
  const ContactScene scene = contactScene("spheres");
  const ExactSurface both(scene.meshes), a = surfaceOf(scene.meshes[0]),
                                         b = surfaceOf(scene.meshes[1]);
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = randomIn(random, both.bounds().min(), both.bounds().max());
    EXPECT_EQ(both.distance(p), std::min(a.distance(p), b.distance(p)));
  }
}

// In a corner of three planes the projection is the larger of tip and iso in each coordinate.
TEST(ProxyOracle, IsTheProjectionOnThreeHalfSpaces) {
  const ExactSurface room = surfaceOf(roomSolid());
  std::mt19937 random(4);
  for (const double iso : {0.0, 1e-3, 3e-3})
    for (int i = 0; i < 1000; ++i) {
      const Vec3 tip = randomIn(random, Vec3::Constant(-8e-3), Vec3::Constant(12e-3));
      const Vec3 seed = randomIn(random, Vec3::Constant(iso), Vec3::Constant(15e-3));
      const ProxyAnswer answer = proxyOracle(room, iso, tip, seed, 0.05);
      ASSERT_TRUE(answer.found);
      EXPECT_LE((answer.point - tip.cwiseMax(iso)).norm(), kTiny) << tip.transpose();
    }
}

TEST(ProxyOracle, IsTheProjectionOnTwoHalfSpaces) {
  for (const bool tilt : {false, true}) {
    const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
    const Eigen::Affine3d pose(tilt ? Eigen::Affine3d(turn) : Eigen::Affine3d::Identity());
    const ExactSurface solid = surfaceOf(transformed(lSolid(), pose));
    std::mt19937 random(5);
    for (const double iso : {0.0, 2e-3})
      for (int i = 0; i < 1000; ++i) {
        const Vec3 tip = randomIn(random, Vec3(-12e-3, -20e-3, -8e-3), Vec3(8e-3, 20e-3, 12e-3));
        const Vec3 seed = randomIn(random, Vec3(-15e-3, -20e-3, iso), Vec3(-iso, 20e-3, 15e-3));
        const ProxyAnswer answer = proxyOracle(solid, iso, pose * tip, pose * seed, 0.05);
        const Vec3 expected(std::min(tip.x(), -iso), tip.y(), std::max(tip.z(), iso));
        EXPECT_LE((pose.inverse() * answer.point - expected).norm(), kTiny) << tip.transpose();
      }
  }
}

// Near an edge or vertex of a convex solid the iso-surface is round.
TEST(ProxyOracle, IsRoundAroundOuterEdgesAndVertices) {
  const Vec3 half(0.05, 0.04, 0.03);
  const ExactSurface surface = surfaceOf(box(2 * half));
  std::mt19937 random(6);
  const double iso = 3e-3;
  int tried = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 tip = half + randomIn(random, Vec3::Constant(-6e-3), Vec3::Constant(2.5e-3));
    const Vec3 on = tip.cwiseMin(half);
    if ((tip - on).norm() < 0.2 * iso || (tip - on).norm() > iso) continue;
    ++tried;
    const Vec3 seed = on + 1.7 * iso * (tip - on).normalized();
    const ProxyAnswer answer = proxyOracle(surface, iso, tip, seed, 1);
    const Vec3 expected = on + iso * (tip - on).normalized();
    EXPECT_LE((answer.point - expected).norm(), 1e-7) << tip.transpose();
  }
  EXPECT_GT(tried, 300);
}

TEST(ProxyOracle, StaysOnItsSideOfAThinWallAtAnyDepth) {
  for (const bool tilt : {false, true}) {
    const Eigen::Affine3d pose(
        tilt ? Eigen::Affine3d(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()))
             : Eigen::Affine3d::Identity());
    const ExactSurface plate = surfaceOf(transformed(plateSolid(1e-3), pose));
    for (const double iso : {0.0, 2e-3}) {
      Vec3 c(0.012, 0.02, 0.01);
      for (int i = 0; i < 400; ++i) { // down through it, and on beyond
        const Vec3 tip(0.012 + 1e-5 * i, 0.02, 0.01 - 5e-5 * i);
        const ProxyAnswer answer = proxyOracle(plate, iso, pose * tip, pose * c, 1.6e-4);
        c = pose.inverse() * answer.point;
        const Vec3 expected(tip.x(), tip.y(), std::max(tip.z(), 0.5e-3 + iso));
        ASSERT_LE((c - expected).norm(), 1.1 * kMinIso) << i;
      }
    }
  }
}

// Pressed against a side near an outer edge, it slides around the edge if that is nearer.
TEST(ProxyOracle, SlidesOffAnOuterEdge) {
  const ExactSurface surface = surfaceOf(box(Vec3(0.1, 0.08, 0.06)));
  const Vec3 tip(0.049, 0.01, 0.025); // 1 mm from +x, 5 mm from +z
  const ProxyAnswer on = proxyOracle(surface, 0, tip, Vec3(0.048, 0.01, 0.03), 1);
  EXPECT_LE((on.point - Vec3(0.049, 0.01, 0.03)).norm(), kTiny); // over the foot: a minimum
  const Vec3 beyond(0.0503, 0.01, 0.025);
  const ProxyAnswer off = proxyOracle(surface, 0, beyond, on.point, 1);
  EXPECT_LE((off.point - beyond).norm(), kTiny); // free: past the edge nothing holds it
}

TEST(ProxyOracle, StaysWithinItsBall) {
  const ExactSurface room = surfaceOf(roomSolid());
  std::mt19937 random(7);
  for (int i = 0; i < 500; ++i) {
    const Vec3 tip = randomIn(random, Vec3::Constant(-8e-3), Vec3::Constant(12e-3));
    const Vec3 seed = randomIn(random, Vec3::Constant(1e-3), Vec3::Constant(9e-3));
    const double ball = 1e-3, iso = 1e-3;
    const ProxyAnswer answer = proxyOracle(room, iso, tip, seed, ball);
    EXPECT_LE((answer.point - seed).norm(), ball + 1e-9);
    EXPECT_GE(room.distance(answer.point), iso - 1e-9);
    // The shape is convex here: a dense search finds no nearer feasible point of the ball.
    const double reached = (answer.point - tip).norm();
    for (int k = 0; k < 300; ++k) {
      const Vec3 y = (seed + randomIn(random, Vec3::Constant(-ball), Vec3::Constant(ball)));
      if ((y - seed).norm() > ball || y.minCoeff() < iso) continue;
      EXPECT_GE((y - tip).norm(), reached - 1e-9);
    }
  }
}

// On any shape the answer is feasible, and no free point nearby is nearer to the tip.
TEST(ProxyOracle, IsALocalMinimumOnEveryScene) {
  for (const ContactScene& scene : judgedScenes()) {
    const ExactSurface surface(scene.meshes);
    std::mt19937 random(8);
    std::normal_distribution<double> normal;
    for (const double iso : scene.isos) {
      int contacts = 0;
      for (int i = 0; i < 60; ++i) {
        const TriangleMesh& mesh = surface.meshes()[0];
        const std::size_t face = random() % mesh.triangles.size();
        const Vec3 p = (mesh.corner(face, 0) + mesh.corner(face, 1) + mesh.corner(face, 2)) / 3;
        const Vec3 n = faceNormal(mesh, face);
        const Vec3 aside(normal(random), normal(random), normal(random));
        const Vec3 seed = p + (iso + 1e-4) * n, tip = p - 2e-3 * n + 1e-3 * aside;
        const double ball = 5e-3;
        const ProxyAnswer c = proxyOracle(surface, iso, tip, seed, ball);
        if (!c.found || c.at_ball) continue;
        EXPECT_LT(c.steps, 1500) << scene.name << ' ' << iso << " tip " << tip.transpose()
                                 << " seed " << seed.transpose();
        EXPECT_GE(surface.distance(c.point), iso - 2e-9) << scene.name << ' ' << iso;
        const double depth = (c.point - tip).norm();
        if (depth < 1e-4) continue;
        ++contacts;
        for (const double reach : {1e-6, 2e-7})
          for (int k = 0; k < 100; ++k) {
            const Vec3 way(normal(random), normal(random), normal(random));
            const Vec3 y = c.point + reach * way.normalized();
            if (surface.distance(y) < std::max(iso, kMinIso)) continue;
            // On a round face, probes of the surface near c gain to the second order.
            EXPECT_GE((y - tip).norm(), depth - 1e-2 * reach)
                << scene.name << ' ' << iso << " tip " << tip.transpose() << " c "
                << c.point.transpose() << " better " << (y - c.point).transpose();
          }
      }
      EXPECT_GT(contacts, 15) << scene.name << ' ' << iso;
    }
  }
}

} // namespace
} // namespace patina::test
