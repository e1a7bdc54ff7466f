// A path onto a mesh, against VTK's iterative closest points with all points and 500 iterations.
#include <cstdio>

#include <gtest/gtest.h>

#include <vtkCellArray.h>
#include <vtkCellLocator.h>
#include <vtkIterativeClosestPointTransform.h>
#include <vtkLandmarkTransform.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include "acquisition/registration/register_path.h"
#include "acquisition/registration_shapes.h"
#include "core/percentiles.h"
#include "field/surface/models.h"
#include "support/least_time.h"

namespace patina {
namespace {

using test::Draw;
using test::missOf;

class Vtk {
 public:
  explicit Vtk(const TriangleMesh& mesh) {
    const vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (const Vec3& p : mesh.positions) points->InsertNextPoint(p.data());
    const vtkNew<vtkCellArray> cells;
    for (const Triangle& t : mesh.triangles) {
      const vtkIdType id[] = {t[0], t[1], t[2]};
      cells->InsertNextCell(3, id);
    }
    target_->SetPoints(points);
    target_->SetPolys(cells);
    locator_->SetDataSet(target_);
    locator_->BuildLocator();
  }

  Pose fit(const std::vector<Vec3>& path, const Pose& start) const {
    const vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    const vtkNew<vtkCellArray> cells;
    for (const Vec3& p : path) {
      const Vec3 moved = start * p;
      const vtkIdType id = points->InsertNextPoint(moved.data());
      cells->InsertNextCell(1, &id);
    }
    const vtkNew<vtkPolyData> source;
    source->SetPoints(points);
    source->SetVerts(cells);
    const vtkNew<vtkIterativeClosestPointTransform> icp;
    icp->SetSource(source);
    icp->SetTarget(target_);
    icp->SetLocator(locator_);
    icp->GetLandmarkTransform()->SetModeToRigidBody();
    icp->SetMaximumNumberOfIterations(500);
    icp->SetMaximumNumberOfLandmarks(static_cast<int>(path.size()));
    icp->CheckMeanDistanceOn();
    icp->SetMaximumMeanDistance(1e-9);
    icp->Update();
    Pose step = Pose::Identity();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) step.linear()(i, j) = icp->GetMatrix()->GetElement(i, j);
      step.translation()[i] = icp->GetMatrix()->GetElement(i, 3);
    }
    return step * start;
  }

 private:
  vtkNew<vtkPolyData> target_;
  vtkNew<vtkCellLocator> locator_;
};

struct Case {
  double degrees = 15, metres = 0.01, noise = 5e-4, deviatesFromChord = 0;
  int rounds = 20;
  int vtk_every = 1; // rounds; its time needs fewer than our rate of success
};

struct Outcome {
  std::vector<double> ours, theirs;               // errors [m]
  std::vector<double> our_seconds, their_seconds; // processor time [s]
  int we_found = 0, they_found = 0;
};

Outcome compare(const SurfaceTarget& target, const Case& one) {
  const Vtk vtk(target.mesh());
  Draw draw(11);
  Outcome outcome;
  for (int round = 0; round < one.rounds; ++round) {
    const auto truth = draw.pathOn(target, 500);
    auto path = truth;
    for (Vec3& p : path) {
      p += draw.normal(one.noise);
      if (draw.uniform(0, 1) < one.deviatesFromChord)
        p += draw.uniform(5e-3, 20e-3) * draw.direction();
    }
    const Pose start = draw.off(truth, one.degrees, one.metres);
    RegistrationOptions options;
    options.noise = one.noise;
    Progress progress;
    double begin = test::threadSeconds();
    const Pose ours = registerPath(target, path, start, options, progress).mesh_from_path;
    outcome.our_seconds.push_back(test::threadSeconds() - begin);
    outcome.ours.push_back(missOf(ours, truth));
    outcome.we_found += outcome.ours.back() < 1e-3;
    if (round % one.vtk_every != 0) continue;
    begin = test::threadSeconds();
    const Pose theirs = vtk.fit(path, start);
    outcome.their_seconds.push_back(test::threadSeconds() - begin);
    outcome.theirs.push_back(missOf(theirs, truth));
    outcome.they_found += outcome.theirs.back() < 1e-3;
  }
  std::printf(
      "%g degrees, %g mm, noise %g mm, %g %% astray: error %.4f mm in %.2f ms, %d of %d; VTK "
      "%.4f mm in %.1f ms, %d of %zu\n",
      one.degrees, 1e3 * one.metres, 1e3 * one.noise, 100 * one.deviatesFromChord,
      1e3 * percentiles(outcome.ours).p50, 1e3 * percentiles(outcome.our_seconds).p50,
      outcome.we_found, one.rounds, 1e3 * percentiles(outcome.theirs).p50,
      1e3 * percentiles(outcome.their_seconds).p50, outcome.they_found, outcome.theirs.size());
  return outcome;
}

