#include "acquisition/calibration/calibrate_rig.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "acquisition/calibration/calibrate_camera.h"
#include "acquisition/loaded/solver_library.h"
#include "acquisition/tracking/lens.h"
#include "acquisition/tracking/marker_residual.h"
#include "core/error.h"
#include "core/numbers.h"
#include "core/percentiles.h"

namespace patina {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
template <int rows, int columns>
using Slopes = Eigen::Map<Eigen::Matrix<double, rows, columns, Eigen::RowMajor>>;

constexpr std::size_t kMostViews = 160, kMostDimpleViews = 100; // frames that are adjusted
constexpr std::size_t kFewestViews = 10;
constexpr double kLeastTurn = 0.35; // smallest turn between the views [rad]

constexpr double kCauchyScale = 3;    // Cauchy's scale, in expected norms
constexpr double kMedian8 = 7.344;    // median of chi-square with 8 degrees of freedom
constexpr double kMedianNorm = 1.538; // median of |N(0, I3)|
constexpr double kStandsOut = 8,
                 kLeastMoved = 0.3e-3; // least shift of a moved marker [deviations], [m]
constexpr int kAlignSteps = 30;
constexpr double kAlignFloor = 0.5;  // distance below which a marker counts no more [deviations]
constexpr double kHardlyKnown = 0.6; // deviation over that before the fit

// Standard deviations of a camera before it is refined: fx fy cx cy relative to the picture's
// width, then k1 k2 p1 p2 k3.
constexpr std::array<double, 9> kCameraPrior{0.01, 0.01, 0.01, 0.01, 0.05, 0.1, 3e-3, 3e-3, 0.1};
constexpr std::array<double, 9> kCameraStep{1e-6, 1e-6, 1e-6, 1e-6, 1e-5, 1e-5, 1e-6, 1e-6, 1e-5};

// A change dw of the rotation vector w turns by J dw: the left Jacobian of SO(3).
Eigen::Matrix3d turnJacobian(const Vec3& w) {
  const double angle = w.norm();
  const Eigen::Matrix3d x = crossMatrix(w);
  if (angle < 1e-5) return Eigen::Matrix3d::Identity() + 0.5 * x;
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / (angle * angle) * x +
         (angle - std::sin(angle)) / (angle * angle * angle) * x * x;
}

std::string textOf(double value, const char* format) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

struct UsedView {
  const RigView* view;
  Pose camera_from_probe;
  int dimple = -1;
};

// The problem and its present solution.
struct Bundle {
  const std::vector<RigMarker>& rig;
  const std::vector<MarkerStart>& starts;
  const Camera& camera;
  const RigFitOptions& options;
  double place, angle; // deviations of a marker that is not misplaced [m], [rad]
  std::vector<UsedView> used{};
  std::vector<bool> is_seen{};
  std::optional<Vec3> tip{}; // a value to find
  std::vector<Vec3> dimples{};
  double unit = 1; // the corners' deviations over those of their edges
  std::vector<double> values{};
  SparseLeastSquares task{};
  // Blocks: the print scale, the markers' poses and sizes, then those that the problem has.
  int tip_block = -1, camera_block = -1, first_dimple = -1, first_view = -1;

