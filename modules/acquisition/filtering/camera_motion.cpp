#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "acquisition/filtering/camera_track.h"

namespace patina {
namespace {

template <int N> using Node = CameraTrack::Node<N>;

template <int N, int C>
MotionState<N, C> stepped(MotionState<N, C> state, double dt, double noise) {
  MotionStep<N> step = motionStep<N>(std::abs(dt), noise, ProcessNoise::continuous_white);
  if (dt < 0)
    step.F = motionStep<N>(dt, 0, ProcessNoise::continuous_white).F; // prediction backwards in time
  predict(state, step);
  return state;
}

template <int N> TipMotion motionOf(const MotionState<N, 3>& tip, const MotionState<N, 4>& turn) {
  TipMotion motion;
  motion.position = tip.x.row(0);
  motion.velocity = tip.x.row(1);
  const Eigen::Vector4d q = turn.x.row(0);
  motion.orientation = Eigen::Quaterniond(q).normalized();
  const auto rotated = [&](int derivative) -> Vec3 {
    const Eigen::Quaterniond change(Eigen::Vector4d(turn.x.row(derivative)));
    return 2 * (Eigen::Quaterniond(q).conjugate() * change).vec() / q.squaredNorm();
  };
  motion.rate = rotated(1);
  if constexpr (N == 3) {
    motion.acceleration = tip.x.row(2);
    motion.rate_of_rate = rotated(2);
  }
  motion.sigma = std::sqrt(tip.P(0, 0));
  motion.sigma_angle = 2 * std::sqrt(turn.P(0, 0));
  return motion;
}

template <int N>
TipMotion motionIn(const std::vector<Node<N>>& nodes, const CameraTrackOptions& options, double t) {
  const auto after = std::upper_bound(nodes.begin(), nodes.end(), t,
                                      [](double time, const Node<N>& n) { return time < n.t; });
  // Uses the nearest node, or the one of the same segment if a new segment starts in between.
  const bool of_next = after == nodes.begin() || (after != nodes.end() && after->is_segment_start &&
                                                  after->t - t < t - (after - 1)->t);
  const Node<N>& node = of_next ? *after : *(after - 1);
  const double since = t - node.t;
  const bool inside = after != nodes.begin() && after != nodes.end() && !after->is_segment_start;
  const Node<N>& leads = inside ? *after : node;
  const double tip_noise = leads.tip_noise, turn_noise = leads.turn_noise;
  TipMotion motion;
  if (inside && options.smooth) {
    const double until = after->t - t;
    motion = motionOf<N>(
        between<N, 3>(node.tip, after->tip, node.tip_gain, since, until, tip_noise),
        between<N, 4>(node.turn, after->turn, node.turn_gain, since, until, turn_noise));
  } else {
    motion =
        motionOf<N>(stepped(node.tip, since, tip_noise), stepped(node.turn, since, turn_noise));
  }
  motion.position_noise = tip_noise;
  motion.angle_noise = 2 * turn_noise;
  motion.gap = inside && options.smooth ? after->t - node.t > options.longest_gap && t > node.t
                                        : std::abs(since) > options.longest_gap;
  return motion;
}

} // namespace

TipMotion motionAt(const CameraTrack& track, double t) {
  if (track.empty()) throw std::invalid_argument("motionAt: the track has no pose");
  return track.fast.empty() ? motionIn(track.slow, track.options, t)
                            : motionIn(track.fast, track.options, t);
}

std::vector<PathSample> pathAt(const CameraTrack& track, const std::vector<double>& times) {
  std::vector<PathSample> path;
  path.reserve(times.size());
  for (const double t : times) {
    const TipMotion motion = motionAt(track, t);
    PathSample sample;
    sample.t = t;
    sample.position = motion.position;
    sample.orientation = motion.orientation;
    sample.sigma = motion.sigma;
    sample.sigma_angle = motion.sigma_angle;
    sample.gap = motion.gap;
    path.push_back(sample);
  }
  return path;
}

} // namespace patina