TEST(RegistrationPeers, AsExactAsVtkInATwentyFifthOfItsTime) {
  for (const bool body : {false, true}) {
    const SurfaceTarget target(body ? dinosaur() : test::lumpy(60), 0);
    const Outcome outcome = compare(target, {});
    EXPECT_LE(percentiles(outcome.ours).p50, 1.02 * percentiles(outcome.theirs).p50);
    EXPECT_LE(percentiles(outcome.our_seconds).p50, percentiles(outcome.their_seconds).p50 / 25);
  }
}

TEST(RegistrationPeers, ErrorWithoutNoiseIsBelowFiftyNanometres) {
  const Outcome outcome = compare(SurfaceTarget(dinosaur(), 0), {.noise = 0, .rounds = 10});
  EXPECT_LE(percentiles(outcome.ours).max, 5e-8);
}

TEST(RegistrationPeers, ConvergesFromSixtyDegreesInHalfOfVtksTime) {
  for (const double noise : {1e-4, 5e-4}) {
    const Outcome outcome =
        compare(SurfaceTarget(dinosaur(), 0),
                {.degrees = 60, .metres = 0.04, .noise = noise, .rounds = 40, .vtk_every = 8});
    EXPECT_GE(outcome.we_found, 38);
    EXPECT_LE(percentiles(outcome.our_seconds).p50, 0.5 * percentiles(outcome.their_seconds).p50);
  }
}

TEST(RegistrationPeers, FindsThePoseAmongOneFifthOutliers) {
  for (const double degrees : {15., 30.}) {
    const Outcome outcome =
        compare(SurfaceTarget(dinosaur(), 0),
                {.degrees = degrees, .deviatesFromChord = 0.2, .rounds = 40, .vtk_every = 20});
    EXPECT_GE(outcome.we_found, 39);
  }
}

// Along unobservable motions a path moves no farther than closest points would take it.
TEST(RegistrationPeers, SlidesNoFartherThanVtk) {
  struct Shape {
    const char* name;
    TriangleMesh mesh;
  };
  for (const Shape& shape : {Shape{"plane", sheet(0.4, 0.4, 40)},
                             {"sphere", icosphere(0.04, 60)},
                             {"tube", test::tube(0.02, 0.4, 240, 80)}}) {
    const SurfaceTarget target(shape.mesh, 0);
    const Vtk vtk(shape.mesh);
    Draw draw(12);
    std::vector<double> ours, theirs;
    for (int round = 0; round < 20; ++round) {
      std::vector<Vec3> truth;
      for (int i = 0; i < 300; ++i) {
        const double u = 0.02 * i;
        truth.push_back(target.tree()
                            .closestPoint(Vec3(0.03 * std::cos(3 * u), 0.03 * std::sin(2 * u),
                                               0.03 * std::sin(u)))
                            .point);
      }
      auto path = truth;
      for (Vec3& p : path) p += draw.normal(2e-4);
      const Pose start = draw.off(truth, 10, 5e-3);
      RegistrationOptions options;
      options.noise = 2e-4;
      Progress progress;
      const Pose fit = registerPath(target, path, start, options, progress).mesh_from_path;
      ours.push_back(missOf(fit * start.inverse(), truth));
      theirs.push_back(missOf(vtk.fit(path, start) * start.inverse(), truth));
    }
    std::printf("%s: moved %.3f mm, VTK %.3f\n", shape.name, 1e3 * percentiles(ours).p50,
                1e3 * percentiles(theirs).p50);
    EXPECT_LE(percentiles(ours).p50, 1.05 * percentiles(theirs).p50) << shape.name;
  }
}

} // namespace
} // namespace patina