  int poseBlock(std::size_t marker) const { return 1 + 2 * static_cast<int>(marker); }
  int sizeBlock(std::size_t marker) const { return poseBlock(marker) + 1; }
  const double* at(int block) const {
    return values.data() + task.blocks[static_cast<std::size_t>(block)].first;
  }
  Vec6 motionAt(int block) const { return Eigen::Map<const Vec6>(at(block)); }
  RigMarker markerAt(std::size_t i, const double* motion, const double* growth) const {
    RigMarker marker = rig[i];
    marker.probe_from_marker =
        movedPose(starts[i].probe_from_marker, Eigen::Map<const Vec6>(motion));
    marker.size *= std::exp(*growth);
    return marker;
  }
  RigMarker markerNow(std::size_t i) const {
    return is_seen.empty() || is_seen[i] ? markerAt(i, at(poseBlock(i)), at(sizeBlock(i))) : [&] {
      RigMarker marker = rig[i];
      marker.probe_from_marker = starts[i].probe_from_marker;
      return marker;
    }();
  }
  std::vector<RigMarker> rigNow() const {
    std::vector<RigMarker> now;
    for (std::size_t i = 0; i < rig.size(); ++i) now.push_back(markerNow(i));
    return now;
  }
  double placeOf(std::size_t i) const { return std::max(place, starts[i].place); }
  double angleOf(std::size_t i) const { return std::max(angle, starts[i].angle); }
};

double& cameraValue(Camera& camera, std::size_t i) {
  double* const first[] = {&camera.fx, &camera.fy, &camera.cx, &camera.cy};
  return i < 4 ? *first[i] : camera.distortion[i - 4];
}

double cameraPrior(const Camera& camera, std::size_t i) {
  return kCameraPrior[i] * (i < 4 ? camera.width : 1);
}

Camera cameraAt(const Camera& camera, const double* change) {
  Camera out = camera;
  for (std::size_t i = 0; i < 9; ++i) cameraValue(out, i) += change[i];
  return out;
}

// Returns the marker as another camera undistorts it.
SeenMarker undistortedBy(const Camera& camera, SeenMarker seen) {
  for (FittedCorner& corner : seen.corner)
    corner.undistorted = undistortedPoint(camera, corner.pixel).value_or(corner.undistorted);
  return seen;
}

SparseLeastSquares::Term cornerTerm(const Bundle& bundle, std::size_t view, std::size_t marker) {
  SparseLeastSquares::Term term;
  term.blocks = {bundle.first_view + static_cast<int>(view), bundle.poseBlock(marker),
                 bundle.sizeBlock(marker)};
  if (bundle.camera_block >= 0) term.blocks.push_back(bundle.camera_block);
  term.residuals = 8;
  term.robust = kCauchyScale * std::sqrt(8.);
  const UsedView& used = bundle.used[view];
  const SeenMarker* image = imageOf(bundle.rig[marker], *used.view);
  term.evaluate = [&bundle, &used, image, marker](const double* const* values, double* residuals,
                                                  double* const* slopes) {
    const Pose pose = movedPose(used.camera_from_probe, Eigen::Map<const Vec6>(values[0]));
    const RigMarker placed = bundle.markerAt(marker, values[1], values[2]);
    const bool refined = bundle.camera_block >= 0;
    const Camera camera = refined ? cameraAt(bundle.camera, values[3]) : bundle.camera;
    const auto found =
        markerResidual(refined ? undistortedBy(camera, *image) : *image, placed, pose, camera);
    if (!found) return false;
    const double scale = 1 / bundle.unit;
    Eigen::Map<Eigen::Matrix<double, 8, 1>>{residuals} = scale * found->error;
    if (!slopes) return true;
    const auto chain = [scale](Eigen::Matrix<double, 8, 6> by, const double* motion, double* out) {
      if (!out) return;
      by.rightCols<3>() *= turnJacobian(Eigen::Map<const Vec3>(motion + 3));
      Slopes<8, 6>{out} = scale * by;
    };
    chain(found->by_frame, values[0], slopes[0]);
    chain(found->by_marker, values[1], slopes[1]);
    if (slopes[2]) Eigen::Map<Eigen::Matrix<double, 8, 1>>{slopes[2]} = scale * found->by_size;
    if (!refined || !slopes[3]) return true;
    for (std::size_t i = 0; i < 9; ++i) {
      std::array<Eigen::Matrix<double, 8, 1>, 2> side;
      const double step = kCameraStep[i] * (i < 4 ? bundle.camera.width : 1);
      for (const int sign : {0, 1}) {
        Camera other = camera;
        cameraValue(other, i) += (sign ? 1 : -1) * step;
        const auto there = markerResidual(undistortedBy(other, *image), placed, pose, other);
        if (!there) return false;
        side[static_cast<std::size_t>(sign)] = there->error;
      }
      Slopes<8, 9>(slopes[3]).col(static_cast<int>(i)) = scale / (2 * step) * (side[1] - side[0]);
    }
    return true;
  };
  return term;
}

SparseLeastSquares::Term dimpleTerm(const Bundle& bundle, std::size_t view) {
  SparseLeastSquares::Term term;
  const UsedView& used = bundle.used[view];
  term.blocks = {bundle.first_view + static_cast<int>(view), bundle.tip_block,
                 bundle.first_dimple + used.dimple};
  term.residuals = 3;
  term.robust = kCauchyScale * std::sqrt(3.);
  term.evaluate = [&bundle, &used](const double* const* values, double* residuals,
                                   double* const* slopes) {
    const Pose pose = movedPose(used.camera_from_probe, Eigen::Map<const Vec6>(values[0]));
    const Vec3 arm = pose.linear() * Eigen::Map<const Vec3>(values[1]);
    const double scale = 1 / bundle.options.dimple;
    Eigen::Map<Vec3>{residuals} =
        scale * (arm + pose.translation() - Eigen::Map<const Vec3>(values[2]));
    if (!slopes) return true;
    if (slopes[0]) {
      Slopes<3, 6> by(slopes[0]);
      by.leftCols<3>() = scale * Eigen::Matrix3d::Identity();
      by.rightCols<3>() =
          -scale * crossMatrix(arm) * turnJacobian(Eigen::Map<const Vec3>(values[0] + 3));
    }
    if (slopes[1]) Slopes<3, 3>{slopes[1]} = scale * pose.linear();
    if (slopes[2]) Slopes<3, 3>{slopes[2]} = -scale * Eigen::Matrix3d::Identity();
    return true;
  };
  return term;
}

// Returns the difference of a block's values from `expected`, each over its deviation.
SparseLeastSquares::Term priorTerm(int block, const VecX& expected, const VecX& deviation) {
  SparseLeastSquares::Term term;
  term.blocks = {block};
  term.residuals = static_cast<int>(expected.size());
  term.evaluate = [expected, deviation](const double* const* values, double* residuals,
                                        double* const* slopes) {
    const auto n = expected.size();
    Eigen::Map<VecX>{residuals, n} =
        (Eigen::Map<const VecX>(values[0], n) - expected).cwiseQuotient(deviation);
    if (slopes && slopes[0]) {
      const MatX by = deviation.cwiseInverse().asDiagonal();
      Eigen::Map<MatX>{slopes[0], n, n} = by;
    }
    return true;
  };
  return term;
}

VecX placeAndAngle(double place, double angle) {
  return (VecX(6) << Vec3::Constant(place), Vec3::Constant(angle)).finished();
}

// Writes the problem of the bundle's views.
void setUp(Bundle& bundle) {
  SparseLeastSquares& task = bundle.task;
  const bool has_values = !bundle.values.empty();
  const std::vector<double> before = bundle.values;
  const std::vector<SparseLeastSquares::Block> blocks_before = task.blocks;
  task = {};
  bundle.values.clear();
  const auto add = [&](int size, bool eliminated) {
    SparseLeastSquares::Block block;
    block.first = static_cast<int>(bundle.values.size());
    block.size = size;
    block.eliminated = eliminated;
    task.blocks.push_back(block);
    bundle.values.resize(bundle.values.size() + static_cast<std::size_t>(size));
    return static_cast<int>(task.blocks.size()) - 1;
  };
  add(1, false);
  for (std::size_t i = 0; i < bundle.rig.size(); ++i) add(6, false), add(1, false);
  if (has_values) std::copy_n(before.begin(), bundle.values.size(), bundle.values.begin());
  bundle.camera_block = bundle.options.refine_camera ? add(9, false) : -1;
  bundle.tip_block = bundle.tip ? add(3, false) : -1;
  if (bundle.tip) std::copy_n(bundle.tip->data(), 3, bundle.values.end() - 3);
  bundle.first_dimple = static_cast<int>(task.blocks.size());
  for (const Vec3& dimple : bundle.dimples) {
    add(3, false);
    std::copy_n(dimple.data(), 3, bundle.values.end() - 3);
  }
  bundle.first_view = static_cast<int>(task.blocks.size());
  for (std::size_t v = 0; v < bundle.used.size(); ++v) add(6, true);

  bundle.is_seen.assign(bundle.rig.size(), false);
  for (std::size_t v = 0; v < bundle.used.size(); ++v) {
    for (std::size_t i = 0; i < bundle.rig.size(); ++i) {
      if (!imageOf(bundle.rig[i], *bundle.used[v].view)) continue;
      bundle.is_seen[i] = true;
      task.terms.push_back(cornerTerm(bundle, v, i));
    }
    if (bundle.used[v].dimple >= 0) task.terms.push_back(dimpleTerm(bundle, v));
  }
  const RigFitOptions& options = bundle.options;
  for (std::size_t i = 0; i < bundle.rig.size(); ++i) {
    task.terms.push_back(priorTerm(bundle.poseBlock(i), VecX::Zero(6),
                                   placeAndAngle(bundle.placeOf(i), bundle.angleOf(i))));
    SparseLeastSquares::Term own;
    own.blocks = {bundle.sizeBlock(i), 0};
    own.residuals = 1;
    own.robust = kCauchyScale;
    own.evaluate = [scale = 1 / options.own_print](const double* const* values, double* residuals,
                                                   double* const* slopes) {
      residuals[0] = scale * (values[0][0] - values[1][0]);
      if (slopes && slopes[0]) slopes[0][0] = scale;
      if (slopes && slopes[1]) slopes[1][0] = -scale;
      return true;
    };
    task.terms.push_back(own);
  }
  const auto known = [&](int block, double value, double deviation) {
    task.terms.push_back(priorTerm(block, VecX::Constant(1, value), VecX::Constant(1, deviation)));
  };
  known(0, 0, options.print);
  for (const MeasuredSize& measured : options.measured)
    for (std::size_t i = 0; i < bundle.rig.size(); ++i)
      if (bundle.rig[i].id == measured.id)
        known(bundle.sizeBlock(i), std::log(measured.size / bundle.rig[i].size),
              options.calliper / measured.size);
  if (bundle.camera_block >= 0) {
    VecX deviation(9);
    for (std::size_t k = 0; k < 9; ++k)
      deviation[static_cast<int>(k)] = cameraPrior(bundle.camera, k);
    task.terms.push_back(priorTerm(bundle.camera_block, VecX::Zero(9), deviation));
  }
}

void requireAdjusted(const std::string& cause) {
  if (!cause.empty()) throw Error("the rig cannot be adjusted: " + cause);
}

// Solves the problem, with the corners' deviations as the solution has them.
void adjustBundle(Bundle& bundle) {
  setUp(bundle);
  for (int round = 0; round < 3; ++round) {
    std::vector<double> squares;
    for (const SparseLeastSquares::Term& term : bundle.task.terms) {
      if (term.residuals != 8) continue;
      std::vector<const double*> places;
      for (const int block : term.blocks) places.push_back(bundle.at(block));
      Eigen::Matrix<double, 8, 1> residual;
      if (term.evaluate(places.data(), residual.data(), nullptr))
        squares.push_back(bundle.unit * bundle.unit * residual.squaredNorm());
    }
    const double residuals = 8 * static_cast<double>(squares.size());
    const double lost = 6 * static_cast<double>(bundle.used.size());
    const double left = std::max(0.2, 1 - lost / std::max(residuals, 1.));
    bundle.unit =
        squares.empty() ? 1 : std::max(1., std::sqrt(percentiles(squares).p50 / kMedian8 / left));
    LeastSquaresSteps steps;
    requireAdjusted(solverLibrary().solveSparse(bundle.task, bundle.values, steps));
  }
}

// Returns the reprojection error of all corners in these poses, weighted by accuracy [px].
double cornerRms(const std::vector<UsedView>& used, const std::vector<Pose>& poses,
                 const std::vector<RigMarker>& rig, const Camera& camera) {
  double squares = 0, weights = 0;
  for (std::size_t v = 0; v < used.size(); ++v)
    for (const RigMarker& marker : rig) {
      const SeenMarker* image = imageOf(marker, *used[v].view);
      if (!image) continue;
      const auto residual = markerResidual(undistortedBy(camera, *image), marker, poses[v], camera);
      if (!residual) continue;
      squares += 2 * residual->error.squaredNorm();
      for (const FittedCorner& corner : image->corner) weights += corner.whiten.squaredNorm();
    }
  return weights > 0 ? std::sqrt(squares / weights) : 0;
}

// The rig in the frame in which most markers lie where they are expected: least sum of distances,
// which a marker that was moved hardly changes.
struct AlignedRig {
  std::vector<RigMarker> markers;
  Vec3 tip = Vec3::Zero();
  std::vector<double> weights; // weights of the last least-squares step; 0: not seen
};

// The shift and turn of a marker by those of the rig as a whole about its origin.
Mat6 wholeMotion(const RigMarker& marker) {
  Mat6 whole = Mat6::Identity();
  whole.topRightCorner<3, 3>() = -crossMatrix(marker.probe_from_marker.translation());
  return whole;
}

AlignedRig alignedRig(const Bundle& bundle) {
  AlignedRig rig{bundle.rigNow(), Vec3::Zero(), std::vector<double>(bundle.rig.size())};
  if (bundle.tip) rig.tip = Eigen::Map<const Vec3>(bundle.at(bundle.tip_block));
  for (int step = 0; step < kAlignSteps; ++step) {
    Mat6 normal = Mat6::Zero();
    Vec6 right = Vec6::Zero();
    for (std::size_t i = 0; i < rig.markers.size(); ++i) {
      if (!bundle.is_seen[i]) continue;
      const Pose& pose = rig.markers[i].probe_from_marker;
      const Pose& expected = bundle.starts[i].probe_from_marker;
      const Eigen::AngleAxisd turn(pose.linear() * expected.linear().transpose());
      Vec6 off;
      off << pose.translation() - expected.translation(), turn.angle() * turn.axis();
      const VecX scale = placeAndAngle(bundle.placeOf(i), bundle.angleOf(i)).cwiseInverse();
      const Vec6 scaled = scale.cwiseProduct(off);
      const Mat6 by = scale.asDiagonal() * wholeMotion(rig.markers[i]);
      rig.weights[i] = 1 / std::max(kAlignFloor, scaled.norm());
      normal += rig.weights[i] * by.transpose() * by;
      right -= rig.weights[i] * by.transpose() * scaled;
    }
    const Vec6 motion = SymmetricSolver(normal).solve(right);
    const Pose move = movedPose(Pose::Identity(), motion);
    for (std::size_t i = 0; i < rig.markers.size(); ++i)
      if (bundle.is_seen[i])
        rig.markers[i].probe_from_marker = move * rig.markers[i].probe_from_marker;
    rig.tip = move * rig.tip;
  }
  return rig;
}

// Projects a covariance of the seen markers' motions, sizes and the tip to the frame of the aligned
// rig (S-transformation: Baarda 1973): shifts and turns of the rig as a whole, which no frame
// shows, take no part.
MatX inAlignedFrame(const Bundle& bundle, const AlignedRig& rig,
                    const std::vector<std::size_t>& seen, const MatX& joint) {
  const auto count = static_cast<Eigen::Index>(seen.size()), size = joint.rows();
  MatX to_motion = MatX::Identity(size, size), whole = MatX::Zero(size, 6);
  VecX weight = VecX::Zero(size);
  for (Eigen::Index k = 0; k < count; ++k) {
    const std::size_t i = seen[static_cast<std::size_t>(k)];
    const Vec6 motion = bundle.motionAt(bundle.poseBlock(i));
    to_motion.block<3, 3>(6 * k + 3, 6 * k + 3) = turnJacobian(motion.tail<3>());
    whole.block<6, 6>(6 * k, 0) = wholeMotion(rig.markers[i]);
    weight.segment<6>(6 * k) =
        rig.weights[i] *
        placeAndAngle(bundle.placeOf(i), bundle.angleOf(i)).array().square().inverse().matrix();
  }
  if (bundle.tip) whole.bottomRows<3>() << Eigen::Matrix3d::Identity(), -crossMatrix(rig.tip);
  const MatX weighted = weight.asDiagonal() * whole;
  const MatX project =
      MatX::Identity(size, size) -
      whole * SymmetricSolver(whole.transpose() * weighted).solveColumns(weighted.transpose());
  const MatX both = project * to_motion;
  return both * joint * both.transpose();
}

double rmsDeviation(const MatX& covariance, Eigen::Index first) {
  return std::sqrt(std::max(0., covariance.block<3, 3>(first, first).trace() / 3));
}

void readResult(const Bundle& bundle, RigFit& fit) {
  std::vector<std::size_t> seen;
  std::vector<int> blocks;
  for (std::size_t i = 0; i < bundle.rig.size(); ++i)
    if (bundle.is_seen[i]) seen.push_back(i), blocks.push_back(bundle.poseBlock(i));
  for (const std::size_t i : seen) blocks.push_back(bundle.sizeBlock(i));
  if (bundle.tip) blocks.push_back(bundle.tip_block);
  auto size = static_cast<Eigen::Index>(7 * seen.size() + (bundle.tip ? 3 : 0));
  blocks.push_back(0);
  if (bundle.camera_block >= 0) blocks.push_back(bundle.camera_block);
  const Eigen::Index all = size + 1 + (bundle.camera_block >= 0 ? 9 : 0);
  std::vector<double> numbers;
  requireAdjusted(solverLibrary().sparseCovariance(bundle.task, bundle.values, blocks, numbers));
  const MatX joint = Eigen::Map<const MatX>(numbers.data(), all, all);
  const AlignedRig aligned = alignedRig(bundle);
  fit.covariance = inAlignedFrame(bundle, aligned, seen, joint.topLeftCorner(size, size));
  fit.print_scale = std::exp(bundle.values[0]);
  fit.print_scale_deviation = std::sqrt(joint(size, size));
  if (fit.print_scale_deviation > kHardlyKnown / 2 * bundle.options.print)
    fit.held.push_back("the size of the whole rig is known only to " +
                       textOf(100 * fit.print_scale_deviation, "%.2f") +
                       " %, as rig.json has it: measure a marker (--length ID=SIZE)");
  fit.camera = bundle.camera;
  if (bundle.camera_block >= 0) {
    fit.camera = cameraAt(bundle.camera, bundle.at(bundle.camera_block));
    std::string kept;
    for (std::size_t k = 0; k < 9; ++k) {
      const Eigen::Index at = size + 1 + static_cast<Eigen::Index>(k);
      fit.camera_deviation[k] = std::sqrt(joint(at, at));
      if (fit.camera_deviation[k] > kHardlyKnown * cameraPrior(bundle.camera, k))
        kept += (kept.empty() ? "" : ", ") + std::string(kCameraParameters[k]);
    }
    if (!kept.empty()) fit.held.push_back("the camera's " + kept + ": no view determines it");
  }
  for (std::size_t i = 0, k = 0; i < bundle.rig.size(); ++i) {
    FittedMarker found;
    found.marker = aligned.markers[i];
    found.finding = bundle.starts[i].finding;
    const std::string name = "marker " + std::to_string(found.marker.id);
    if (!bundle.is_seen[i]) {
      found.shift_deviation = bundle.placeOf(i), found.turn_deviation = bundle.angleOf(i);
      found.size_deviation = bundle.options.print * found.marker.size;
      fit.held.push_back(name + " is in no frame with another one: it stays as rig.json has it");
    } else {
      const auto at = static_cast<Eigen::Index>(6 * k);
      const Eigen::Index size_at = static_cast<Eigen::Index>(6 * seen.size() + k++);
      found.shift_deviation = rmsDeviation(fit.covariance, at);
      found.turn_deviation = rmsDeviation(fit.covariance, at + 3);
      found.size_deviation = found.marker.size * std::sqrt(fit.covariance(size_at, size_at));
      const Pose& expected = bundle.rig[i].probe_from_marker;
      found.shift = (found.marker.probe_from_marker.translation() - expected.translation()).norm();
      found.turn = angleBetween(found.marker.probe_from_marker, expected);
      for (const UsedView& used : bundle.used)
        found.views += imageOf(found.marker, *used.view) != nullptr;
      if (found.shift_deviation > kHardlyKnown * bundle.placeOf(i))
        fit.held.push_back(name + " is known only to " + formatLength(found.shift_deviation) +
                           ": too few frames show it with others");
    }
    fit.markers.push_back(found);
  }
  // A marker that is off by more than the others was moved after they were glued.
  for (FittedMarker& marker : fit.markers) {
    if (marker.views == 0) continue;
    std::vector<double> others;
    for (const FittedMarker& other : fit.markers)
      if (other.views > 0 && &other != &marker) others.push_back(other.shift / kMedianNorm);
    if (others.size() < 2) continue;
    const double usual = std::hypot(percentiles(others).p50, marker.shift_deviation);
    if (!marker.finding.empty() && marker.finding != "is elsewhere") continue;
    if (!marker.finding.empty() || marker.shift > std::max(kStandsOut * usual, kLeastMoved))
      marker.finding = "lies " + formatLength(marker.shift) + " off";
  }
  if (!bundle.tip) {
    fit.held.push_back("the tip stays as rig.json has it: the probe does not turn about its tip "
                       "in a dimple for some seconds");
    return;
  }
  FittedTip tip;
  tip.place = aligned.tip;
  const Vec3 adjusted = Eigen::Map<const Vec3>(bundle.at(bundle.tip_block));
  tip.covariance = fit.covariance.bottomRightCorner<3, 3>();
  tip.dimples = bundle.dimples.size();
  double squares = 0;
  for (std::size_t v = 0; v < bundle.used.size(); ++v) {
    const UsedView& used = bundle.used[v];
    if (used.dimple < 0) continue;
    const Pose pose =
        movedPose(used.camera_from_probe, bundle.motionAt(bundle.first_view + static_cast<int>(v)));
    const Vec3 dimple = Eigen::Map<const Vec3>(bundle.at(bundle.first_dimple + used.dimple));
    squares += (pose * adjusted - dimple).squaredNorm();
    ++tip.views;
  }
  tip.rms = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, tip.views)));
  fit.tip = tip;
}

