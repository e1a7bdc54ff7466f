#include "acquisition/profile/height_profile.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

constexpr double kDrive = 6.4; // noise density for an rms of 1

// exp(F u) e^u, where F is the companion matrix of (1 + d/du)^4; the series is finite.
RoughSquare transition(double u) {
  RoughSquare N = RoughSquare::Identity();
  N(0, 1) = N(1, 2) = N(2, 3) = 1;
  N.row(3) += Eigen::RowVector4d(-1, -4, -6, -4);
  const RoughSquare N2 = N * N;
  return std::exp(-u) * (RoughSquare::Identity() + u * N + u * u / 2 * N2 + u * u * u / 6 * N2 * N);
}

} // namespace

RoughSquare roughCovariance() {
  RoughSquare P;
  P << 1, 0, -0.2, 0, 0, 0.2, 0, -0.2, -0.2, 0, 0.2, 0, 0, -0.2, 0, 1;
  return P;
}

MaternStep maternTransition(double distance) {
  MaternStep step;
  step.A = transition(distance);
  if (distance > 0.3) {
    const RoughSquare P = roughCovariance();
    step.Q = P - step.A * P * step.A.transpose();
    return step;
  }
  // The integral avoids a difference that would cancel; Gauss-Legendre rule of 6 points.
  constexpr double kAt[] = {0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
  constexpr double kWeight[] = {0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
  step.Q.setZero();
  for (int i = 0; i < 3; ++i)
    for (const double side : {-1., 1.}) {
      const MaternState column = transition(distance / 2 * (1 + side * kAt[i])).col(3);
      step.Q += kDrive * kWeight[i] * distance / 2 * column * column.transpose();
    }
  return step;
}

MaternStep reversalMatrix(double cosine) {
  MaternStep turn;
  turn.A = MaternState(1, cosine, cosine * cosine, cosine * cosine * cosine).asDiagonal();
  const RoughSquare P = roughCovariance();
  turn.Q = P - turn.A * P * turn.A.transpose();
  return turn;
}

namespace {

// State: roughness (4), bias of the acceleration (1), and with a camera the underlying shape:
// height, slope and curvature (3), in the same powers of the wave number.
constexpr int kRough = 0, kBias = 4, kShape = 5, kMost = 8;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1>;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;

// Prior of the shape: radius of curvature 10 mm, length 20 mm, start within 0.1 m.
constexpr double kShapeCurvature = 100; // [1/m]
constexpr double kShapeLength = 0.02;   // [m]
constexpr double kShapeHeight = 0.1;    // [m]

struct Row {
  Vector h, gain;
  double residual = 0, variance = 0;
};

struct ProfileStep {
  Square A;
  Row rows[2];
  int count = 0;
  Vector x;
  Square P;
};

class Profiler {
 public:
  Profiler(Roughness roughness, const HeightOptions& options, bool camera)
      : wave_(std::sqrt(7.) / roughness.length), rms_(roughness.rms), options_(options),
        size_(camera ? kMost : kShape) {}

  double wave() const { return wave_; }

  void begin(Vector& x, Square& P) const {
    x = Vector::Zero(size_);
    P = Square::Zero(size_, size_);
    P.topLeftCorner<4, 4>() = rms_ * rms_ * roughCovariance();
    P(kBias, kBias) = options_.bias * options_.bias;
    if (size_ == kShape) return;
    const double sigmas[] = {kShapeHeight, 1 / wave_, kShapeCurvature / (wave_ * wave_)};
    for (int i = 0; i < 3; ++i) P(kShape + i, kShape + i) = sigmas[i] * sigmas[i];
  }

  void advance(Vector& x, Square& P, const TracedSample& from, const TracedSample& to,
               Square& A) const {
    A = Square::Identity(size_, size_);
    Square Q = Square::Zero(size_, size_);
    const double u = wave_ * (to.arc_length - from.arc_length);
    if (u > 0) {
      const MaternStep step = maternTransition(u);
      A.topLeftCorner<4, 4>() = step.A;
      Q.topLeftCorner<4, 4>() = rms_ * rms_ * step.Q;
    }
    if (to.direction_cosine < 1) {
      const MaternStep turn = reversalMatrix(to.direction_cosine);
      A.topLeftCorner<4, 4>() = turn.A * A.topLeftCorner<4, 4>();
      Q.topLeftCorner<4, 4>() = turn.A * Q.topLeftCorner<4, 4>() * turn.A + rms_ * rms_ * turn.Q;
    }
    Q(kBias, kBias) = options_.bias_change * options_.bias_change * (to.t - from.t);
    if (size_ == kMost && u > 0) {
      A(kShape, kShape + 1) = A(kShape + 1, kShape + 2) = u;
      A(kShape, kShape + 2) = u * u / 2;
      const double density = std::pow(kShapeCurvature, 2) / kShapeLength / std::pow(wave_, 5);
      Eigen::Matrix3d shape;
      shape << std::pow(u, 5) / 20, std::pow(u, 4) / 8, u * u * u / 6, std::pow(u, 4) / 8,
          u * u * u / 3, u * u / 2, u * u * u / 6, u * u / 2, u;
      Q.bottomRightCorner<3, 3>() = density * shape;
    }
    if (size_ == kMost && to.direction_cosine < 1) {
      A.row(kShape + 1) *= to.direction_cosine;
      A.row(kShape + 2) *= to.direction_cosine * to.direction_cosine;
      const double lost = 1 - to.direction_cosine * to.direction_cosine;
      Q(kShape + 1, kShape + 1) += lost / (wave_ * wave_);
      Q(kShape + 2, kShape + 2) += lost * std::pow(kShapeCurvature / (wave_ * wave_), 2);
    }
    x = A * x;
    const Square next = A * P * A.transpose() + Q;
    P = 0.5 * (next + next.transpose());
  }

  // Returns the row of the acceleration of a point that moves over the heights: h'' v^2 + h' v'.
  Vector accelerationRow(const TracedSample& sample) const {
    Vector h = Vector::Zero(size_);
    const double bend = std::pow(wave_ * sample.speed, 2),
                 slope = wave_ * sample.tangential_acceleration;
    h[kRough + 1] = slope;
    h[kRough + 2] = bend;
    h[kBias] = 1;
    if (size_ == kMost) {
      h[kShape + 1] = slope;
      h[kShape + 2] = bend;
    }
    return h;
  }
  Vector heightRow() const {
    Vector h = Vector::Zero(size_);
    h[kRough] = 1;
    if (size_ == kMost) h[kShape] = 1;
    return h;
  }

 private:
  double wave_, rms_;
  HeightOptions options_;
  int size_;
};

// Measurement update in Joseph form.
Row use(Vector& x, Square& P, const Vector& h, double measured, double variance) {
  Row row;
  row.h = h;
  row.residual = measured - h.dot(x);
  const Vector Ph = P * h;
  row.variance = h.dot(Ph) + variance;
  row.gain = Ph / row.variance;
  x += row.gain * row.residual;
  const Square rest = Square::Identity(P.rows(), P.cols()) - row.gain * h.transpose();
  const Square next = rest * P * rest.transpose() + variance * row.gain * row.gain.transpose();
  P = 0.5 * (next + next.transpose());
  return row;
}

bool hasHeights(const std::vector<TracedSample>& samples) {
  return std::any_of(samples.begin(), samples.end(),
                     [](const TracedSample& s) { return s.height && !s.is_stationary; });
}

// The fit of the roughness takes samples that are averaged within the tip's resolution.
constexpr std::size_t kMean = 3;
constexpr double kTold = 0.2e-3; // resolution of the tip [m]

struct Mean {
  TracedSample sample; // sample at the center
  double count;
};

// Returns -2 log likelihood.
double deviance(const std::vector<std::vector<Mean>>& stretches, Roughness roughness, bool shaped,
                const HeightOptions& options) {
  const Profiler profiler(roughness, options, shaped);
  Vector x;
  Square P, A;
  double sum = 0;
  for (const std::vector<Mean>& stretch : stretches) {
    profiler.begin(x, P);
    for (std::size_t i = 0; i < stretch.size(); ++i) {
      const TracedSample& sample = stretch[i].sample;
      if (i > 0) profiler.advance(x, P, stretch[i - 1].sample, sample, A);
      const Row row = use(x, P, profiler.accelerationRow(sample), sample.acceleration,
                          options.acceleration_variance / stretch[i].count);
      sum += std::log(row.variance) + row.residual * row.residual / row.variance;
    }
  }
  return sum;
}

std::vector<Mean> meansOf(const std::vector<TracedSample>& samples) {
  std::vector<Mean> means;
  for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
    if (samples[begin].is_stationary) {
      ++end;
      continue;
    }
    while (end < samples.size() && end < begin + kMean && !samples[end].is_stationary &&
           samples[end].arc_length - samples[begin].arc_length < kTold)
      ++end;
    const double count = static_cast<double>(end - begin);
    Mean mean{samples[begin + (end - begin) / 2], count};
    mean.sample.acceleration = 0;
    mean.sample.direction_cosine = 1;
    for (std::size_t i = begin; i < end; ++i) {
      mean.sample.acceleration +=
          (samples[i].acceleration + samples[i].indentation_acceleration) / count;
      mean.sample.direction_cosine *= samples[i].direction_cosine;
    }
    means.push_back(mean);
  }
  return means;
}

} // namespace

Roughness fitRoughness(const std::vector<std::vector<TracedSample>>& stretches,
                       const HeightOptions& options) {
  constexpr std::size_t kEnough = 1000; // number of means, from the longest intervals
  std::vector<std::vector<Mean>> means;
  for (const std::vector<TracedSample>& stretch : stretches) means.push_back(meansOf(stretch));
  std::sort(means.begin(), means.end(),
            [](const auto& a, const auto& b) { return a.size() > b.size(); });
  const bool shaped = std::any_of(stretches.begin(), stretches.end(), hasHeights);
  std::size_t count = 0, kept = 0;
  for (; kept < means.size() && count < kEnough; ++kept) {
    means[kept].resize(std::min(means[kept].size(), kEnough - count));
    count += means[kept].size();
  }
  means.resize(kept);
  // Searches the logarithms of curvature and length, which are nearly uncorrelated; rms and length
  // would form a narrow ridge. A wide grid is followed by a pattern search.
  double best_bend = 0, best_length = 0, least = INFINITY;
  const auto roughnessOf = [](double bend, double length) -> Roughness {
    return {std::exp(bend + 2 * length) / 7, std::exp(length)};
  };
  const auto look = [&](double bend, double length) {
    const double value = deviance(means, roughnessOf(bend, length), shaped, options);
    if (!(value < least)) return false;
    least = value;
    best_bend = bend;
    best_length = length;
    return true;
  };
  for (double bend = 1; bend < 1e4; bend *= 4)
    for (double length = 0.1e-3; length < 20e-3; length *= 2)
      look(std::log(bend), std::log(length));
  for (double step = 0.5; step > 0.03;) {
    const double bend = best_bend, length = best_length;
    bool better = false;
    for (const auto& [i, j] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}})
      better |= look(bend + i * step, length + j * step);
    if (!better) step /= 2;
  }
  return roughnessOf(best_bend, best_length);
}

