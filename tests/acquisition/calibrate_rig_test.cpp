// A marker rig that was made by hand is calibrated, from corners with independent errors.
#include "acquisition/calibration/calibrate_rig.h"

#include <array>
#include <cstdio>
#include <map>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "acquisition/printing/printed_rig.h"
#include "acquisition/simulation/simulated_rig.h"
#include "acquisition/tracking/lens.h"
#include "acquisition/tracking/marker_residual.h"
#include "acquisition/tracking/rig_misfit.h"
#include "acquisition/tracking/track_frames.h"
#include "core/error.h"
#include "support/rendered_rig.h"

namespace patina {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;

struct WavedRig {
  std::vector<RigMarker> nominal = printedRig({}).markers, real;
  WavedProbe probe;
  Camera camera = test::smallCamera();
  std::vector<RigView> views;
  std::vector<Pose> poses;
};

WavedRig waved(const HandmadeRig& made, std::uint32_t seed) {
  WavedRig rig;
  rig.real = madeByHand(rig.nominal, made, seed);
  rig.probe.seed = seed;
  return rig;
}

// `lasting`: deviation of errors that each corner keeps, as by blur and light [px].
void film(WavedRig& rig, double rate = 10, double deviation = 0.04, double lasting = 0) {
  rig.views.clear();
  rig.poses.clear();
  std::mt19937 random(rig.probe.seed);
  std::normal_distribution<double> normal(0, std::max(lasting, 1e-12));
  std::map<int, std::array<Vec2, 4>> offsets; // a marker's, by its id
  for (const RigMarker& marker : rig.real)
    for (Vec2& offset : offsets[marker.id])
      for (double& each : offset) each = normal(random);
  if (lasting == 0) random.seed(rig.probe.seed);
  for (int i = 0; i < rig.probe.seconds * rate; ++i) {
    const Pose pose = wavedPose(rig.probe, i / rate);
    RigView view{i / rate, projectedMarkers(rig.real, pose, rig.camera, deviation, random)};
    if (view.markers.empty()) continue;
    if (lasting > 0)
      for (SeenMarker& marker : view.markers)
        for (std::size_t k = 0; k < 4; ++k)
          marker.corner[k].undistorted += offsets.at(marker.id)[k];
    rig.views.push_back(view);
    rig.poses.push_back(pose);
  }
}

struct RigErrors {
  double tip = 0, size = 0;      // tip beside the first marker [m]; largest of a size, relative
  double nees = 0, tip_nees = 0; // everything that does not depend on the rig's frame
  double size_nees = 0;
};

RigErrors errorsOf(const WavedRig& rig, const RigFit& fit) {
  RigErrors errors;
  const auto n = static_cast<Eigen::Index>(rig.real.size());
  // The real rig in the frame in which the first marker lies as it was found.
  const Pose align =
      fit.markers[0].marker.probe_from_marker * rig.real[0].probe_from_marker.inverse();
  VecX off = VecX::Zero(7 * n + 3);
  MatX whole = MatX::Zero(7 * n + 3, 6); // motions of the rig as a whole
  for (Eigen::Index i = 0; i < n; ++i) {
    const RigMarker& found = fit.markers[static_cast<std::size_t>(i)].marker;
    const RigMarker& real = rig.real[static_cast<std::size_t>(i)];
    const Pose placed = align * real.probe_from_marker;
    const Eigen::AngleAxisd turn(found.probe_from_marker.linear() * placed.linear().transpose());
    off.segment<3>(6 * i) = found.probe_from_marker.translation() - placed.translation();
    off.segment<3>(6 * i + 3) = turn.angle() * turn.axis();
    off[6 * n + i] = std::log(found.size / real.size);
    errors.size = std::max(errors.size, std::abs(off[6 * n + i]));
    whole.block<6, 6>(6 * i, 0).setIdentity();
    whole.block<3, 3>(6 * i, 3) = -crossMatrix(found.probe_from_marker.translation());
  }
  const Vec3 tip = fit.tip->place;
  off.tail<3>() = tip - align * rig.probe.tip;
  errors.tip = off.tail<3>().norm();
  whole.bottomRows<3>() << Eigen::Matrix3d::Identity(), -crossMatrix(tip);
  const MatX free = Svd(whole).u.rightCols(7 * n + 3 - 6);
  const auto neesOf = [&](const MatX& by) {
    const VecX error = by.transpose() * off;
    return error.dot(SymmetricSolver(by.transpose() * fit.covariance * by).solve(error)) /
           static_cast<double>(error.size());
  };
  errors.nees = neesOf(free);
  MatX beside = MatX::Zero(7 * n + 3, 3);
  const Pose& first = fit.markers[0].marker.probe_from_marker;
  beside.block<3, 3>(0, 0).setIdentity();
  beside.block<3, 3>(3, 0) = crossMatrix(tip - first.translation());
  beside.bottomRows<3>() = -Eigen::Matrix3d::Identity();
  errors.tip_nees = neesOf(beside);
  errors.size_nees = neesOf(MatX::Identity(7 * n + 3, 7 * n + 3).middleCols(6 * n, n));
  return errors;
}

constexpr double kDegree = std::numbers::pi / 180;

struct HandmadeCase {
  double glue, degrees, print;
  std::uint32_t seed;
};
constexpr HandmadeCase kHandmade[] = {{0.1e-3, 0.2, 1, 1},    {0.3e-3, 0.5, 1, 2},
                                      {1e-3, 2, 1, 3},        {0.3e-3, 0.5, 0.99, 4},
                                      {0.3e-3, 0.5, 1.01, 5}, {1e-3, 2, 1.03, 6}};

WavedRig filmed(const HandmadeCase& made) {
  WavedRig rig = waved({made.glue, made.degrees * kDegree, made.print}, made.seed);
  film(rig);
  return rig;
}

TEST(SimulatedRig, TurnsAboutItsTipInADimpleAndRests) {
  const WavedProbe probe;
  double turned = 0;
  for (double t = 32; t <= 60; t += 0.1) {
    EXPECT_LT((wavedPose(probe, t) * probe.tip - probe.dimple).norm(), 1e-12);
    turned = std::max(turned, angleBetween(wavedPose(probe, 32), wavedPose(probe, t)));
  }
  EXPECT_GT(turned, 1); // rad
  EXPECT_GT((wavedPose(probe, 10) * probe.tip - probe.dimple).norm(), 1e-3);
  EXPECT_TRUE(wavedPose(probe, 56).isApprox(wavedPose(probe, 60)));
}

TEST(CalibrateRig, FindsTipAndSizesOfARigThatWasMadeByHand) {
  double nees = 0, tip_nees = 0;
  for (const HandmadeCase& made : kHandmade) {
    const WavedRig rig = filmed(made);
    RigFitOptions options;
    options.measured = {{0, rig.real[0].size}};
    options.calliper = 1e-6; // the size is exact
    const RigFit fit = fitRig(rig.views, rig.nominal, rig.camera, options, "frames");
    ASSERT_TRUE(fit.tip);
    const RigErrors errors = errorsOf(rig, fit);
    std::printf("glue %.1f mm print %.2f: tip %.3f mm, sizes %.3f %%, NEES %.2f, tip %.2f; rms "
                "%.2f -> %.3f px\n",
                1e3 * made.glue, made.print, 1e3 * errors.tip, 100 * errors.size, errors.nees,
                errors.tip_nees, fit.rms_before, fit.rms);
    EXPECT_LT(errors.tip, 0.15e-3);
    EXPECT_LT(errors.size, 1e-3);
    EXPECT_LT(errors.nees, 4);
    EXPECT_LT(errors.tip_nees, 4);
    EXPECT_LT(fit.rms, 0.06); // corners of 0.04 px each axis
    EXPECT_GT(fit.rms_before, 3 * fit.rms);
    EXPECT_TRUE(fit.held.empty()) << fit.held[0];
    EXPECT_NEAR(fit.print_scale, made.print, 3 * fit.print_scale_deviation + 1e-3);
    nees += errors.nees / std::size(kHandmade);
    tip_nees += errors.tip_nees / std::size(kHandmade);
  }
  EXPECT_GT(nees, 0.5);
  EXPECT_LT(nees, 2);
  EXPECT_GT(tip_nees, 0.2); // 3 values only, and a dimple that is better than is assumed
  EXPECT_LT(tip_nees, 2);
}

TEST(CalibrateRig, SaysWhatTheMotionDoesNotDetermine) {
  WavedRig rig = waved({0.3e-3, 0.5 * kDegree, 1}, 7);
  rig.probe.seconds = 120; // the first half is waved
  film(rig);
  rig.views.resize(rig.views.size() / 2 - 20);
  const RigFit fit = fitRig(rig.views, rig.nominal, rig.camera, {}, "frames");
  EXPECT_FALSE(fit.tip);
  ASSERT_EQ(fit.held.size(), 2u);
  EXPECT_NE(fit.held[0].find("--length"), std::string::npos) << fit.held[0];
  EXPECT_NE(fit.held[1].find("the tip stays"), std::string::npos) << fit.held[1];
  // A print whose scale nobody measured is assumed to be right to one percent.
  EXPECT_GT(fit.print_scale_deviation, 2e-3);
  EXPECT_LT(fit.print_scale_deviation, 0.01);

  for (RigView& view : rig.views)
    std::erase_if(view.markers, [](const SeenMarker& seen) { return seen.id == 2; });
  const RigFit less = fitRig(rig.views, rig.nominal, rig.camera, {}, "frames");
  EXPECT_EQ(less.markers[2].views, 0u);
  EXPECT_EQ(less.markers[2].shift, 0);
  EXPECT_NE(less.held[1].find("marker 2"), std::string::npos) << less.held[1];
}

TEST(CalibrateRig, NamesExchangedTurnedAndMovedMarkers) {
  const auto findings = [](WavedRig rig) {
    film(rig);
    const RigFit fit = fitRig(rig.views, rig.nominal, rig.camera, {}, "frames");
    EXPECT_LT(fit.rms, 0.06);
    std::string all;
    for (const FittedMarker& marker : fit.markers)
      if (!marker.finding.empty())
        all += std::to_string(marker.marker.id) + " " + marker.finding + "; ";
    return all;
  };
  const HandmadeRig glued{0.02e-3, 0.05 * kDegree, 1};
  EXPECT_EQ(findings(waved(glued, 5)), "");
  for (const auto& [a, b] : {std::pair(1, 3), std::pair(1, 2), std::pair(0, 1)}) {
    WavedRig rig = waved(glued, 5);
    std::swap(rig.real[static_cast<std::size_t>(a)].probe_from_marker,
              rig.real[static_cast<std::size_t>(b)].probe_from_marker);
    EXPECT_EQ(findings(rig), std::to_string(a) + " is where marker " + std::to_string(b) +
                                 " should be; " + std::to_string(b) + " is where marker " +
                                 std::to_string(a) + " should be; ");
  }
  WavedRig turned = waved(glued, 5);
  turned.real[2].probe_from_marker.rotate(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()));
  EXPECT_EQ(findings(turned), "2 is turned by 90 degrees; ");
  WavedRig moved = waved(glued, 5);
  moved.real[3].probe_from_marker.translation() += Vec3(0.6e-3, 0, 0.8e-3);
  const std::string found = findings(moved);
  EXPECT_TRUE(found.starts_with("3 lies ") && found.find("; ") + 2 == found.size()) << found;
}

