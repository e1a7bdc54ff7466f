#include "acquisition/tracking/rig_misfit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>

#include "acquisition/tracking/marker_residual.h"
#include "core/numbers.h"

namespace patina {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

// Standard deviations of a rig that was made by hand: places, turns, the size of all markers, and
// that of each beside the others.
constexpr double kGluePlace = 0.3e-3, kGlueAngle = 8.7e-3; // each axis [m], [rad]
constexpr double kPrintScale = 0.01, kOwnScale = 2e-3;     // relative
// Smallest deviations of a calibrated rig, which bends and is warm or cold.
constexpr double kRestPlace = 0.02e-3, kRestAngle = 1e-3, kRestScale = 2e-4; // [m], [rad], relative

constexpr double kFarCorner = 10;          // error beyond which a marker is elsewhere [px]
constexpr std::size_t kFewestFrames = 20;  // frames with two markers, before a rig is judged
constexpr double kCertain = 6;             // excess of chi-square [deviations]
constexpr double kDoubtedPixels = 0.06;    // smallest doubted error of a corner [px]
constexpr double kDoubtedLength = 0.04e-3; // the same on the rig [m]
// Smallest error of a corner that stays the same through a scan, as by blur [px].
constexpr double kLastingPixels = 0.02;
constexpr double kOwnShare = 0.1;   // part of the squared misfit that a wrong rig must explain
constexpr double kExplains = 0.85;  // part of the misfit that a single cause must explain
constexpr double kUsuallyFar = 0.6; // part of a marker's frames in which it is not in its place
// Deviations of a pose by a marker that is elsewhere [m], [rad].
constexpr double kElsewherePlace = 0.05, kElsewhereAngle = 1;

// Returns the mean distance of a marker's corners from where a pose has them [px].
double cornersApart(const SeenMarker& image, const RigMarker& marker, const Pose& pose,
                    const Camera& camera) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 p = pose * marker.corners()[i];
    if (!(p.z() > 1e-6)) return INFINITY;
    const Vec2 pixel(camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy);
    sum += (pixel - image.corner[i].undistorted).norm() / 4;
  }
  return sum;
}

// Values of a marker: its motion, the logarithm of its size, and errors of its corners' distances
// from their edges that stay the same through the scan, each over its deviation. An edge's own
// deviation is mostly systematic, so that frames do not average it out.
constexpr int kValues = 15;
using Slopes = Eigen::Matrix<double, 8, kValues>;

Slopes slopesOf(const MarkerResidual& residual, const SeenMarker& image) {
  Slopes by = Slopes::Zero();
  by.leftCols<6>() = residual.by_marker;
  by.col(6) = residual.by_size;
  for (int i = 0; i < 8; ++i) {
    const auto row = image.corner[static_cast<std::size_t>(i / 2)].whiten.row(i % 2);
    by(i, 7 + i) = std::max(1., kLastingPixels * row.norm());
  }
  return by;
}

// Returns the places of some markers' motions, then of their sizes, among all values.
std::vector<Eigen::Index> valuesOf(const std::vector<std::size_t>& markers) {
  std::vector<Eigen::Index> places;
  for (const std::size_t i : markers)
    for (Eigen::Index k = 0; k < 6; ++k)
      places.push_back(kValues * static_cast<Eigen::Index>(i) + k);
  for (const std::size_t i : markers) places.push_back(kValues * static_cast<Eigen::Index>(i) + 6);
  return places;
}
std::vector<Eigen::Index> rigValues(std::size_t markers) {
  std::vector<std::size_t> all(markers);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return valuesOf(all);
}
// Returns the same markers' places among the rig's values alone, of which there are 7 a marker.
std::vector<Eigen::Index> among(const std::vector<std::size_t>& some, std::size_t markers) {
  std::vector<Eigen::Index> places;
  for (const std::size_t i : some)
    for (Eigen::Index k = 0; k < 6; ++k) places.push_back(6 * static_cast<Eigen::Index>(i) + k);
  for (const std::size_t i : some) places.push_back(static_cast<Eigen::Index>(6 * markers + i));
  return places;
}
std::vector<Eigen::Index> cornerValues(std::size_t markers) {
  std::vector<Eigen::Index> places;
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(markers); ++i)
    for (Eigen::Index k = 7; k < kValues; ++k) places.push_back(kValues * i + k);
  return places;
}

