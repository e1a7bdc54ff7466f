// A stroke follows the hand's path, even if frames are slow.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "app/gui/state/contact_offset.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "scene/surface_pick.h"
#include "session/store/journal_fold.h"
#include "visualization/values/camera.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

class Strokes : public DrivenWindow {
 protected:
  static constexpr double kSeconds = 0.5;

  // 61 places about the middle of the picture.
  static std::vector<QPoint> letterW() {
    const QPoint corners[] = {{-100, -60}, {-50, 60}, {0, -60}, {50, 60}, {100, -60}};
    std::vector<QPoint> places;
    for (int i = 0; i <= 60; ++i) {
      const int leg = std::min(i / 15, 3);
      places.push_back(corners[leg] + (corners[leg + 1] - corners[leg]) * (i - 15 * leg) / 15.0);
    }
    return places;
  }
  Vec3 under(const QPoint& place) {
    const double high = view().height();
    const QPoint pixel = middle() + place;
    const Ray ray =
        rayThrough(*view().view().renderer().GetActiveCamera(),
                   (pixel.x() - 0.5 * view().width()) / high, (0.5 * high - pixel.y()) / high);
    return firstSurfaceAlong(*edits().scene()->built.field, ray.origin, ray.direction).value();
  }
  // Draws at a hand's pace, also if the window is busy.
  void draw(const std::vector<QPoint>& places) {
    const QPoint origin = inView({});
    std::atomic<bool> done{false};
    std::thread hand([&] {
      auto due = std::chrono::steady_clock::now();
      const auto step = std::chrono::duration_cast<std::chrono::nanoseconds>(
          std::chrono::duration<double>(kSeconds / static_cast<double>(places.size())));
      for (const QPoint& place : places) {
        hand_->moveTo(origin.x() + place.x(), origin.y() + place.y());
        if (&place == &places.front()) hand_->button(1, true);
        std::this_thread::sleep_until(due += step);
      }
      hand_->button(1, false);
      done = true;
    });
    waitUntil([&] { return done.load(); });
    hand.join();
  }
  // Returns the only stroke of the history.
  Stroke strokeOfW(const TriangleMesh& mesh, const char* name) {
    EXPECT_TRUE(open(saved(mesh, name)));
    type(QStringLiteral("d")); // stiffness
    waitUntil([&] { return !edits().thread().busy(); });
    wait(300);
    pointAt(inView(letterW().front()));
    wait(800); // the tool hovers above the surface
    draw(letterW());
    EXPECT_TRUE(waitUntil([&] { return edits().status().edits.size() == 1; }, 20000));
    std::printf("%s: a frame takes %.0f ms\n", name, 1000 * frameSeconds());
    const auto folder = folder_ / (std::string(name) + ".patina");
    saving().saveTo(QString::fromStdString(folder.string()));
    const OpenedWorkspace kept = openWorkspace(folder);
    return kept.journal.empty() ? Stroke{} : std::get<Stroke>(kept.journal.front());
  }
  static double distance(const Vec3& place, const Stroke& stroke) {
    double least = 1e9;
    for (std::size_t i = 1; i < stroke.samples.size(); ++i) {
      const Vec3 a = stroke.samples[i - 1].position, way = stroke.samples[i].position - a;
      const double length = way.squaredNorm();
      const double part = length > 0 ? std::clamp((place - a).dot(way) / length, 0.0, 1.0) : 0;
      least = std::min(least, (place - a - part * way).norm());
    }
    return least;
  }
  static double farthest(const Stroke& of, const Stroke& from) {
    double most = 0;
    for (const StrokeSample& sample : of.samples)
      most = std::max(most, distance(sample.position, from));
    return most;
  }
};

