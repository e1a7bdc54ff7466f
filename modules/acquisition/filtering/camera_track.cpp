#include "acquisition/filtering/camera_track.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

// Start of a filter.
inline constexpr double kFastestTip = 1;  // initial standard deviation [m/s]
inline constexpr double kFastestTurn = 5; // the same of a quaternion's component [1/s]

// A camera pose as a measurement of the tip and of the orientation (quaternion x y z w).
struct MeasuredPose {
  double t; // [s]
  Eigen::Matrix<double, 1, 3> tip;
  Eigen::Matrix<double, 1, 4> turn;
  double tip_variance, turn_variance; // variance of each component
  // Process noise since the previous pose, as in CameraTrackOptions; turn: per component.
  double tip_noise = 0, turn_noise = 0;
};

// Returns -2 log likelihood of a pose that the motion does not predict: an outlier, or a restart.
// It is within a jump at speed `fastest`.
double devianceElsewhere(double fastest, double gate) {
  constexpr double kElsewhere = 0.3; // duration of the jump [s]
  return gate + 6 * std::log(kElsewhere * fastest);
}

// Returns -2 log likelihood of the innovations of tips or orientations. Outliers cost the same
// whatever the noise is, so that they do not determine it.
template <int N, int C, class Part>
double deviance(const std::vector<MeasuredPose>& measured, const std::vector<PoseVerdict>& verdicts,
                double noise, double fastest, double gate, const Part& part) {
  std::optional<MotionState<N, C>> state;
  double t = 0, sum = 0;
  int refused = 0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (verdicts[i] != PoseVerdict::used) continue;
    auto [value, variance] = part(measured[i]);
    if (!state || refused >= 5) {
      if (state) sum += devianceElsewhere(fastest, gate);
      state = firstState<N, C>(value, variance, fastest);
      t = measured[i].t;
      refused = 0;
      continue;
    }
    predict(*state, motionStep<N>(measured[i].t - t, noise, ProcessNoise::continuous_white));
    t = measured[i].t;
    if (C == 4 && state->x.row(0).dot(value) < 0) value = -value;
    const Innovation<C> innovation = innovationOf(*state, value, variance);
    const bool is_refused = innovation.nis() > gate;
    sum += is_refused ? devianceElsewhere(fastest, gate)
                      : 3 * std::log(std::max(innovation.variance, 1e-300)) + innovation.nis();
    refused = is_refused ? refused + 1 : 0;
    if (refused == 0) update(*state, innovation);
  }
  return sum;
}

// Minimises a function of log10(noise) between two bounds: a coarse grid, then golden section.
template <class Function> double maximumLikelihood(double low, double high, const Function& f) {
  constexpr int kRow = 9;
  double best = low, least = f(low);
  const double step = (high - low) / (kRow - 1);
  for (int i = 1; i < kRow; ++i)
    if (const double value = f(low + step * i); value < least) {
      least = value;
      best = low + step * i;
    }
  constexpr double kGolden = 0.6180339887498949;
  double a = best - step, b = best + step;
  double c = b - kGolden * (b - a), d = a + kGolden * (b - a), fc = f(c), fd = f(d);
  while (b - a > 0.02) {
    if (fc < fd) {
      b = d, d = c, fd = fc;
      c = b - kGolden * (b - a), fc = f(c);
    } else {
      a = c, c = d, fc = fd;
      d = a + kGolden * (b - a), fd = f(d);
    }
  }
  return std::pow(10, 0.5 * (a + b));
}

template <int N>
void findUsual(const std::vector<MeasuredPose>& measured, const std::vector<PoseVerdict>& verdicts,
               CameraTrackOptions& options) {
  if (!options.position_noise)
    options.position_noise = maximumLikelihood(-3, 3, [&](double exponent) {
      return deviance<N, 3>(measured, verdicts, std::pow(10, exponent), kFastestTip, options.gate,
                            [](const MeasuredPose& m) { return std::pair(m.tip, m.tip_variance); });
    });
  if (!options.angle_noise)
    options.angle_noise =
        2 * maximumLikelihood(-2, 4, [&](double exponent) {
          return deviance<N, 4>(
              measured, verdicts, std::pow(10, exponent), kFastestTurn, options.gate,
              [](const MeasuredPose& m) { return std::pair(m.turn, m.turn_variance); });
        });
}