// Returns the covariance of all markers' motions, then of the logarithms of their sizes: of a rig
// made by hand, or as its calibration states it.
MatX priorOf(const std::vector<RigMarker>& rig) {
  const auto n = static_cast<Eigen::Index>(rig.size());
  MatX prior = MatX::Zero(7 * n, 7 * n);
  bool calibrated = true;
  for (Eigen::Index i = 0; i < n; ++i) {
    const RigMarker& marker = rig[static_cast<std::size_t>(i)];
    const bool known = marker.place_deviation > 0 && marker.angle_deviation > 0;
    const double place = known ? std::hypot(kRestPlace, marker.place_deviation) : kGluePlace;
    const double angle = known ? std::hypot(kRestAngle, marker.angle_deviation) : kGlueAngle;
    const double scale =
        known ? std::hypot(kRestScale, marker.size_deviation / marker.size) : kOwnScale;
    prior.diagonal().segment<3>(6 * i).setConstant(place * place);
    prior.diagonal().segment<3>(6 * i + 3).setConstant(angle * angle);
    prior(6 * n + i, 6 * n + i) = scale * scale;
    calibrated = calibrated && known;
  }
  if (!calibrated) prior.bottomRightCorner(n, n).array() += kPrintScale * kPrintScale;
  return prior;
}

std::string percentText(double part) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2g %%", 100 * std::abs(part));
  return text;
}

} // namespace

RigMisfit::RigMisfit(const std::vector<RigMarker>& rig, const Camera& camera)
    : rig_(rig), camera_(camera) {
  const auto size = static_cast<Eigen::Index>(kValues * rig.size());
  normal_ = MatX::Zero(size, size);
  gradient_ = VecX::Zero(size);
  sightings_.resize(rig.size());
  for (Sightings& each : sightings_) each.in_place.resize(rig.size());
}

void RigMisfit::countElsewhere(std::size_t i, const SeenMarker& image, const Pose& pose) {
  ++sightings_[i].far;
  for (int quarters = 0; quarters < 4; ++quarters)
    for (std::size_t k = 0; k < rig_.size(); ++k) {
      if (i == k && quarters == 0) continue;
      RigMarker there = rig_[k];
      there.probe_from_marker.rotate(
          Eigen::AngleAxisd(quarters * std::numbers::pi / 2, Vec3::UnitZ()));
      if (cornersApart(image, there, pose, camera_) > kFarCorner) continue;
      if (i == k) ++sightings_[i].turned;
      if (i != k) ++sightings_[i].in_place[k];
      return;
    }
}

void RigMisfit::add(const std::vector<SeenMarker>& markers, const SeenRig& seen,
                    std::optional<std::size_t> pose) {
  const bool posed = seen.verdict == RigVerdict::seen || seen.verdict == RigVerdict::misfit;
  const Pose& camera_from_probe = seen.camera_from_probe;
  if (!posed || !(camera_from_probe.translation().z() > 0)) return;
  struct Part {
    std::size_t marker;
    const SeenMarker* image;
    MarkerResidual residual;
  };
  std::vector<Part> near;
  std::vector<std::size_t> all;
  std::vector<const SeenMarker*> images;
  for (std::size_t i = 0; i < rig_.size(); ++i) {
    const SeenMarker* image = nullptr;
    int count = 0;
    for (const SeenMarker& each : markers)
      if (each.id == rig_[i].id && each.family == rig_[i].family) image = &each, ++count;
    if (count != 1) continue;
    all.push_back(i);
    images.push_back(image);
  }
  if (all.empty()) return;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const bool far =
        cornersApart(*images[k], rig_[all[k]], camera_from_probe, camera_) > kFarCorner;
    if (all.size() > 1) ++sightings_[all[k]].seen; // one marker alone has any place
    if (far)
      countElsewhere(all[k], *images[k], camera_from_probe);
    else if (const auto residual =
                 markerResidual(*images[k], rig_[all[k]], camera_from_probe, camera_))
      near.push_back({all[k], images[k], *residual});
  }
  if (near.empty()) return;
  // The parts of the normal equations of the pose, and across to the other values: by all markers,
  // and by those that gave the pose.
  Mat6 frame = Mat6::Zero(), used_frame = frame;
  MatX across = MatX::Zero(6, normal_.cols()), used_across = across;
  Vec6 frame_gradient = Vec6::Zero();
  for (const Part& part : near) {
    const MarkerResidual& r = part.residual;
    const Slopes by = slopesOf(r, *part.image);
    const Eigen::Matrix<double, 6, kValues> cross = r.by_frame.transpose() * by;
    const Mat6 own = r.by_frame.transpose() * r.by_frame;
    const auto at = static_cast<Eigen::Index>(kValues * part.marker);
    normal_.block<kValues, kValues>(at, at) += by.transpose() * by;
    gradient_.segment<kValues>(at) += by.transpose() * r.error;
    across.middleCols<kValues>(at) += cross;
    frame += own;
    frame_gradient += r.by_frame.transpose() * r.error;
    squares_ += r.error.squaredNorm();
    residuals_ += 8;
    if (std::find(seen.used.begin(), seen.used.end(), part.marker) == seen.used.end()) continue;
    used_frame += own;
    used_across.middleCols<kValues>(at) += cross;
  }
  const SymmetricSolver solver(frame);
  const MatX by_rig = solver.solveColumns(across); // less the pose's change by the rig's
  const Vec6 step = solver.solve(frame_gradient);
  normal_.noalias() -= across.transpose() * by_rig;
  gradient_.noalias() -= across.transpose() * step;
  squares_ -= frame_gradient.dot(step);
  residuals_ -= 6;
  if (near.size() > 1) ++frames_;
  if (near.size() > 1) pixel_ += camera_from_probe.translation().z() / camera_.fx;
  if (!pose) return;
  const SymmetricSolver used_solver(used_frame);
  if (used_solver.reciprocalCondition() > 0)
    parts_.push_back(
        {*pose, seen.used,
         used_solver.solveColumns(used_across(Eigen::all, valuesOf(seen.used))).cast<float>()});
}

