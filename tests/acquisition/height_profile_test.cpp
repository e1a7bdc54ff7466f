#include "acquisition/profile/height_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "acquisition/simulation/simulated_surface.h"
#include "core/decompose.h"
#include "support/constants.h"
#include "support/shared_data.h"

namespace patina {
namespace {

using test::kPi;

constexpr double kStep = 0.015 * 9.80665, kNoise = 0.02; // [m/s^2]
constexpr double kVariance = kNoise * kNoise + kStep * kStep / 12;

TEST(RoughProcess, KeepsItsCovarianceOverAnyDistance) {
  const RoughSquare P = roughCovariance();
  for (const double distance : {1e-6, 1e-3, 0.1, 0.99, 1.01, 5., 50.}) {
    const MaternStep step = maternTransition(distance);
    EXPECT_TRUE((step.A * P * step.A.transpose() + step.Q).isApprox(P, 1e-9)) << distance;
    // Two half steps equal the whole step.
    const MaternStep half = maternTransition(distance / 2);
    EXPECT_TRUE((half.A * half.A).isApprox(step.A, 1e-9)) << distance;
    EXPECT_TRUE((half.A * half.Q * half.A.transpose() + half.Q).isApprox(step.Q, 1e-6)) << distance;
  }
  // Heights at a distance have the covariance of Matern 7/2.
  const double u = 1.7;
  EXPECT_NEAR((maternTransition(u).A * P)(0, 0),
              std::exp(-u) * (1 + u + 0.4 * u * u + u * u * u / 15), 1e-12);
}

TEST(RoughProcess, ReversesExactlyAndForgetsSlopesAtARightAngle) {
  const MaternStep back = reversalMatrix(-1), aside = reversalMatrix(0);
  EXPECT_LT(back.Q.norm(), 1e-15);
  EXPECT_EQ(back.A.diagonal(), MaternState(1, -1, 1, -1));
  EXPECT_EQ(aside.A(0, 0), 1);
  EXPECT_NEAR(aside.Q(1, 1), roughCovariance()(1, 1), 1e-15);
}

// --- A07: surfaces that are known, drawn over by s(t).

struct Drawn {
  std::vector<TracedSample> samples;
  std::vector<double> heights;
};

// Samples `height` along s(t) for `seconds` with sensor rounding; derivatives of s are differences.
template <class Height, class Place>
Drawn drawnOver(const Height& height, const Place& place, double seconds, std::uint32_t seed,
                bool exact_sensor = false) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Drawn drawn;
  const double d = 1e-3;
  double along = 0, last = place(0.);
  for (int i = 0; i < seconds * 500; ++i) {
    const double t = i / 500.;
    const double velocity = (place(t + d) - place(t - d)) / (2 * d);
    const double change = (place(t + d) - 2 * place(t) + place(t - d)) / (d * d);
    TracedSample sample;
    sample.t = t;
    along += std::abs(place(t) - last);
    sample.arc_length = along;
    sample.speed = std::abs(velocity);
    sample.tangential_acceleration = velocity < 0 ? -change : change;
    const double exact =
        (height(place(t + d)) - 2 * height(place(t)) + height(place(t - d))) / (d * d);
    sample.acceleration =
        exact_sensor ? exact : kStep * std::round((exact + kNoise * normal(random)) / kStep);
    last = place(t);
    drawn.samples.push_back(sample);
    drawn.heights.push_back(height(last));
  }
  return drawn;
}

HeightOptions sensor() {
  HeightOptions options;
  options.acceleration_variance = kVariance;
  return options;
}

// Amplitude of the best wave of this length in a profile, and the residual.
std::pair<double, double> waveIn(const std::vector<ProfilePoint>& points, double length) {
  Eigen::MatrixXd A(static_cast<Eigen::Index>(points.size()), 4);
  Eigen::VectorXd b(A.rows());
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    const ProfilePoint& point = points[static_cast<std::size_t>(i)];
    const double angle = 2 * kPi * point.arc_length / length;
    A.row(i) << std::cos(angle), std::sin(angle), 1, point.arc_length;
    b[i] = point.height;
  }
  const Eigen::VectorXd x = SymmetricSolver(A.transpose() * A).solve(A.transpose() * b);
  return {std::hypot(x[0], x[1]), (A * x - b).squaredNorm()};
}