// Chooses the process noise of each block of four poses by maximum likelihood over this block and
// the next one. An isolated outlier does not raise the noise, because the likelihood of its
// neighbours would fall. `most` is the largest noise of a hand's motion.
template <int N, int C, class Part>
std::vector<double> localNoise(const std::vector<MeasuredPose>& measured,
                               const std::vector<PoseVerdict>& verdicts, double usual, double most,
                               double fastest, double gate, const Part& part) {
  constexpr std::size_t kTogether = 4;
  constexpr double kFactors[] = {1, 4, 16, 64, 256, 1024};
  constexpr double kClearly = 8; // smallest gain in deviance for a larger noise
  std::vector<double> noise(measured.size(), usual);
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < measured.size(); ++i)
    if (verdicts[i] == PoseVerdict::used) used.push_back(i);
  if (used.empty()) return noise;
  struct Run {
    MotionState<N, C> state;
    double t, sum;
  };
  const auto step = [&](Run& run, std::size_t i, double density) {
    auto [value, variance] = part(measured[i]);
    const double dt = measured[i].t - run.t;
    run.t = measured[i].t;
    if (dt > kMaxGap) {
      run.state = firstState<N, C>(value, variance, fastest);
      return;
    }
    predict(run.state, motionStep<N>(dt, density, ProcessNoise::continuous_white));
    if (C == 4 && run.state.x.row(0).dot(value) < 0) value = -value;
    const Innovation<C> innovation = innovationOf(run.state, value, variance);
    run.sum +=
        3 * std::log(std::max(innovation.variance, 1e-300)) + std::min(innovation.nis(), gate);
    if (innovation.nis() <= gate) update(run.state, innovation);
  };
  const auto begunAt = [&](std::size_t i, double sum) {
    const auto [value, variance] = part(measured[i]);
    return Run{firstState<N, C>(value, variance, fastest), measured[i].t, sum};
  };
  Run run = begunAt(used[0], 0);
  for (std::size_t begin = 1; begin < used.size(); begin += kTogether) {
    const std::size_t end = std::min(begin + kTogether, used.size()),
                      ahead = std::min(end + kTogether, used.size());
    Run best{};
    double least = INFINITY;
    const auto consider = [&](Run trial, std::size_t from, double density, double kept) {
      for (std::size_t k = from; k < end; ++k) step(trial, used[k], density);
      const Run taken = trial;
      for (std::size_t k = end; k < ahead; ++k) step(trial, used[k], density);
      if (!(trial.sum < least)) return;
      least = trial.sum;
      best = taken;
      for (std::size_t k = begin; k < end; ++k) noise[used[k]] = kept;
    };
    for (const double factor : kFactors) {
      if (factor > 1 && factor * usual > most) break;
      Run trial = run;
      trial.sum = factor > 1 ? kClearly : 0;
      consider(trial, begin, factor * usual, factor * usual);
    }
    // Alternatively the earlier poses were outliers or the poses have jumped: restarts here.
    consider(begunAt(used[begin], devianceElsewhere(fastest, gate)), begin + 1, usual, usual);
    run = best;
  }
  return noise;
}

// Sets the process noise of each used pose, and that of the options if it is absent, by maximum
// likelihood over all poses (A06). Blocks of a few poses get more where that is clearly more
// likely. N = 2: constant velocity; 3: constant acceleration.
template <int N>
void estimateProcessNoise(std::vector<MeasuredPose>& measured,
                          const std::vector<PoseVerdict>& verdicts, CameraTrackOptions& options) {
  const bool tip_known = options.position_noise.has_value(),
             turn_known = options.angle_noise.has_value();
  findUsual<N>(measured, verdicts, options);
  const double tip = *options.position_noise, turn = *options.angle_noise / 2;
  std::vector<double> tips(measured.size(), tip), turns(measured.size(), turn);
  if (!tip_known)
    tips = localNoise<N, 3>(measured, verdicts, tip, N == 3 ? 100 : 3, kFastestTip, options.gate,
                            [](const MeasuredPose& m) { return std::pair(m.tip, m.tip_variance); });
  if (!turn_known)
    turns =
        localNoise<N, 4>(measured, verdicts, turn, N == 3 ? 250 : 15, kFastestTurn, options.gate,
                         [](const MeasuredPose& m) { return std::pair(m.turn, m.turn_variance); });
  for (std::size_t i = 0; i < measured.size(); ++i) {
    measured[i].tip_noise = tips[i];
    measured[i].turn_noise = turns[i];
  }
}

