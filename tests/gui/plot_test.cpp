// Plots and their axes.
#include "app/gui/toolkit/plot.h"

#include <cmath>

#include <QMouseEvent>

#include <gtest/gtest.h>

#include "app/gui/toolkit/words.h"
#include "gui/window_fixture.h"

namespace patina {
namespace {

TEST(Plots, AxisHasAtLeastTwoRoundMarksInsideIt) {
  for (int count = 2; count <= 8; ++count)
    for (double from = -3.7; from < 4; from += 0.37)
      for (double length = 1e-3; length < 2e3; length *= 1.7) {
        const AxisSpan span{from, from + length};
        const auto marks = marksOf(span, count);
        ASSERT_GE(marks.size(), 2U) << from << " + " << length << ", " << count;
        EXPECT_LE(marks.size(), static_cast<std::size_t>(count) + 4);
        EXPECT_GE(marks.front(), from - 1e-9 * length);
        EXPECT_LE(marks.back(), span.to + 1e-9 * length);
      }
  EXPECT_EQ(marksOf({-1, 1}, 4), (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
  EXPECT_FALSE(std::signbit(marksOf({-1, 1}, 4)[2]));
  EXPECT_EQ(marksOf({0, 2.4}, 8, 1), (std::vector<double>{0, 1, 2}));
  EXPECT_TRUE(marksOf({0.3, std::nextafter(0.3, 1)}, 4).empty());
  EXPECT_TRUE(marksOf({std::nan(""), 1}, 4).empty());
}

constexpr AxisSpan kWhole{-2, 8};

TEST(AxisZoom, KeepsThePointUnderThePointer) {
  const AxisSpan seen{0, 4};
  for (const double notches : {1., 3., -1.}) {
    const AxisSpan nearer = zoomed(kWhole, seen, 1, notches, 0.01);
    EXPECT_NEAR((1 - nearer.from) / nearer.length(), 0.25, 1e-12) << notches;
    EXPECT_NEAR(nearer.length(), 4 * std::pow(1.25, -notches), 1e-12);
  }
}

TEST(AxisZoom, StaysBetweenTheWholeRangeAndTheSmallestOne) {
  EXPECT_EQ(zoomed(kWhole, {0, 4}, 1, -50, 0.01), kWhole);
  EXPECT_NEAR(zoomed(kWhole, {0, 4}, 1, 100, 0.01).length(), 0.01, 1e-12);
}

TEST(AxisZoom, ShiftStopsAtTheEndsOfTheWholeRange) {
  EXPECT_EQ(shifted(kWhole, {0, 4}, 1), (AxisSpan{1, 5}));
  EXPECT_EQ(shifted(kWhole, {0, 4}, 100), (AxisSpan{4, 8}));
  EXPECT_EQ(shifted(kWhole, {0, 4}, -100), (AxisSpan{-2, 2}));
}

class PlotTest : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (IsSkipped()) return;
    plot_ = std::make_unique<PlotWidget>();
    plot_->resize(400, 150);
    plot_->show();
  }
  void TearDown() override {
    plot_.reset();
    WindowTest::TearDown();
  }
  void send(QEvent::Type type, const QPointF& place, Qt::MouseButton button) {
    QMouseEvent event(type, place, button, button, Qt::NoModifier);
    QApplication::sendEvent(plot_.get(), &event);
  }
  QImage picture() { return plot_->grab().toImage(); }
  static PlotContent line() {
    PlotCurve curve{QStringLiteral("height"), "accent"};
    for (int i = 0; i <= 10; ++i) curve.points << QPointF(i, i * i);
    return {{{QStringLiteral("mm"), QStringLiteral("µm"), {curve}}}};
  }
  std::unique_ptr<PlotWidget> plot_;
};

TEST_F(PlotTest, ShowsTheValueUnderThePointerUntilItLeaves) {
  if (IsSkipped()) return;
  plot_->setContent(line());
  const QImage before = picture();
  send(QEvent::MouseMove, {200, 75}, Qt::NoButton);
  EXPECT_NE(picture(), before);
  QEvent leave(QEvent::Leave);
  QApplication::sendEvent(plot_.get(), &leave);
  EXPECT_EQ(picture(), before);
}

TEST_F(PlotTest, DragMovesTheCursorOfAPlotThatHasOneAndAClickFindsAMark) {
  if (IsSkipped()) return;
  PlotContent content = line();
  content.stacked = true;
  content.cursor = 2;
  content.marks = {{7, 7, "bad", PlotMark::Shape::cross}, {8.5, 9, "warn", PlotMark::Shape::span}};
  plot_->setContent(content);
  std::vector<double> moved;
  QObject::connect(plot_.get(), &PlotWidget::cursorMoved, [&](double x) { moved.push_back(x); });
  send(QEvent::MouseButtonPress, plot_->placeOf(7) + QPoint(2, 0), Qt::LeftButton);
  send(QEvent::MouseMove, QPointF(plot_->placeOf(5)) + QPointF(0, 60), Qt::LeftButton);
  send(QEvent::MouseButtonRelease, plot_->placeOf(5), Qt::LeftButton);
  ASSERT_EQ(moved.size(), 2U);
  EXPECT_EQ(moved[0], 7);
  EXPECT_NEAR(moved[1], 5, 0.05);
  EXPECT_FALSE(plot_->chosenView()) << "the axis stays";
}

TEST_F(PlotTest, KeepsTheViewThatContainsThePlaceAndFollowsOneOutside) {
  if (IsSkipped()) return;
  plot_->setContent(line());
  QWheelEvent wheel({200, 75}, {200, 75}, {}, {0, 600}, Qt::NoButton, Qt::NoModifier,
                    Qt::NoScrollPhase, false);
  QApplication::sendEvent(plot_.get(), &wheel);
  const auto view = plot_->chosenView();
  ASSERT_TRUE(view);
  EXPECT_NEAR(view->length(), 10 * std::pow(1.25, -5), 1e-9);
  plot_->moveInto(0.5 * (view->from + view->to));
  EXPECT_EQ(plot_->chosenView(), view);
  plot_->moveInto(9.9);
  EXPECT_NEAR(plot_->chosenView()->to, 10, 1e-9);
  send(QEvent::MouseButtonDblClick, {200, 75}, Qt::LeftButton);
  EXPECT_FALSE(plot_->chosenView());
}

TEST(Words, HaveNoMinusBeforeZero) {
  for (const double value : {-0.04, -0., 0.04}) {
    EXPECT_EQ(QString::number(shownAs(value, 1), 'f', 1), QStringLiteral("0.0"));
    EXPECT_EQ(shownAs(value, 3) == 0, value == 0);
  }
  EXPECT_EQ(shownAs(-0.06, 1), -0.06);
}

TEST(Words, KeepANumberAndItsUnitTogether) {
  EXPECT_EQ(inWords(5e-6), QStringLiteral("5 µm").replace(' ', kNoBreak));
  EXPECT_EQ(inWords(std::string("rms 50 um, 3 %")),
            QStringLiteral("rms 50_µm, 3_%").replace('_', kNoBreak));
}

TEST(Words, NameNoCommandInAMessageOfTheWindow) {
  const auto shown = [](const char* words) {
    return withoutCommands(QString::fromUtf8(words)).toStdString();
  };
  EXPECT_EQ(shown("rig.json: marker 3 lies 1 mm off; calibrate the rig (patina calibrate)"),
            "rig.json: marker 3 lies 1 mm off; calibrate the rig");
  EXPECT_EQ(
      shown("half.ply: 94 edges of one triangle: a part that stays open is felt from its front "
            "(patina info, sides); from both sides with patina scene --set surface.sides=two"),
      "half.ply: 94 edges of one triangle: a part that stays open is felt from its front");
  EXPECT_EQ(shown("a.obj: the mesh is 100 m long when its unit is m; choose another with --unit"),
            "a.obj: the mesh is 100 m long when its unit is m");
  EXPECT_EQ(shown("the pose is ambiguous: another place fits; scan more of the body, or use patina "
                  "register with --no-search"),
            "the pose is ambiguous: another place fits; scan more of the body");
  EXPECT_EQ(shown("v.avi: has neither frame times nor a frame rate: set --rate"),
            "v.avi: has neither frame times nor a frame rate");
  EXPECT_EQ(shown("two--words.ply: stays (as it is); so does this"),
            "two--words.ply: stays (as it is); so does this");
  EXPECT_EQ(shown("workspace: is open elsewhere; edits are not saved"),
            "workspace: is open elsewhere; edits are not saved");
}

} // namespace
} // namespace patina