TEST_F(Strokes, LetterWIsTheSameOnAMillionTrianglesAndPassesEveryPixel) {
  const Stroke quick = strokeOfW(icosphere(0.03, 22), "9680.ply");
  std::vector<Vec3> places;
  for (const QPoint& place : letterW()) places.push_back(under(place));
  const double radius = quick.brush.radius;
  double off = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double miss = distance(places[i], quick);
    if (miss > 0.02 * radius) std::printf("place %zu is missed by %.2f mm\n", i, 1000 * miss);
    off = std::max(off, miss);
  }
  const Stroke slow = strokeOfW(icosphere(0.03, 224), "1003520.ply");
  double slow_off = 0;
  for (const Vec3& place : places) slow_off = std::max(slow_off, distance(place, slow));
  const double apart = std::max(farthest(quick, slow), farthest(slow, quick));
  std::printf("of the radius of %.2f mm: the pixels are off by %.2f %% and %.2f %%, the strokes by "
              "%.2f %%; %zu and %zu samples\n",
              1000 * radius, 100 * off / radius, 100 * slow_off / radius, 100 * apart / radius,
              quick.samples.size(), slow.samples.size());
  EXPECT_LT(apart, 0.02 * radius);
  EXPECT_LT(off, 0.02 * radius);
  EXPECT_LT(slow_off, 0.02 * radius);
}

// Every frame after the first one with paint shows paint.
TEST_F(Strokes, NoFrameIsUnpaintedWhenAStrokeEnds) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 40), "sphere.ply")));
  show(Layer::tip, false);
  type(QStringLiteral("p"));
  ASSERT_TRUE(waitUntil([&] { return !edits().thread().busy(); }));
  wait(300);
  pointAt(inView({-80, 40}));
  wait(500);
  std::vector<int> red;
  const QRect around(middle() - QPoint(40, 10), QSize(80, 60));
  const auto shown = QObject::connect(&view(), &QOpenGLWidget::frameSwapped, [&] {
    const QImage part = view().grab(around).toImage();
    int count = 0;
    for (int y = 0; y < part.height(); ++y)
      for (int x = 0; x < part.width(); ++x) {
        const QColor c = part.pixelColor(x, y);
        count += c.red() > 90 && c.red() > 1.7 * c.green() && c.red() > 1.7 * c.blue() ? 1 : 0;
      }
    red.push_back(count);
  });
  drag(inView({-80, 20}), inView({80, 20}), 1, 40);
  EXPECT_TRUE(waitUntil([&] { return edits().status().edits.size() == 1; }, 20000));
  pointAt(inView({0, 200}));
  wait(600);
  QObject::disconnect(shown);
  const int whole = red.back();
  ASSERT_GT(whole, 300);
  bool painted = false;
  for (const int count : red) {
    EXPECT_FALSE(painted && count < whole / 2) << count << " of " << whole;
    painted = painted || count > 0.9 * whole;
  }
}

// 0.8 N are 8 mm deep at 100 N/m: a thin part would be left on its other side, unpainted.
TEST_F(Strokes, PressGoesNoDeeperThanTheMiddleOfAThinPart) {
  ASSERT_TRUE(open(saved(box({0.06, 0.06, 0.003}, 8), "plate.obj")));
  const Vec3 above(0.003, 0.004, 0.0015);
  const CompiledScene& plate = *edits().scene();
  EXPECT_NEAR(clampedDepth(plate, above, 8e-3), 1.5e-3, 0.02e-3);
  // Next to an edge the part has the same thickness.
  EXPECT_EQ(clampedDepth(plate, {0.0295, 0, 0.0015}, 1.4e-3), 1.4e-3);
  EXPECT_EQ(clampedDepth(plate, above, 0.2e-3), 0.2e-3);
  EXPECT_EQ(clampedDepth(plate, above, -1e-3), -1e-3) << "above the rendered surface";
  ASSERT_TRUE(open(saved(icosphere(0.03, 12), "ball.obj")));
  EXPECT_EQ(clampedDepth(*edits().scene(), {0, 0, 0.03}, 3e-3), 3e-3);
}

TEST_F(Strokes, FirstOneWithAnotherToolPaintsAtThePointer) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 22), "sphere.ply")));
  type(QStringLiteral("p"));
  pointAt(inView({-120, 0}));
  wait(800);
  press();
  for (int i = 1; i <= 20; ++i) pointAt(inView({-120, 2 * i}));
  hand_->button(1, false);
  ASSERT_EQ(edits().status().done, 0u) << "the tip has come to the end of the way";
  type(QStringLiteral("h"));
  ASSERT_TRUE(waitUntil([&] { return edits().status().done == 1; }, 5000));
  drag(inView({120, 0}), inView({120, 40}), 1, 20);
  EXPECT_TRUE(waitUntil([&] { return edits().status().done == 2; }, 5000));
}

} // namespace
} // namespace patina