TEST(CalibrateRig, RefinesTheCamera) {
  WavedRig rig = waved({0.3e-3, 0.5 * kDegree, 1}, 8);
  film(rig);
  Camera wrong = rig.camera;
  wrong.fx *= 1.004, wrong.fy *= 1.004, wrong.cx += 3;
  for (RigView& view : rig.views)
    for (SeenMarker& seen : view.markers)
      for (FittedCorner& corner : seen.corner)
        corner.undistorted = undistortedPoint(wrong, corner.pixel).value();
  RigFitOptions options;
  options.measured = {{0, rig.real[0].size}};
  options.refine_camera = true;
  const RigFit fit = fitRig(rig.views, rig.nominal, wrong, options, "frames");
  EXPECT_NEAR(fit.camera.fx, rig.camera.fx, 4 * fit.camera_deviation[0]);
  EXPECT_NEAR(fit.camera.fy, rig.camera.fy, 4 * fit.camera_deviation[1]);
  EXPECT_NEAR(fit.camera.cx, rig.camera.cx, 4 * fit.camera_deviation[2]);
  EXPECT_LT(fit.camera_deviation[0], 1); // px
  EXPECT_LT(fit.rms, 0.06);
}

TEST(CalibrateRig, RefusesViewsThatDoNotSuffice) {
  const auto refusal = [](const WavedRig& rig, const RigFitOptions& options = {}) -> std::string {
    try {
      (void)fitRig(rig.views, rig.nominal, rig.camera, options, "frames");
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  WavedRig rig = filmed(kHandmade[0]);
  RigFitOptions options;
  options.measured = {{9, 0.027}};
  EXPECT_NE(refusal(rig, options).find("the rig has no marker 9"), std::string::npos);
  WavedRig single = rig;
  for (RigView& view : single.views) view.markers.resize(1);
  EXPECT_NE(refusal(single).find("two markers of the rig together"), std::string::npos);
  WavedRig still = rig;
  still.views.assign(100, rig.views[300]);
  EXPECT_NE(refusal(still).find("the rig turns by 0 degrees only"), std::string::npos)
      << refusal(still);
}

// Tracks the corners by the nominal rig and judges it.
struct JudgedRig {
  RigMisfit::Diagnosis doubt;
  std::vector<CameraPose> before, after;
  double beyond = 0; // part of the poses whose tip is off by more than three deviations
};

JudgedRig judged(const WavedRig& rig) {
  JudgedRig out;
  RigMisfit misfit(rig.nominal, rig.camera);
  std::vector<Pose> real;
  for (std::size_t v = 0; v < rig.views.size(); ++v) {
    const SeenRig seen = poseOf(rig.views[v].markers, rig.nominal, rig.camera);
    const bool posed = seen.verdict == RigVerdict::seen;
    misfit.add(rig.views[v].markers, seen, posed ? std::optional(out.before.size()) : std::nullopt);
    if (!posed) continue;
    out.before.push_back(cameraPose(seen, rig.views[v].t));
    real.push_back(rig.poses[v]);
  }
  out.after = out.before;
  out.doubt = misfit.judge(out.after);
  for (std::size_t i = 0; i < real.size(); ++i) {
    const CameraPose& pose = out.after[i];
    const Vec3& tip = rig.probe.tip;
    const double off = (pose.position + pose.orientation * tip - real[i] * tip).norm();
    const double variance = 3 * pose.sigma_position * pose.sigma_position +
                            2 * pose.sigma_angle * pose.sigma_angle * tip.squaredNorm();
    out.beyond += off > 3 * std::sqrt(variance) ? 1. / static_cast<double>(real.size()) : 0;
  }
  return out;
}

TEST(RigMisfit, IsNoticedAndCoveredByTheDeviations) {
  for (const HandmadeCase& made : kHandmade) {
    const JudgedRig found = judged(filmed(made));
    EXPECT_NE(found.doubt.text, "") << made.seed;
    EXPECT_LT(found.beyond, 1e-2) << made.seed;
  }
}

TEST(RigMisfit, NamesItsCause) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    WavedRig large = waved({0, 0, 1.01}, seed);
    film(large);
    const JudgedRig print = judged(large);
    EXPECT_NE(print.doubt.text.find("all markers are"), std::string::npos) << print.doubt.text;
    EXPECT_NE(print.doubt.text.find("larger"), std::string::npos) << print.doubt.text;
    EXPECT_NEAR(print.doubt.scale, 0.01, 1e-3);
    WavedRig moved = waved({}, seed);
    moved.real[3].probe_from_marker.translation() += Vec3(0.6e-3, 0, 0.8e-3);
    film(moved);
    const std::string text = judged(moved).doubt.text;
    EXPECT_TRUE(text.starts_with("marker 3 lies ")) << text;
    WavedRig swapped = waved({}, seed);
    std::swap(swapped.real[1].probe_from_marker, swapped.real[3].probe_from_marker);
    film(swapped);
    const JudgedRig wrong = judged(swapped);
    EXPECT_TRUE(wrong.doubt.text.starts_with(
        "marker 1 is where marker 3 should be, marker 3 is where marker 1 should be"))
        << wrong.doubt.text;
    EXPECT_LT(wrong.beyond, 1e-2);
  }
}