// A07: a wave of 2 mm, scanned at 20 to 80 mm/s.
TEST(HeightProfile, FindsAWaveScannedAtVaryingSpeed) {
  const auto wave = [](double s) { return 60e-6 * std::sin(2 * kPi * s / 2e-3); };
  const auto place = [](double t) { return 0.05 * t - 0.03 / (2 * kPi * 0.5) * std::cos(kPi * t); };
  const Drawn drawn = drawnOver(wave, place, 4, 1);
  const HeightProfile profile = estimateProfile(drawn.samples, sensor());
  double best = 0, least = INFINITY;
  for (double length = 1.9e-3; length < 2.1e-3; length += 1e-6)
    if (const double left = waveIn(profile.points, length).second; left < least) {
      least = left;
      best = length;
    }
  EXPECT_NEAR(best, 2e-3, 0.01 * 2e-3);
  EXPECT_NEAR(waveIn(profile.points, best).first, 60e-6, 0.1 * 60e-6);
}

double relativeError(const std::vector<ProfilePoint>& points, const std::vector<double>& truth) {
  double error = 0, all = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    error += std::pow(points[i].height - truth[i], 2);
    all += truth[i] * truth[i];
  }
  return std::sqrt(error / all);
}

// Waves of 0.6 to 6 mm at random, high as they are long.
double roughWave(double s) {
  static const std::function<double(const Vec2&)> surface = roughSurface(9, 40e-6);
  return surface(Vec2(s, 0.4 * s));
}

TEST(HeightProfile, GainsNoInformationAtRest) {
  // The tip moves, rests for two seconds and moves on, against the same path without the rest.
  const auto eased = [](double x) { return x * x * x * (10 - 15 * x + 6 * x * x); };
  const auto place = [&](double t) {
    const double x = std::clamp(t, 0., 1.), y = std::clamp(t - 3, 0., 1.);
    return 0.03 * (eased(x) + eased(y));
  };
  const Drawn drawn = drawnOver(roughWave, place, 4, 2);
  const HeightProfile profile = estimateProfile(drawn.samples, sensor());
  double most = 0;
  for (std::size_t i = 520; i < 1480; ++i)
    most = std::max(most, std::abs(profile.points[i].height - profile.points[500].height));
  EXPECT_LT(most, 1e-9) << "it wandered while it stood";
  EXPECT_LT(relativeError(profile.points, drawn.heights), 0.65); // long waves are lost
}

TEST(HeightProfile, UsesTheReversalOfThePath) {
  const auto place = [](double t) { return 0.03 * std::sin(kPi * t / 2 + 1e-9); };
  Drawn drawn = drawnOver(roughWave, place, 2, 3, true);
  HeightOptions options;
  options.acceleration_variance = 1e-6;
  options.rms = 40e-6;
  options.length = 1e-3;
  const double straight =
      relativeError(estimateProfile(drawn.samples, options).points, drawn.heights);
  for (std::size_t i = 1; i < drawn.samples.size(); ++i)
    if (drawn.samples[i].t >= 1 && drawn.samples[i - 1].t < 1)
      drawn.samples[i].direction_cosine = -1;
  const double turned =
      relativeError(estimateProfile(drawn.samples, options).points, drawn.heights);
  EXPECT_LT(turned, 0.25);
  EXPECT_GT(straight, 1.5 * turned) << "the turn made no difference";
}