RigMisfit::Diagnosis RigMisfit::judge(std::vector<CameraPose>& poses) const {
  Diagnosis diagnosis;
  diagnosis.shift.resize(rig_.size());
  const std::string remedy = "; calibrate the rig (patina calibrate)";
  std::string elsewhere;
  std::vector<bool> is_elsewhere(rig_.size());
  for (std::size_t i = 0; i < rig_.size(); ++i) {
    const Sightings& marker = sightings_[i];
    if (marker.far < kFewestFrames / 2 ||
        static_cast<double>(marker.far) < kUsuallyFar * static_cast<double>(marker.seen))
      continue;
    is_elsewhere[i] = true;
    const auto most = std::max_element(marker.in_place.begin(), marker.in_place.end());
    elsewhere += (elsewhere.empty() ? "marker " : ", marker ") + std::to_string(rig_[i].id);
    if (most != marker.in_place.end() && 2 * *most > marker.far)
      elsewhere +=
          " is where marker " +
          std::to_string(rig_[static_cast<std::size_t>(most - marker.in_place.begin())].id) +
          " should be";
    else if (2 * marker.turned > marker.far)
      elsewhere += " is turned";
    else
      elsewhere += " is not where the rig has it";
  }
  if (frames_ < kFewestFrames) {
    if (!elsewhere.empty()) diagnosis.text = elsewhere + remedy;
    return diagnosis;
  }

  const auto n = static_cast<Eigen::Index>(rig_.size()), size = 7 * n;
  const MatX prior = priorOf(rig_);
  const MatX information = SymmetricSolver(prior).inverse();
  double unit = 1, growth = 1; // variances over the edges' and over the prior's
  VecX step;
  MatX normal; // normal equations of the rig, lasting errors eliminated
  VecX gradient;
  double whole = 0, left = 0;
  const auto rig_values = rigValues(rig_.size()), corner_values = cornerValues(rig_.size());
  for (int round = 0; round < 4; ++round) {
    MatX corners = normal_(corner_values, corner_values);
    corners.diagonal().array() += unit;
    const MatX across = normal_(corner_values, rig_values);
    const VecX pull = gradient_(corner_values);
    const SymmetricSolver solver(corners);
    normal = normal_(rig_values, rig_values);
    normal.noalias() -= across.transpose() * solver.solveColumns(across);
    gradient = gradient_(rig_values);
    gradient.noalias() -= across.transpose() * solver.solve(pull);
    whole = squares_ - pull.dot(solver.solve(pull));
    step = SymmetricSolver(normal / unit + information / growth).solve(-gradient / unit);
    left = whole + 2 * gradient.dot(step) + step.dot(normal * step);
    unit = std::max(1., left / static_cast<double>(residuals_));
    growth = std::max(1., step.dot(information * step) / static_cast<double>(size - 6));
  }
  const double explained = whole - left;
  const double expected = static_cast<double>(size);
  // Blur and light make errors of corners that a rig's values imitate a little.
  const bool certain = explained / unit > expected + kCertain * std::sqrt(2 * expected) &&
                       explained > kOwnShare * whole;

  double worst = 0, squares = 0, seen = 0;
  std::size_t worst_marker = 0;
  for (std::size_t i = 0; i < rig_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(6 * i);
    if (!(normal(at, at) > 0)) continue;
    diagnosis.shift[i] = step.segment<3>(at).norm();
    // The corners move by the shift, by the turn and by the size.
    const double corner = std::hypot(
        diagnosis.shift[i], rig_[i].size * std::numbers::sqrt2 / 2 *
                                std::hypot(step.segment<3>(at + 3).norm() * std::sqrt(2. / 3),
                                           step[6 * n + static_cast<Eigen::Index>(i)]));
    squares += corner * corner;
    seen += 1;
    if (corner > worst) worst = corner, worst_marker = i;
  }
  diagnosis.scale = step.tail(n).mean();
  const double pixel = pixel_ / static_cast<double>(frames_);
  if (!elsewhere.empty()) {
    diagnosis.text = elsewhere + remedy;
  } else if (certain && worst > std::max(kDoubtedLength, kDoubtedPixels * pixel)) {
    // The simplest cause that explains the misfit.
    VecX all_sizes = VecX::Zero(size);
    all_sizes.tail(n).setOnes();
    const double slope = gradient.dot(all_sizes), bend = all_sizes.dot(normal * all_sizes);
    double best = 0, best_shift = 0;
    std::size_t cause = 0;
    for (std::size_t i = 0; i < rig_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(6 * i);
      if (!(normal(at, at) > 0)) continue;
      const Vec6 down = gradient.segment<6>(at);
      const Vec6 motion = -SymmetricSolver(normal.block<6, 6>(at, at)).solve(down);
      if (const double gain = -down.dot(motion); gain > best)
        best = gain, cause = i, best_shift = motion.head<3>().norm();
    }
    if (bend > 0 && slope * slope / bend > kExplains * explained) {
      diagnosis.scale = -slope / bend;
      diagnosis.text = "all markers are " + percentText(diagnosis.scale) +
                       (diagnosis.scale > 0 ? " larger" : " smaller") +
                       " beside their places than the rig has them, as by the scale of a printer; "
                       "measure one" +
                       remedy;
    } else if (best > kExplains * explained) {
      diagnosis.text = "marker " + std::to_string(rig_[cause].id) + " lies " +
                       formatLength(best_shift) + " off" + remedy;
    } else {
      diagnosis.text = "markers are off by " + formatLength(std::sqrt(squares / seen)) +
                       ", most of all marker " + std::to_string(rig_[worst_marker].id) + " by " +
                       formatLength(worst) + remedy;
    }
  }
  if (diagnosis.text.empty()) return diagnosis;
  const MatX spread =
      step * step.transpose() + SymmetricSolver(normal / unit + information / growth).inverse();
  for (CameraPose& pose : poses) pose.rig_doubted = true;
  for (const FramePart& part : parts_) {
    CameraPose& pose = poses[part.pose];
    const MatX by_rig = part.by_rig.cast<double>();
    const auto own = among(part.used, rig_.size());
    const VecX variances = (by_rig * spread(own, own)).cwiseProduct(by_rig).rowwise().sum();
    pose.sigma_position =
        std::sqrt(pose.sigma_position * pose.sigma_position + variances.head<3>().sum() / 3);
    pose.sigma_angle =
        std::sqrt(pose.sigma_angle * pose.sigma_angle + variances.tail<3>().sum() / 3);
    // Two markers agree only if both are in their places.
    if (!elsewhere.empty() &&
        (part.used.size() < 2 || std::any_of(part.used.begin(), part.used.end(),
                                             [&](std::size_t i) { return is_elsewhere[i]; }))) {
      pose.sigma_position += kElsewherePlace;
      pose.sigma_angle += kElsewhereAngle;
    }
  }
  return diagnosis;
}

} // namespace patina