template void estimateProcessNoise<2>(std::vector<MeasuredPose>&, const std::vector<PoseVerdict>&,
                                      CameraTrackOptions&);
template void estimateProcessNoise<3>(std::vector<MeasuredPose>&, const std::vector<PoseVerdict>&,
                                      CameraTrackOptions&);

template <int N> using Node = CameraTrack::Node<N>;
using Measured = MeasuredPose;

Measured measuredFrom(const CameraPose& pose, const Vec3& tip) {
  const Eigen::Quaterniond q = pose.orientation.normalized();
  const double angle = pose.sigma_angle * pose.sigma_angle;
  return {pose.t, (pose.position + q * tip).transpose(), q.coeffs().transpose(),
          pose.sigma_position * pose.sigma_position + 2. / 3 * tip.squaredNorm() * angle,
          angle / 4};
}

PoseVerdict screened(const CameraPose& pose, double last) {
  const bool finite = std::isfinite(pose.t) && pose.position.allFinite() &&
                      pose.orientation.coeffs().allFinite() && pose.orientation.norm() > 1e-3 &&
                      std::isfinite(pose.sigma_position) && std::isfinite(pose.sigma_angle) &&
                      pose.sigma_position >= 0 && pose.sigma_angle >= 0;
  if (!finite) return PoseVerdict::not_finite;
  if (pose.t == last) return PoseVerdict::repeated;
  return pose.t < last ? PoseVerdict::backwards : PoseVerdict::used;
}

template <int N> struct Filter {
  double t = 0;
  MotionState<N, 3> tip;
  MotionState<N, 4> turn;

  explicit Filter(const Measured& first)
      : t(first.t), tip(firstState<N, 3>(first.tip, first.tip_variance, kFastestTip)),
        turn(firstState<N, 4>(first.turn, first.turn_variance, kFastestTurn)) {}
};

template <int N> struct Innovations {
  Innovation<3> tip;
  Innovation<4> turn;
  bool within(double gate) const { return tip.nis() <= gate && turn.nis() <= gate; }
};

template <int N> Innovations<N> predictTo(Filter<N>& filter, Measured measured) {
  const double dt = measured.t - filter.t;
  predict(filter.tip, motionStep<N>(dt, measured.tip_noise, ProcessNoise::continuous_white));
  predict(filter.turn, motionStep<N>(dt, measured.turn_noise, ProcessNoise::continuous_white));
  filter.t = measured.t;
  // q and -q are the same orientation.
  if (filter.turn.x.row(0).dot(measured.turn) < 0) measured.turn = -measured.turn;
  return {innovationOf(filter.tip, measured.tip, measured.tip_variance),
          innovationOf(filter.turn, measured.turn, measured.turn_variance)};
}

template <int N> void use(Filter<N>& filter, const Innovations<N>& innovations) {
  update(filter.tip, innovations.tip);
  update(filter.turn, innovations.turn);
}

// Poses that a track may use, and the starts of its segments.
struct Choice {
  std::vector<PoseVerdict> verdicts;
  std::vector<bool> is_segment_start;
  std::size_t restarts = 0;
};

