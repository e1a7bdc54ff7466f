#include "acquisition/filtering/camera_noise.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

// Twice the negative logarithm of the likelihood of tips or turns, each innovation counting at most
// as much as the gate, so that outliers do not choose the noise.
template <int N, int C, class Part>
double surprise(const std::vector<MeasuredPose>& measured, const std::vector<PoseVerdict>& verdicts,
                double noise, double fastest, double gate, const Part& part) {
  std::optional<MotionState<N, C>> state;
  double t = 0, sum = 0;
  int refused = 0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (verdicts[i] != PoseVerdict::used) continue;
    auto [value, variance] = part(measured[i]);
    if (!state || refused >= 5) {
      state = firstState<N, C>(value, variance, fastest);
      t = measured[i].t;
      refused = 0;
      continue;
    }
    predict(*state, motionStep<N>(measured[i].t - t, noise, ProcessNoise::white));
    t = measured[i].t;
    if (C == 4 && state->x.row(0).dot(value) < 0) value = -value;
    const Innovation<C> innovation = innovationOf(*state, value, variance);
    sum += 3 * std::log(std::max(innovation.variance, 1e-300)) + std::min(innovation.nis(), gate);
    refused = innovation.nis() > gate ? refused + 1 : 0;
    if (refused == 0) update(*state, innovation);
  }
  return sum;
}

// The least of a function of log10(noise) between two bounds: a coarse row, then golden section.
template <class Function> double likeliest(double low, double high, const Function& f) {
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
    options.position_noise = likeliest(-3, 3, [&](double exponent) {
      return surprise<N, 3>(measured, verdicts, std::pow(10, exponent), kFastestTip, options.gate,
                            [](const MeasuredPose& m) { return std::pair(m.tip, m.tip_variance); });
    });
  if (!options.angle_noise)
    options.angle_noise =
        2 * likeliest(-2, 4, [&](double exponent) {
          return surprise<N, 4>(
              measured, verdicts, std::pow(10, exponent), kFastestTurn, options.gate,
              [](const MeasuredPose& m) { return std::pair(m.turn, m.turn_variance); });
        });
}

// A hand that strokes calmly lifts off fast. For each few poses, in their order, one of some
// noises, likeliest for these and for those that follow. What one outlier gains by more of it, its
// neighbours lose; `most` is what a hand can do, and no jump.
template <int N, int C, class Part>
std::vector<double> localNoise(const std::vector<MeasuredPose>& measured,
                               const std::vector<PoseVerdict>& verdicts, double usual, double most,
                               double fastest, double gate, const Part& part) {
  constexpr std::size_t kTogether = 4;
  constexpr double kFactors[] = {1, 4, 16, 64, 256, 1024};
  constexpr double kElsewhere = 0.3; // [s], at `fastest`: how far that may be
  constexpr double kClearly = 8;     // by which more noise must be likelier, as surprise() counts
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
    if (dt > kUnseen) {
      run.state = firstState<N, C>(value, variance, fastest);
      return;
    }
    predict(run.state, motionStep<N>(dt, density, ProcessNoise::white));
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
    // Or what came before was an outlier, or the poses have jumped: somewhere else, and no unrest.
    consider(begunAt(used[begin], gate + 6 * std::log(kElsewhere * fastest)), begin + 1, usual,
             usual);
    run = best;
  }
  return noise;
}

} // namespace

template <int N>
void findNoise(std::vector<MeasuredPose>& measured, const std::vector<PoseVerdict>& verdicts,
               CameraTrackOptions& options) {
  const bool tip_known = options.position_noise.has_value(),
             turn_known = options.angle_noise.has_value();
  findUsual<N>(measured, verdicts, options);
  const double tip = *options.position_noise, turn = *options.angle_noise / 2;
  std::vector<double> tips(measured.size(), tip), turns(measured.size(), turn);
  if (!tip_known)
    tips = localNoise<N, 3>(measured, verdicts, tip, N == 3 ? 20 : 3, kFastestTip, options.gate,
                            [](const MeasuredPose& m) { return std::pair(m.tip, m.tip_variance); });
  if (!turn_known)
    turns =
        localNoise<N, 4>(measured, verdicts, turn, N == 3 ? 50 : 15, kFastestTurn, options.gate,
                         [](const MeasuredPose& m) { return std::pair(m.turn, m.turn_variance); });
  for (std::size_t i = 0; i < measured.size(); ++i) {
    measured[i].tip_noise = tips[i];
    measured[i].turn_noise = turns[i];
  }
}

template void findNoise<2>(std::vector<MeasuredPose>&, const std::vector<PoseVerdict>&,
                           CameraTrackOptions&);
template void findNoise<3>(std::vector<MeasuredPose>&, const std::vector<PoseVerdict>&,
                           CameraTrackOptions&);

} // namespace patina