void requireEnough(const std::vector<RigView>& views, const ViewPoses& poses,
                   const std::string& from) {
  std::size_t count = 0;
  double turn = 0;
  const Pose* first = nullptr;
  for (const std::optional<Pose>& pose : poses) {
    if (!pose) continue;
    if (!first) first = &*pose;
    turn = std::max(turn, angleBetween(*first, *pose));
    ++count;
  }
  if (count < kFewestViews)
    throw FileError(from, 0,
                    formatCount(count) + " of " + formatCount(views.size()) +
                        " frames with markers show two markers of the rig together, and " +
                        formatCount(kFewestViews) +
                        " at least are needed: turn the rig so that edges between markers face "
                        "the camera");
  if (turn < kLeastTurn)
    throw FileError(from, 0,
                    "the rig turns by " + textOf(turn * 180 / std::numbers::pi, "%.0f") +
                        " degrees only: turn it to all sides, then about its tip in a dimple");
}

} // namespace

RigFit fitRig(const std::vector<RigView>& views, const std::vector<RigMarker>& rig,
              const Camera& camera, const RigFitOptions& options, const std::string& from) {
  for (const MeasuredSize& measured : options.measured)
    if (std::none_of(rig.begin(), rig.end(),
                     [&](const RigMarker& marker) { return marker.id == measured.id; }))
      throw FileError(from, 0, "--length: the rig has no marker " + std::to_string(measured.id));
  RigFit fit;
  const std::vector<MarkerStart> starts = startOf(views, rig, camera, options.place, options.angle);
  Bundle bundle{rig, starts, camera, options, options.place, options.angle};
  ViewPoses poses;
  const auto use = [&](const std::vector<Dimple>& dimples) {
    std::vector<int> dimple_of(views.size(), -1);
    std::vector<std::size_t> waved, standing;
    bundle.dimples.clear();
    for (const Dimple& dimple : dimples) {
      for (const std::size_t v : dimple.views)
        dimple_of[v] = static_cast<int>(bundle.dimples.size());
      bundle.dimples.push_back(dimple.point);
    }
    for (std::size_t v = 0; v < views.size(); ++v)
      if (poses[v]) (dimple_of[v] < 0 ? waved : standing).push_back(v);
    bundle.used.clear();
    for (const std::size_t v : unlikeViews(poses, waved, kMostViews))
      bundle.used.push_back({&views[v], *poses[v], -1});
    for (const std::size_t v : unlikeViews(poses, standing, kMostDimpleViews))
      bundle.used.push_back({&views[v], *poses[v], dimple_of[v]});
  };

  std::vector<RigMarker> now;
  for (std::size_t i = 0; i < rig.size(); ++i) {
    now.push_back(rig[i]);
    now.back().probe_from_marker = starts[i].probe_from_marker;
  }
  poses = posesIn(views, now, camera);
  requireEnough(views, poses, from);
  use({});
  adjustBundle(bundle);

  // Poses by the adjusted rig show where the tip stood.
  poses = posesIn(views, bundle.rigNow(), camera);
  const Dimples found = dimplesIn(views, poses);
  if (!found.dimples.empty()) bundle.tip = found.tip;
  use(found.dimples);
  std::vector<double> shifts, turns;
  for (std::size_t i = 0; i < rig.size(); ++i) {
    if (!bundle.is_seen[i]) continue;
    const Vec6 motion = bundle.motionAt(bundle.poseBlock(i));
    shifts.push_back(motion.head<3>().norm() / kMedianNorm);
    turns.push_back(motion.tail<3>().norm() / kMedianNorm);
  }
  bundle.place = std::max(bundle.place, percentiles(shifts).p50);
  bundle.angle = std::max(bundle.angle, percentiles(turns).p50);
  adjustBundle(bundle);
  fit.views = bundle.used.size();
  readResult(bundle, fit);

  std::vector<Pose> before, after;
  const ViewPoses nominal = posesIn(views, rig, camera);
  for (std::size_t v = 0; v < bundle.used.size(); ++v) {
    const UsedView& used = bundle.used[v];
    after.push_back(movedPose(used.camera_from_probe,
                              bundle.motionAt(bundle.first_view + static_cast<int>(v))));
    const auto& posed = nominal[static_cast<std::size_t>(used.view - views.data())];
    before.push_back(posed.value_or(after.back()));
  }
  fit.rms_before = cornerRms(bundle.used, before, rig, camera);
  fit.rms = cornerRms(bundle.used, after, bundle.rigNow(), fit.camera);
  return fit;
}

} // namespace patina