// Filters forward. A pose outside the gate is tried on a second track, which takes over after
// enough consistent poses in a row. A shorter track was itself an outlier.
template <int N>
void gate(const std::vector<Measured>& measured, const CameraTrackOptions& options,
          Choice& choice) {
  std::optional<Filter<N>> track, other;
  std::vector<std::size_t> of_track, of_other;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (choice.verdicts[i] != PoseVerdict::used) continue;
    if (!track || measured[i].t - track->t > kMaxGap) {
      other.reset();
      track.emplace(measured[i]);
      of_track = {i};
      choice.is_segment_start[i] = true;
      continue;
    }
    Filter<N> next = *track;
    const Innovations<N> innovations = predictTo(next, measured[i]);
    if (innovations.within(options.gate)) {
      use(next, innovations);
      track = next;
      of_track.push_back(i);
      other.reset();
      continue;
    }
    choice.verdicts[i] = PoseVerdict::outlier;
    if (other) {
      Filter<N> trial = *other;
      const Innovations<N> fits = predictTo(trial, measured[i]);
      if (fits.within(options.gate)) {
        use(trial, fits);
        other = trial;
        of_other.push_back(i);
      } else {
        other.reset();
      }
    }
    if (!other) {
      other.emplace(measured[i]);
      of_other = {i};
    }
    if (of_other.size() < static_cast<std::size_t>(options.restart_after)) continue;
    if (of_track.size() < of_other.size())
      for (const std::size_t lone : of_track) {
        choice.verdicts[lone] = PoseVerdict::outlier;
        choice.is_segment_start[lone] = false;
      }
    else
      ++choice.restarts;
    for (const std::size_t taken : of_other) choice.verdicts[taken] = PoseVerdict::used;
    choice.is_segment_start[of_other.front()] = true;
    track = other;
    of_track = of_other;
    other.reset();
  }
}

// Filters in both directions, because the first pose, or the first after a gap, cannot be tested
// from one side. A pose is an outlier if neither direction used it; a segment starts where both
// directions restarted.
template <int N>
void gateBothWays(const std::vector<Measured>& measured, const CameraTrackOptions& options,
                  Choice& choice) {
  std::vector<Measured> reversed(measured.rbegin(), measured.rend());
  for (Measured& pose : reversed) pose.t = -pose.t;
  Choice back;
  back.verdicts.assign(choice.verdicts.rbegin(), choice.verdicts.rend());
  back.is_segment_start.assign(measured.size(), false);
  gate<N>(measured, options, choice);
  gate<N>(reversed, options, back);
  const std::size_t n = measured.size();
  choice.restarts = 0;
  std::optional<std::size_t> before;
  for (std::size_t i = 0; i < n; ++i) {
    if (back.verdicts[n - 1 - i] == PoseVerdict::used) choice.verdicts[i] = PoseVerdict::used;
    if (choice.verdicts[i] != PoseVerdict::used) continue;
    choice.is_segment_start[i] =
        choice.is_segment_start[i] && (!before || back.is_segment_start[n - 1 - *before]);
    if (choice.is_segment_start[i] && before) ++choice.restarts;
    before = i;
  }
}

template <int N> struct Pass {
  std::vector<Node<N>> nodes;
  std::vector<std::size_t> poses; // indices of the nodes' poses
  double nis = 0, squares = 0, count = 0;
};

template <int N>
Pass<N> filtered(const std::vector<Measured>& measured, const Choice& choice,
                 const CameraTrackOptions& options) {
  Pass<N> pass;
  std::optional<Filter<N>> filter;
  std::vector<Filter<N>> predictions;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (choice.verdicts[i] != PoseVerdict::used) continue;
    const bool is_segment_start = !filter || choice.is_segment_start[i];
    if (is_segment_start) {
      filter.emplace(measured[i]);
      predictions.push_back(*filter);
    } else {
      const Innovations<N> innovations = predictTo(*filter, measured[i]);
      predictions.push_back(*filter);
      use(*filter, innovations);
      pass.nis += (innovations.tip.nis() + innovations.turn.nis()) / 6;
      pass.squares += innovations.tip.residual.squaredNorm() / 3;
      pass.count += 1;
    }
    pass.nodes.push_back({filter->t, filter->tip, filter->turn, measured[i].tip_noise,
                          measured[i].turn_noise, is_segment_start});
    pass.poses.push_back(i);
  }
  if (!options.smooth) return pass;
  for (std::size_t k = pass.nodes.size(); k-- > 1;) {
    if (pass.nodes[k].is_segment_start) continue;
    Node<N>& node = pass.nodes[k - 1];
    const Node<N>& next = pass.nodes[k];
    const double dt = next.t - node.t;
    node.tip_gain =
        smootherGain<N>(node.tip.P, predictions[k].tip.P,
                        motionStep<N>(dt, next.tip_noise, ProcessNoise::continuous_white));
    node.turn_gain =
        smootherGain<N>(node.turn.P, predictions[k].turn.P,
                        motionStep<N>(dt, next.turn_noise, ProcessNoise::continuous_white));
    node.tip = smoothed<N, 3>(node.tip, predictions[k].tip, next.tip, node.tip_gain);
    node.turn = smoothed<N, 4>(node.turn, predictions[k].turn, next.turn, node.turn_gain);
  }
  return pass;
}

