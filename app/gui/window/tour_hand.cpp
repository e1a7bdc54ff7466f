#include "app/gui/window/tour_hand.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include <QElapsedTimer>

#include "app/gui/window/wait.h"
#include "core/error.h"
#include "scene/surface_pick.h"
#include "visualization/view/camera.h"

namespace patina {
namespace {

constexpr std::chrono::milliseconds kBeat{4};

// The surface under a place of the picture, in fractions of its height from the centre.
std::optional<Vec3> surfaceAt(MainWindow& window, double x, double y, Vec3& inward) {
  const Ray ray = rayThrough(*find<SceneWidget>(window).view().renderer().GetActiveCamera(), x, y);
  inward = ray.direction;
  return firstSurfaceAlong(*window.controllers().edits.scene()->built.field, ray.origin,
                           ray.direction);
}

// One target a beat, at(0 .. 1).
std::vector<Vec3> path(int milliseconds, const std::function<std::optional<Vec3>(double)>& at) {
  std::vector<Vec3> targets;
  const int beats = milliseconds / static_cast<int>(kBeat.count());
  for (int beat = 0; beat <= beats; ++beat)
    if (const auto target = at(static_cast<double>(beat) / beats)) targets.push_back(*target);
  return targets;
}

} // namespace

void play(MainWindow& window, const std::vector<Vec3>& targets) {
  if (targets.empty()) return;
  std::atomic<bool> done{false};
  std::thread hand([&] {
    auto due = std::chrono::steady_clock::now();
    for (const Vec3& target : targets) {
      window.controllers().feel.servo().setTarget(target);
      std::this_thread::sleep_until(due += kBeat);
    }
    done = true;
  });
  waitUntil([&] { return done.load(); }, 120000);
  hand.join();
  find<SceneWidget>(window).setTarget(targets.back());
}

Vec2 placeToTouch(MainWindow& window) {
  Vec3 inward;
  for (double radius = 0; radius < 0.5; radius += 0.02)
    for (int step = 0; step < 24; ++step) {
      const double angle = 2 * M_PI * step / 24;
      const Vec2 place(radius * std::cos(angle), radius * std::sin(angle));
      if (surfaceAt(window, place[0], place[1], inward)) return place;
    }
  throw Error("there is no surface in the picture to touch");
}

void press(MainWindow& window, const Vec2& place, double depth, int milliseconds) {
  Vec3 inward;
  const auto hit = surfaceAt(window, place[0], place[1], inward);
  if (!hit) throw Error("the tour lost the surface");
  const double gap = 0.05 * find<SceneWidget>(window).view().extent().diagonal().norm();
  play(window, path(milliseconds, [&](double t) -> std::optional<Vec3> {
         return *hit + inward * (t * (gap + depth) - gap);
       }));
}

void slide(MainWindow& window, const Vec2& from, const Vec2& to, double depth, int milliseconds) {
  play(window, path(milliseconds, [&](double t) -> std::optional<Vec3> {
         const Vec2 place = from + (to - from) * t;
         Vec3 inward;
         const auto hit = surfaceAt(window, place[0], place[1], inward);
         if (!hit) return std::nullopt;
         return *hit + inward * (depth * (0.7 + 0.3 * std::cos(4 * M_PI * t)));
       }));
}

void paintAlong(MainWindow& window, const std::function<Vec2(double)>& at, int milliseconds,
                const std::function<void()>& at_last) {
  const EditController& edits = window.controllers().edits;
  const std::size_t before = edits.status().edits.size();
  Vec3 inward;
  const auto point = [&](double t, bool down) {
    const Vec2 place = at(t);
    emit find<SceneWidget>(window).pointed(
        {surfaceAt(window, place[0], place[1], inward), down, 1});
  };
  QElapsedTimer clock;
  clock.start();
  while (clock.elapsed() < milliseconds) {
    point(static_cast<double>(clock.elapsed()) / milliseconds, true);
    wait(8);
  }
  point(1, true);
  wait(60);
  if (at_last) at_last();
  point(1, false);
  if (!waitUntil([&] { return edits.status().edits.size() > before; }, 20000))
    throw Error("the tour's brush painted nothing");
}

} // namespace patina