TEST(RigMisfit, LeavesARightRigAsItIs) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed)
    for (const double deviation : {0.02, 0.3}) {
      WavedRig rig = waved({}, seed);
      film(rig, 10, deviation, 0.02);
      const JudgedRig found = judged(rig);
      EXPECT_EQ(found.doubt.text, "");
      ASSERT_EQ(found.before.size(), found.after.size());
      for (std::size_t i = 0; i < found.before.size(); ++i)
        EXPECT_EQ(found.before[i].sigma_position, found.after[i].sigma_position);
    }
}

// Returns the rig as its calibration has it, with its deviations.
std::vector<RigMarker> asCalibrated(const RigFit& fit) {
  std::vector<RigMarker> markers;
  for (const FittedMarker& found : fit.markers) {
    markers.push_back(found.marker);
    markers.back().size_deviation = found.size_deviation;
    markers.back().place_deviation = found.shift_deviation;
    markers.back().angle_deviation = found.turn_deviation;
  }
  return markers;
}

TEST(RigMisfit, LeavesACalibratedRigAsItIsButNamesAMarkerThatMovedSince) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    WavedRig rig = waved({0.3e-3, 0.5 * kDegree, 1.01}, seed);
    film(rig);
    RigFitOptions options;
    options.measured = {{rig.real[0].id, rig.real[0].size}};
    rig.nominal = asCalibrated(fitRig(rig.views, rig.nominal, rig.camera, options, "frames"));
    // A scan shows the rig from fewer sides, and its corners better than the waved probe's.
    rig.probe.tilt = 0.3;
    rig.probe.seed = seed + 10;
    film(rig, 10, 0.03);
    EXPECT_EQ(judged(rig).doubt.text, "") << seed;
    rig.real[3].probe_from_marker.translation() += Vec3(0.6e-3, 0, 0.8e-3);
    film(rig, 10, 0.03);
    const std::string text = judged(rig).doubt.text;
    EXPECT_TRUE(text.starts_with("marker 3 lies ")) << text;
  }
}

} // namespace
} // namespace patina