HeightProfile estimateProfile(const std::vector<TracedSample>& samples,
                              const HeightOptions& options) {
  HeightProfile profile;
  if (samples.empty()) return profile;
  Roughness roughness{options.rms.value_or(0), options.length.value_or(0)};
  if (!options.rms || !options.length) roughness = fitRoughness({samples}, options);
  profile.rms = roughness.rms;
  profile.length = roughness.length;
  const Profiler profiler(roughness, options, hasHeights(samples));
  std::vector<ProfileStep> steps(samples.size());
  Vector x;
  Square P;
  profiler.begin(x, P);
  const Vector height = profiler.heightRow();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const TracedSample& sample = samples[i];
    ProfileStep& step = steps[i];
    if (i > 0) profiler.advance(x, P, samples[i - 1], sample, step.A);
    if (!sample.is_stationary)
      step.rows[step.count++] =
          use(x, P, profiler.accelerationRow(sample),
              sample.acceleration + sample.indentation_acceleration, options.acceleration_variance);
    if (sample.height && !sample.is_stationary)
      step.rows[step.count++] = use(x, P, height, *sample.height + sample.indentation,
                                    sample.height_sigma * sample.height_sigma);
    step.x = x;
    step.P = P;
  }
  // Modified Bryson-Frazier smoother (Bierman 1973): a stationary tip's covariance is singular.
  Vector l = Vector::Zero(x.size());
  Square L = Square::Zero(x.size(), x.size());
  profile.points.resize(samples.size());
  for (std::size_t i = samples.size(); i-- > 0;) {
    const ProfileStep& step = steps[i];
    const Vector Ph = step.P * height;
    profile.points[i] = {samples[i].arc_length, height.dot(step.x) - Ph.dot(l),
                         std::sqrt(std::max(height.dot(Ph) - Ph.dot(L * Ph), 0.)),
                         samples[i].speed};
    for (int k = step.count; k-- > 0;) {
      const Row& row = step.rows[k];
      const Square rest = Square::Identity(x.size(), x.size()) - row.gain * row.h.transpose();
      l = (rest.transpose() * l - row.h * (row.residual / row.variance)).eval();
      L = (rest.transpose() * L * rest + row.h * row.h.transpose() / row.variance).eval();
    }
    if (i > 0) {
      l = (step.A.transpose() * l).eval();
      L = (step.A.transpose() * L * step.A).eval();
    }
  }
  return profile;
}

} // namespace patina