TEST(HeightProfile, StatedErrorsHold) {
  // A surface that matches the model.
  const double rms = 50e-6, length = 1e-3, speed = 0.04, dt = 0.002;
  const double wave = std::sqrt(7.) / length;
  const MaternStep step = maternTransition(wave * speed * dt);
  double nees = 0;
  constexpr int kRuns = 30;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    std::mt19937 random(run);
    std::normal_distribution<double> normal;
    const auto drawn = [&] {
      return MaternState(normal(random), normal(random), normal(random), normal(random));
    };
    const RoughSquare first = roughCovariance().llt().matrixL();
    MaternState x = rms * (first * drawn());
    const Eigen::LDLT<RoughSquare> Q(step.Q);
    const RoughSquare root =
        Q.transpositionsP().transpose() *
        RoughSquare(Q.matrixL() * RoughSquare(Q.vectorD().cwiseMax(0).cwiseSqrt().asDiagonal()));
    std::vector<TracedSample> samples;
    std::vector<double> heights;
    for (int i = 0; i < 600; ++i) {
      if (i > 0) x = step.A * x + rms * (root * drawn());
      TracedSample sample;
      sample.t = i * dt;
      sample.arc_length = sample.t * speed;
      sample.speed = speed;
      sample.acceleration =
          std::pow(wave * speed, 2) * x[2] + std::sqrt(kVariance) * normal(random);
      samples.push_back(sample);
      heights.push_back(x[0]);
    }
    HeightOptions options = sensor();
    options.rms = rms;
    options.length = length;
    const HeightProfile profile = estimateProfile(samples, options);
    for (std::size_t i = 0; i < heights.size(); ++i)
      nees += std::pow((profile.points[i].height - heights[i]) / profile.points[i].sigma, 2) /
              (600. * kRuns);
  }
  EXPECT_NEAR(nees, 1, 0.25);
}

TEST(HeightProfile, TakesLowFrequenciesFromTheCamera) {
  // A bowl of 80 mm radius carries the waves.
  const auto bowl = [](double s) { return std::pow(s - 0.05, 2) / (2 * 0.08) + roughWave(s); };
  const auto place = [](double t) { return 0.04 * t; };
  Drawn drawn = drawnOver(bowl, place, 2.5, 4);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < drawn.samples.size(); i += 17) {
    drawn.samples[i].height = drawn.heights[i] + 0.2e-3 * normal(random);
    drawn.samples[i].height_sigma = 0.2e-3;
  }
  const HeightProfile profile = estimateProfile(drawn.samples, sensor());
  double squares = 0, nees = 0;
  for (std::size_t i = 0; i < drawn.heights.size(); ++i) {
    const double error = profile.points[i].height - drawn.heights[i];
    squares += error * error / static_cast<double>(drawn.heights.size());
    nees +=
        std::pow(error / profile.points[i].sigma, 2) / static_cast<double>(drawn.heights.size());
  }
  EXPECT_LT(std::sqrt(squares), 0.1e-3); // the heights are 16 mm
  EXPECT_LT(nees, 4);
}

// --- Milled surfaces, traced by a round tip.

struct Traces {
  double ours = 0, knowing = 0, plain = 0; // relative rms
};

// Errors of filters that integrate the accelerations twice, term by term of the cosine series.
// `knowing` is the Wiener filter for the true power of each term, which is the lower bound;
// `plain` takes all terms.
void addOracles(const TraceReading& reading, double part, Traces& traces) {
  const std::size_t n = reading.samples.size();
  const auto count = static_cast<double>(n);
  double knowing = 0, plain = 0, all = 0;
  for (std::size_t term = 1; term < n; ++term) {
    double read = 0, truth = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double wave =
          2 / count *
          std::cos(kPi * static_cast<double>(term) * (static_cast<double>(i) + 0.5) / count);
      read += wave * reading.samples[i].acceleration;
      truth += wave * reading.heights[i];
    }
    const double pulse = kPi * static_cast<double>(term) * 500 / count;
    const double passed = -pulse * pulse / std::sqrt(1 + std::pow(pulse / (2 * kPi * 200), 8));
    const double power = truth * truth;
    const double found = power * passed / (power * passed * passed + 2 * kVariance / count) * read;
    knowing += (found - truth) * (found - truth);
    plain += std::pow(-read / (pulse * pulse) - truth, 2);
    all += power;
  }
  traces.knowing += part * knowing / all;
  traces.plain += part * plain / all;
}

