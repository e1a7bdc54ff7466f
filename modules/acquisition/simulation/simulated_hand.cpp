#include "acquisition/simulation/simulated_hand.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;

// Smooth step from 0 to 1 with zero velocity and acceleration at both ends.
double eased(double x) {
  x = std::clamp(x, 0., 1.);
  return x * x * x * (10 - 15 * x + 6 * x * x);
}

// Returns a sum of sines with rms 1/sqrt(2), different for each `number`.
double wave(std::uint32_t seed, std::uint32_t number, double low, double high, double t) {
  std::minstd_rand random(1 + seed * 7919 + number * 104729);
  random.discard(10);
  const auto drawn = [&] { return static_cast<double>(random()) / 2147483647.; };
  constexpr int kSines = 3;
  double sum = 0;
  for (int i = 0; i < kSines; ++i) {
    const double frequency = low + (high - low) * drawn(), phase = kFullTurn * drawn();
    sum += std::sin(kFullTurn * frequency * t + phase);
  }
  return sum / std::sqrt(kSines);
}

Eigen::Quaterniond turned(double angle, const Vec3& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
}

struct Way {
  Vec2 from, to;
  double lateral_bow;
};

Vec2 placeOn(const Way& way, double x) {
  const Vec2 along = way.to - way.from;
  const double sine = std::sin(std::numbers::pi * x);
  const Vec2 aside = along.norm() > 0 ? Vec2(-along.y(), along.x()).normalized() : Vec2(0, 0);
  return way.from + x * along + way.lateral_bow * sine * sine * aside;
}

} // namespace

double SimulatedHand::seconds() const {
  double sum = 0;
  for (const HandMove& move : moves) sum += move.seconds;
  return sum;
}

HandCourse::Start HandCourse::Start::after(const HandMove& move, double share) const {
  return {placeOn({place, move.to, move.lateral_bow}, share), force + share * (move.force - force),
          lift + share * (move.lift - lift), time + move.seconds};
}

HandCourse::HandCourse(const SimulatedHand& hand) : hand_(&hand), starts_{{hand.from}} {
  for (const HandMove& move : hand.moves) starts_.push_back(starts_.back().after(move, 1));
}

HandState handAt(const HandCourse& course, double t) {
  const SimulatedHand& hand = *course.hand_;
  if (hand.gesture) return hand.gesture(t);
  const auto first = course.starts_.begin();
  const auto begun = std::upper_bound(
      first, course.starts_.end() - 1, t,
      [](double time, const HandCourse::Start& start) { return time < start.time; });
  HandCourse::Start now = begun == first ? *first : *(begun - 1);
  if (begun != first) {
    const HandMove& move = hand.moves[static_cast<std::size_t>(begun - first) - 1];
    now = now.after(move, eased((t - now.time) / move.seconds));
  }
  Vec2 place = now.place;
  HandState state;
  place.x() += hand.tremor * wave(hand.seed, 1, 8, 11, t);
  place.y() += hand.tremor * wave(hand.seed, 2, 8, 11, t);
  state.force = now.force * (1 + hand.force_noise * wave(hand.seed, 3, 0.3, 3, t));
  state.touching = state.force > 0;
  state.surface = hand.relief(place);
  // A lifted tip does not follow the relief.
  const double height = state.surface + now.lift * (hand.travel_height - state.surface);
  state.tip = Vec3(place.x(), place.y(), height);
  if (state.force > 0) state.tip -= hand.compliance * state.force * hand.normal(place);
  const auto angle = [&](std::uint32_t number) {
    return hand.tilt * wave(hand.seed, number, 0.2, 0.8, t) +
           hand.tremor_tilt * wave(hand.seed, number + 3, 8, 11, t);
  };
  state.orientation = turned(angle(10), Vec3::UnitX()) * turned(angle(11), Vec3::UnitY()) *
                      turned(0.5 * angle(12), Vec3::UnitZ());
  return state;
}

SimulatedHand strokes(std::uint32_t seed, double seconds, double speed, const StrokeArea& area) {
  SimulatedHand hand;
  hand.seed = seed;
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967295.;
  };
  const double side = (area.high - area.low).minCoeff();
  const auto reachable = [&](const Way& way) {
    constexpr int kLooks = 100;
    for (int i = 0; i <= kLooks; ++i)
      if (!area.reachable(placeOn(way, static_cast<double>(i) / kLooks))) return false;
    return true;
  };
  const auto anyWay = [&] {
    constexpr int kTries = 3000;
    for (const double parts : {3., 6., 12.})
      for (int i = 0; i < kTries; ++i) {
        const double x = between(area.low.x(), area.high.x());
        const double y = between(area.low.y(), area.high.y());
        Way way{{x, y}, {x, y}, 0};
        way.to.x() = between(area.low.x(), area.high.x());
        way.to.y() = between(area.low.y(), area.high.y());
        const double length = (way.to - way.from).norm();
        way.lateral_bow = between(-0.05, 0.05) * length;
        if (length > side / parts && reachable(way)) return way;
      }
    throw Error("no path of " + formatLength(side / 12) +
                " over the surface can be scanned from above");
  };
  double left = seconds;
  const auto move = [&](const Vec2& to, double lasting, double bow, double force, double lift) {
    hand.moves.push_back({to, lasting, bow, force, lift});
    left -= lasting;
  };
  Vec2 place(0, 0);
  int stroke = 0;
  while (left > 0) {
    const Way way = anyWay();
    const double pace = speed * between(0.7, 1.3), force = between(0.6, 1.4);
    const double lasting = (way.to - way.from).norm() / pace;
    if (stroke == 0)
      hand.from = way.from;
    else
      move(way.from, 0.3 + (way.from - place).norm() / 0.25, 0, 0, 1);
    move(way.from, 0.4, 0, 0, 0);
    move(way.from, 0.3, 0, force, 0);
    move(way.to, lasting, way.lateral_bow, force, 0);
    place = way.to;
    if (stroke % 2 == 1) move(place, 0.3, 0, force, 0);
    if (stroke % 3 == 2) {
      place = way.from;
      move(place, lasting, -way.lateral_bow, force, 0);
    }
    move(place, 0.2, 0, 0, 0);
    move(place, 0.3, 0, 0, 1);
    ++stroke;
  }
  return hand;
}

} // namespace patina
