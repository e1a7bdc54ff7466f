// Scans with outliers, much noise or few strokes are registered rightly, or not said to be.
#include <cstdio>

#include <gtest/gtest.h>

#include "acquisition/registration_shapes.h"
#include "geometry/io/mesh_io.h"
#include "scan/register_scans.h"
#include "support/longer.h"
#include "support/shared_data.h"

namespace patina {
namespace {

using test::Draw;
using test::missOf;

struct Row {
  const char* name;
  double noise;    // standard deviation of the positions [m]
  double outliers; // share of the samples that lie 5 to 20 mm aside
  double stated;   // share that the caller allows
  int strokes;
  double least; // share of scans that must be right
};

constexpr Row kRows[] = {{"15 % outliers", 0.5e-3, 0.15, 0.2, 4, 0.9},
                         {"30 % outliers, stated", 0.5e-3, 0.3, 0.4, 4, 0.7},
                         {"30 % outliers, not stated", 0.5e-3, 0.3, 0.2, 4, 0},
                         {"2 mm of noise", 2e-3, 0, 0.2, 4, 15. / 18},
                         {"2 strokes", 0.5e-3, 0, 0.2, 2, 15. / 18}};

// Walks over the surface: each step goes on in the tangent plane and is projected.
std::vector<Vec3> strokeOn(const SurfaceTarget& target, Draw& draw, double length, int samples) {
  const Box3 box = bounds(target.mesh());
  Vec3 p = target.tree()
               .closestPoint(box.center() + box.diagonal().norm() * draw.direction())
               .point;
  Vec3 heading = draw.direction();
  std::vector<Vec3> stroke;
  for (int i = 0; i < samples; ++i) {
    const ClosestPoint at = target.tree().closestPoint(p);
    const Vec3 normal = faceNormal(target.mesh(), index(at.surface.face));
    heading -= heading.dot(normal) * normal;
    if (!(heading.norm() > 1e-6)) heading = normal.unitOrthogonal();
    heading.normalize();
    stroke.push_back(at.point);
    p = at.point + length / samples * heading;
  }
  return stroke;
}

// Returns a position 5 to 20 mm aside that does not lie on another part of the surface.
Vec3 outlierAt(const SurfaceTarget& target, Draw& draw, const Vec3& p) {
  for (;;) {
    const Vec3 aside = p + draw.uniform(5e-3, 20e-3) * draw.direction();
    if (target.tree().closestPoint(aside).distance > 4e-3) return aside;
  }
}

// Returns the stated deviation of the moved points, rms [m].
double deviationOf(const Registration& found, const std::vector<Vec3>& points) {
  double variance = 0;
  for (const Vec3& p : points) {
    Eigen::Matrix<double, 3, 6> by;
    const Vec3 arm = found.mesh_from_path * p - found.middle;
    by << 0, arm.z(), -arm.y(), 1, 0, 0, -arm.z(), 0, arm.x(), 0, 1, 0, arm.y(), -arm.x(), 0, 0, 0,
        1;
    variance += (by * found.covariance * by.transpose()).trace();
  }
  return std::sqrt(variance / static_cast<double>(points.size()));
}

// Right: within 1 mm or two stated deviations. Wrong: beyond 1 mm and three of them, and not refused.
struct Count {
  int right = 0, refused = 0, wrong = 0;
};

Count countOf(const SurfaceTarget& target, const Row& row, int seeds) {
  Count count;
  const double across = bounds(target.mesh()).diagonal().norm();
  for (int seed = 1; seed <= seeds; ++seed) {
    Draw draw(static_cast<unsigned>(seed));
    std::vector<Vec3> truth;
    for (int s = 0; s < row.strokes; ++s) {
      const std::vector<Vec3> stroke = strokeOn(target, draw, 0.8 * across, 120);
      truth.insert(truth.end(), stroke.begin(), stroke.end());
    }
    std::vector<PathSample> path;
    for (const Vec3& p : truth) {
      PathSample sample;
      sample.t = 0.01 * static_cast<double>(path.size());
      sample.sigma = row.noise;
      sample.sigma_angle = 1e-3;
      sample.position = p + draw.normal(row.noise);
      if (draw.uniform(0, 1) < row.outliers) sample.position = outlierAt(target, draw, p);
      path.push_back(sample);
    }
    ScanRegistrationOptions options;
    options.outliers = row.stated;
    options.compliance = 0;
    options.guess = draw.off(truth, 60, 0.02);
    Progress progress;
    const Registration found = registerScans(target, {path}, options, progress).registration;
    const double sigma = deviationOf(found, truth);
    const double miss = missOf(found.mesh_from_path, truth);
    if (isUnreliable(found)) {
      ++count.refused;
      continue;
    }
    count.right += miss <= std::max(1e-3, 2 * sigma);
    count.wrong += miss > std::max(1e-3, 3 * sigma);
    if (miss > std::max(1e-3, 2 * sigma))
      std::printf("  seed %d is %.2f mm off, stated %.2f mm\n", seed, 1e3 * miss, 1e3 * sigma);
  }
  return count;
}

void check(const TriangleMesh& mesh, const char* name, int seeds) {
  const SurfaceTarget target(mesh, 0, true);
  for (const Row& row : kRows) {
    const Count count = countOf(target, row, seeds);
    std::printf("%s, %s: %d of %d right, %d refused, %d wrong\n", name, row.name, count.right,
                seeds, count.refused, count.wrong);
    std::fflush(stdout);
    EXPECT_EQ(count.wrong, 0) << name << ", " << row.name;
    EXPECT_GE(count.right, std::floor(row.least * seeds)) << name << ", " << row.name;
    if (row.outliers > row.stated) {
      EXPECT_EQ(count.right, 0) << name << ", " << row.name;
    }
  }
}

TEST(ContaminatedScans, AreRightOrRefused) {
  check(test::lumpy(24), "lumpy body", test::isLong() ? 18 : 2);
}

TEST(ContaminatedScans, AreRightOrRefusedOnMeshesOfOthers) {
  if (!test::isLong()) GTEST_SKIP() << "runs with PATINA_LONG=1";
  for (const char* file : {"scan/spot.obj", "meshes/goathead.obj"}) {
    PATINA_SKIP_WITHOUT(test::sharedData(file));
    TriangleMesh mesh = readMesh(test::sharedData(file));
    const double across = bounds(mesh).diagonal().norm();
    for (Vec3& p : mesh.positions) p *= 0.15 / across;
    check(mesh, file, 18);
  }
}

} // namespace
} // namespace patina