// Root mean square over several offsets of the sensor's steps.
Traces tracesOver(const std::vector<double>& heights, double step, double speed) {
  constexpr int kOffsets = 4;
  Traces traces;
  for (std::uint32_t k = 0; k < kOffsets; ++k) {
    const TraceReading reading =
        readTrace(heights, step, speed, 500, kStep, kNoise, kStep * (k + 0.5) / kOffsets, k);
    const HeightProfile profile = estimateProfile(reading.samples, sensor());
    traces.ours += std::pow(relativeError(profile.points, reading.heights), 2) / kOffsets;
    addOracles(reading, 1. / kOffsets, traces);
  }
  traces.ours = std::sqrt(traces.ours);
  traces.knowing = std::sqrt(traces.knowing);
  traces.plain = std::sqrt(traces.plain);
  std::printf("%2.0f mm/s: %.3f, knowing the truth %.3f, plain %.2f\n", 1e3 * speed, traces.ours,
              traces.knowing, traces.plain);
  return traces;
}

// Counterpart of the shared surface: the phase of its long waves limits every filter.
TEST(HeightProfile, ApproachesTheSensorLimitOnMilledSurfaces) {
  const double step = 5e-6;
  for (const std::uint32_t seed : {1, 2, 3}) {
    const std::vector<double> heights = envelope(milledProfile(seed, 28e-3, step), step, 0.5e-3);
    for (const double speed : {0.02, 0.04}) {
      const Traces traces = tracesOver(heights, step, speed);
      EXPECT_LE(traces.ours, 2.5 * traces.knowing) << seed;
      EXPECT_LE(traces.ours, 0.7) << seed;
      EXPECT_LE(traces.ours, 0.1 * traces.plain) << seed;
    }
  }
}

// At high speed neighbouring accelerations are nearly independent; measured 0.3 to 0.4.
TEST(HeightProfile, IsFastOnMilledSurfaces) {
  const double step = 5e-6;
  for (const std::uint32_t seed : {1, 2, 3, 4}) {
    const std::vector<double> heights = envelope(milledProfile(seed, 28e-3, step), step, 0.5e-3);
    for (const double speed : {0.06, 0.08}) {
      const TraceReading reading =
          readTrace(heights, step, speed, 500, kStep, kNoise, kStep / 3, seed);
      EXPECT_LE(relativeError(estimateProfile(reading.samples, sensor()).points, reading.heights),
                0.5)
          << seed << " at " << speed;
    }
  }
}

std::vector<double> readHeights(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string text((std::istreambuf_iterator<char>(file)), {});
  const std::string open = "<DATA_POINT_VALUES>";
  std::istringstream numbers(text.substr(text.find(open) + open.size()));
  std::vector<double> heights;
  for (double height; numbers >> height;) heights.push_back(height);
  return heights;
}

// Heights 200 times, lengths 5 times as large as measured.
TEST(HeightProfile, ApproachesTheSensorLimitOnTheSharedMilledSurface) {
  const std::filesystem::path path = test::sharedData("profiles/npl_mill.xml");
  PATINA_SKIP_WITHOUT(path);
  std::vector<double> heights = readHeights(path);
  ASSERT_EQ(heights.size(), 22401u);
  for (double& height : heights) height *= 200e-6;
  const double step = 5 * 0.25e-6;
  const std::vector<double> traced = envelope(heights, step, 0.5e-3);
  for (const auto& [speed, most] : {std::pair(0.02, 0.45), {0.03, 0.4}, {0.04, 0.35}}) {
    const Traces traces = tracesOver(traced, step, speed);
    EXPECT_LE(traces.ours, most);
  }
}

TEST(HeightProfile, IsEmptyWithoutSamples) {
  EXPECT_TRUE(estimateProfile({}, sensor()).points.empty());
}

} // namespace
} // namespace patina
