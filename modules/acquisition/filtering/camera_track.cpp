#include "acquisition/filtering/camera_track.h"

#include <algorithm>
#include <cmath>

#include "acquisition/filtering/camera_noise.h"

namespace patina {
namespace {

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
  predict(filter.tip, motionStep<N>(dt, measured.tip_noise, ProcessNoise::white));
  predict(filter.turn, motionStep<N>(dt, measured.turn_noise, ProcessNoise::white));
  filter.t = measured.t;
  // q and -q are one orientation.
  if (filter.turn.x.row(0).dot(measured.turn) < 0) measured.turn = -measured.turn;
  return {innovationOf(filter.tip, measured.tip, measured.tip_variance),
          innovationOf(filter.turn, measured.turn, measured.turn_variance)};
}

template <int N> void use(Filter<N>& filter, const Innovations<N>& innovations) {
  update(filter.tip, innovations.tip);
  update(filter.turn, innovations.turn);
}

// Which poses a track may use, and where it begins anew.
struct Choice {
  std::vector<PoseVerdict> verdicts;
  std::vector<bool> starts;
  std::size_t restarts = 0;
};

// Forward: a pose that does not fit is tried on a second track; when that has found enough poses in
// a row that fit it, it takes over. A track of fewer poses than that was itself an outlier.
template <int N>
void gate(const std::vector<Measured>& measured, const CameraTrackOptions& options,
          Choice& choice) {
  std::optional<Filter<N>> track, other;
  std::vector<std::size_t> of_track, of_other;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (choice.verdicts[i] != PoseVerdict::used) continue;
    if (!track || measured[i].t - track->t > kUnseen) {
      other.reset();
      track.emplace(measured[i]);
      of_track = {i};
      choice.starts[i] = true;
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
        choice.starts[lone] = false;
      }
    else
      ++choice.restarts;
    for (const std::size_t taken : of_other) choice.verdicts[taken] = PoseVerdict::used;
    choice.starts[of_other.front()] = true;
    track = other;
    of_track = of_other;
    other.reset();
  }
}

// Both ways: what comes first, or first after a gap, is believed too easily from one side. A pose
// is an outlier that neither way could use; the track begins anew where both ways say so.
template <int N>
void gateBothWays(const std::vector<Measured>& measured, const CameraTrackOptions& options,
                  Choice& choice) {
  std::vector<Measured> reversed(measured.rbegin(), measured.rend());
  for (Measured& pose : reversed) pose.t = -pose.t;
  Choice back;
  back.verdicts.assign(choice.verdicts.rbegin(), choice.verdicts.rend());
  back.starts.assign(measured.size(), false);
  gate<N>(measured, options, choice);
  gate<N>(reversed, options, back);
  const std::size_t n = measured.size();
  choice.restarts = 0;
  std::optional<std::size_t> before;
  for (std::size_t i = 0; i < n; ++i) {
    if (back.verdicts[n - 1 - i] == PoseVerdict::used) choice.verdicts[i] = PoseVerdict::used;
    if (choice.verdicts[i] != PoseVerdict::used) continue;
    choice.starts[i] = choice.starts[i] && (!before || back.starts[n - 1 - *before]);
    if (choice.starts[i] && before) ++choice.restarts;
    before = i;
  }
}

template <int N> struct Pass {
  std::vector<Node<N>> nodes;
  std::vector<std::size_t> poses; // of the nodes
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
    const bool starts = !filter || choice.starts[i];
    if (starts) {
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
                          measured[i].turn_noise, starts});
    pass.poses.push_back(i);
  }
  if (!options.smooth) return pass;
  for (std::size_t k = pass.nodes.size(); k-- > 1;) {
    if (pass.nodes[k].starts) continue;
    Node<N>& node = pass.nodes[k - 1];
    const Node<N>& next = pass.nodes[k];
    const double dt = next.t - node.t;
    node.tip_gain = smootherGain<N>(node.tip.P, predictions[k].tip.P,
                                    motionStep<N>(dt, next.tip_noise, ProcessNoise::white));
    node.turn_gain = smootherGain<N>(node.turn.P, predictions[k].turn.P,
                                     motionStep<N>(dt, next.turn_noise, ProcessNoise::white));
    node.tip = smoothed<N, 3>(node.tip, predictions[k].tip, next.tip, node.tip_gain);
    node.turn = smoothed<N, 4>(node.turn, predictions[k].turn, next.turn, node.turn_gain);
  }
  return pass;
}

// With the whole track known, poses are judged again, each against what all the others say. Only
// the worst of its neighbourhood goes: it makes the others look worse than they are.
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
    if (pass.nodes[k].starts && k + 1 < scores.size()) choice.starts[pass.poses[k + 1]] = true;
    changed = true;
  }
  return changed;
}

template <int N>
void runInto(CameraTrack& track, std::vector<Node<N>>& nodes, std::vector<Measured> measured,
             Choice choice) {
  findNoise<N>(measured, choice.verdicts, track.options);
  // What is smoothed is judged again, more strictly: a hand that starts fast is no outlier.
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
  choice.starts.assign(poses.size(), false);
  if (options.acceleration)
    runInto(track, track.fast, std::move(measured), std::move(choice));
  else
    runInto(track, track.slow, std::move(measured), std::move(choice));
  return track;
}

} // namespace patina