// Tests each pose again against the smoothed track of all others. Only the worst of each
// neighbourhood is removed, because it raises the innovations of its neighbours.
template <int N>
bool judgeAgain(const std::vector<Measured>& measured, const Pass<N>& pass, double gate,
                Choice& choice) {
  constexpr std::size_t kNeighbours = 5;
  const auto score = [](double squares, double variance, double known) {
    return squares / std::max(variance - known, 0.05 * variance);
  };
  std::vector<double> scores;
  for (std::size_t k = 0; k < pass.nodes.size(); ++k) {
    const Node<N>& node = pass.nodes[k];
    Measured pose = measured[pass.poses[k]];
    if (node.turn.x.row(0).dot(pose.turn) < 0) pose.turn = -pose.turn;
    scores.push_back(std::max(
        score((pose.tip - node.tip.x.row(0)).squaredNorm(), pose.tip_variance, node.tip.P(0, 0)),
        score((pose.turn - node.turn.x.row(0)).squaredNorm(), pose.turn_variance,
              node.turn.P(0, 0))));
  }
  bool changed = false;
  for (std::size_t k = 0; k < scores.size(); ++k) {
    const auto from = scores.begin() + static_cast<std::ptrdiff_t>(k - std::min(k, kNeighbours));
    const auto to =
        scores.begin() + static_cast<std::ptrdiff_t>(std::min(k + kNeighbours + 1, scores.size()));
    if (!(scores[k] > gate) || scores[k] < *std::max_element(from, to)) continue;
    choice.verdicts[pass.poses[k]] = PoseVerdict::outlier;
    if (pass.nodes[k].is_segment_start && k + 1 < scores.size())
      choice.is_segment_start[pass.poses[k + 1]] = true;
    changed = true;
  }
  return changed;
}

template <int N>
void runInto(CameraTrack& track, std::vector<Node<N>>& nodes, std::vector<Measured> measured,
             Choice choice) {
  estimateProcessNoise<N>(measured, choice.verdicts, track.options);
  // Smoothed tracks are tested again more strictly; a fast start of the hand is not an outlier.
  CameraTrackOptions lenient = track.options;
  lenient.gate *= 3;
  if (track.options.smooth)
    gateBothWays<N>(measured, lenient, choice);
  else
    gate<N>(measured, track.options, choice);
  Pass<N> pass = filtered<N>(measured, choice, track.options);
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds && track.options.smooth; ++round) {
    if (!judgeAgain(measured, pass, track.options.gate, choice)) break;
    pass = filtered<N>(measured, choice, track.options);
  }
  nodes = std::move(pass.nodes);
  track.verdicts = std::move(choice.verdicts);
  track.restarts = choice.restarts;
  track.nis_mean = pass.count > 0 ? pass.nis / pass.count : 0;
  track.rms_innovation = pass.count > 0 ? std::sqrt(pass.squares / pass.count) : 0;
}

} // namespace

std::size_t CameraTrack::used() const {
  return static_cast<std::size_t>(std::count(verdicts.begin(), verdicts.end(), PoseVerdict::used));
}

CameraTrack trackTip(const std::vector<CameraPose>& poses, const Vec3& tip,
                     const CameraTrackOptions& options) {
  CameraTrack track;
  track.options = options;
  std::vector<Measured> measured;
  Choice choice;
  double last = -std::numeric_limits<double>::infinity();
  for (const CameraPose& pose : poses) {
    choice.verdicts.push_back(screened(pose, last));
    const bool used = choice.verdicts.back() == PoseVerdict::used;
    measured.push_back(used ? measuredFrom(pose, tip) : Measured{});
    if (used) last = pose.t;
  }
  choice.is_segment_start.assign(poses.size(), false);
  if (options.acceleration)
    runInto(track, track.fast, std::move(measured), std::move(choice));
  else
    runInto(track, track.slow, std::move(measured), std::move(choice));
  return track;
}

} // namespace patina
