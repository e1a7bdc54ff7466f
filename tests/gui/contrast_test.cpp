// Every text is legible in the light and in the dark theme.
#include <cmath>
#include <functional>
#include <map>

#include "app/gui/control/desk_controller.h"
#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"

namespace patina {
namespace {

// WCAG 2.1: relative luminance, and the contrast of two colours.
double luminance(QRgb color) {
  const auto linear = [](int byte) {
    const double c = byte / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(qRed(color)) + 0.7152 * linear(qGreen(color)) +
         0.0722 * linear(qBlue(color));
}
double contrast(QRgb a, QRgb b) {
  const double la = luminance(a), lb = luminance(b);
  return (std::max(la, lb) + 0.05) / (std::min(la, lb) + 0.05);
}

// The ground is the most frequent colour, the text the one with the largest contrast.
double contrastOf(const QImage& image) {
  std::map<QRgb, int> count;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) ++count[image.pixel(x, y)];
  const auto ground = std::max_element(count.begin(), count.end(), [](auto& a, auto& b) {
                        return a.second < b.second;
                      })->first;
  int seen = 0;
  std::map<double, int, std::greater<>> most;
  for (const auto& [color, pixels] : count) most[contrast(color, ground)] += pixels;
  for (const auto& [found, pixels] : most)
    if ((seen += pixels) >= 6) return found;
  return 1;
}

// The text is drawn four times as large, so that stems of letters are whole pixels.
double contrastOf(QWidget& widget) {
  QImage image(4 * widget.size(), QImage::Format_RGB32);
  image.setDevicePixelRatio(4);
  image.fill(widget.window()->palette().color(QPalette::Window));
  const QRect place(widget.mapTo(widget.window(), QPoint()), widget.size());
  widget.window()->render(&image, QPoint(), QRegion(place));
  return contrastOf(image);
}

bool hasWords(const QWidget& widget) {
  if (const auto* label = qobject_cast<const QLabel*>(&widget)) return !label->text().isEmpty();
  if (const auto* button = qobject_cast<const QToolButton*>(&widget))
    return !button->text().isEmpty() && button->toolButtonStyle() != Qt::ToolButtonIconOnly;
  if (const auto* button = qobject_cast<const QAbstractButton*>(&widget))
    return !button->text().isEmpty();
  return qobject_cast<const QAbstractSpinBox*>(&widget) != nullptr ||
         qobject_cast<const QComboBox*>(&widget) != nullptr ||
         qobject_cast<const QListWidget*>(&widget) != nullptr ||
         qobject_cast<const QMenuBar*>(&widget) != nullptr ||
         qobject_cast<const StripPlot*>(&widget) != nullptr;
}

class Contrast : public WindowTest, public ::testing::WithParamInterface<Theme> {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (IsSkipped()) return;
    window_.reset();
    // The theme changes while the window is open.
    applyStyle(application(), GetParam() == Theme::dark ? Theme::light : Theme::dark);
    window_ = std::make_unique<MainWindow>();
    window_->resize(1280, 800);
    window_->show();
    ASSERT_TRUE(open(saved(icosphere(0.03, 12), "sphere.obj")));
  }
  // A part of the 3D view: fractions of its width and height, from its upper left.
  QImage viewed(double x0, double y0, double x1, double y1) {
    view().frames().refresh();
    const QImage all = view().grabFramebuffer().convertToFormat(QImage::Format_RGB32);
    return all.copy(QRectF(x0 * all.width(), y0 * all.height(), (x1 - x0) * all.width(),
                           (y1 - y0) * all.height())
                        .toRect());
  }
  void TearDown() override {
    window_.reset();
    if (!IsSkipped()) applyStyle(application(), Theme::light);
    WindowTest::TearDown();
  }
};

TEST_P(Contrast, IsAtLeastFourAndAHalfForEveryText) {
  for (const char* property : {"Friction", "Damping", "Tip radius"}) addProperty(property);
  setRow("stiffness", 333);
  ASSERT_TRUE(waitUntil([&] { return edits().status().edits.size() > 0; }, 20000));
  edits().thread().undo();
  emit documents().notified({QStringLiteral("a warning"), true});
  for (const Layer layer : {Layer::slice, Layer::iso}) show(layer, true);
  applyStyle(application(), GetParam());
  int seen = 0;
  for (const DeskRow& desk : deskRows()) {
    window_->controllers().desks.choose(desk.desk);
    for (const Panel panel : desk.panels) {
      window_->controllers().desks.open(panel);
      wait(60);
      for (QWidget* widget : window_->findChildren<QWidget*>()) {
        if (!widget->isVisible() || widget->window() != window_.get() || !hasWords(*widget))
          continue;
        if (widget->visibleRegion().boundingRect().size() != widget->size()) continue; // scrolled
        ++seen;
        EXPECT_GE(contrastOf(*widget), 4.5)
            << widget->metaObject()->className() << ' ' << widget->objectName().toStdString()
            << " on " << desk.name;
      }
    }
    if (const char* folder = std::getenv("PATINA_PICTURES"))
      window_->grab().save(QStringLiteral("%1/theme_%2_%3.png")
                               .arg(folder)
                               .arg(static_cast<int>(GetParam()))
                               .arg(desk.name));
  }
  EXPECT_GT(seen, 300);
}

TEST_P(Contrast, IsAtLeastFourAndAHalfForTextInThePicture) {
  find<QToolButton>("mode_magnetic")->click();
  show(Layer::slice, true);
  ASSERT_TRUE(waitUntil([&] { return edits().status().edits.size() > 0; }, 20000));
  applyStyle(application(), GetParam());
  wait(500);
  const QRgb ground = viewed(0.8, 0.001, 0.82, 0.01).pixel(0, 0);
  EXPECT_EQ(luminance(ground) < 0.1, GetParam() == Theme::dark) << luminance(ground);
  const struct {
    const char* what;
    double x0, y0, x1, y1;
  } words[] = {{"title of the scalar bar", 0.885, 0.2, 0.985, 0.29},
               {"numbers of the scalar bar", 0.92, 0.3, 0.985, 0.74},
               {"legend of the band", 0.01, 0.01, 0.2, 0.06},
               {"length of the scale bar", 0.14, 0.92, 0.3, 0.99},
               {"letters of the axes", 0.01, 0.82, 0.12, 0.98}};
  for (const auto& at : words)
    EXPECT_GE(contrastOf(viewed(at.x0, at.y0, at.x1, at.y1)), 4.5) << at.what;
  if (const char* folder = std::getenv("PATINA_PICTURES"))
    view().grabFramebuffer().save(
        QStringLiteral("%1/view_%2.png").arg(folder).arg(static_cast<int>(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(Themes, Contrast, ::testing::Values(Theme::light, Theme::dark));

} // namespace
} // namespace patina
