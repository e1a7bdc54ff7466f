// Plots curves over axes. A plot is described by a plain value, and the widget draws it. The wheel
// zooms x under the pointer, a drag shifts it, a double click shows what was shown at first.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include <QPainter>
#include <QPolygonF>
#include <QString>
#include <QWidget>

namespace patina {

struct AxisSpan {
  double from = 0, to = 1;
  double length() const { return to - from; }
  bool operator==(const AxisSpan&) const = default;
};
// Zooms in by `notches` (> 0) or out around `at`, to `min_length` at least and `whole` at most.
AxisSpan zoomed(const AxisSpan& whole, const AxisSpan& seen, double at, double notches,
                double min_length);
// Keeps the length and stays within `whole`.
AxisSpan shifted(const AxisSpan& whole, const AxisSpan& seen, double by);
// Returns about `count` round values, two or more if possible, at least `min_step` apart.
std::vector<double> marksOf(const AxisSpan& span, int count, double min_step = 0);
// Returns a step of 1, 2 or 5 times a power of ten so that at most `count` fit into the range.
double stepFor(double range, int count);
QString withMinus(QString number); // Replaces the hyphen by a minus sign.

struct PlotCurve {
  QString name;        // Empty: not in the legend.
  const char* color;   // See theme.h.
  QPolygonF points{};  // x increases.
  double width = 1.4;  // [px]
  QString value{};     // Follows the name; empty: the value under the pointer does.
  QString max_value{}; // The legend has room for it, so that the next name does not move.
};

// A pair of axes with their curves.
struct PlotAxes {
  QString x_unit, y_unit;
  std::vector<PlotCurve> curves{};
  bool spectrum = false;                // Bars over logarithmic axes.
  bool counted = false;                 // Whole numbers along x.
  std::optional<AxisSpan> x{}, y{};     // nullopt: the range of the points.
  std::optional<AxisSpan> first_view{}; // Part of x that is shown before a zoom; nullopt: all.
  double min_view = 0;                  // Smallest part of x; 0: a thousandth of all.
  QString zero_words{};                 // Stands instead of x = 0.
};

// A part or a place of x, drawn above stacked axes. A click there moves the cursor onto it.
struct PlotMark {
  enum class Shape { span, cross, dash };
  double from, to;
  const char* color;
  Shape shape;
};

struct PlotContent {
  std::vector<PlotAxes> axes{};
  bool stacked = false; // One below the other over a common x, else side by side.
  bool bare = false;    // A filled curve without axes, which cannot be zoomed.
  std::vector<PlotMark> marks{};
  std::optional<double> cursor{}; // A drag moves it, instead of shifting the axis.
  QString words{};                // Stands in the middle.
};

class PlotWidget : public QWidget {
  Q_OBJECT
 public:
  explicit PlotWidget(QWidget* parent = nullptr);

  // keeps_view: the zoom stays.
  void setContent(PlotContent content, bool keeps_view = false);
  // Part of x that the user has chosen; nullopt: the first view.
  std::optional<AxisSpan> chosenView() const;
  void resetView() { chosen_.clear(); }
  void moveInto(double x);                // Shifts the chosen view so that it contains x.
  QPoint placeOf(double x) const;         // Position on the line of marks.
  QSize minimumSizeHint() const override; // Includes values of the legend.

 signals:
  void viewChanged(bool chosen); // The user has zoomed or shifted; false: wants the first view.
  void cursorMoved(double x);

 protected:
  bool event(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  // Places of axes in the widget. Logarithmic axes have the logarithms of their values here.
  struct Frame {
    QRectF whole, area; // An empty area has no curves.
    AxisSpan all, x, y;
    std::vector<double> levels; // Marks of y.
    double legend = 0;          // Top of the legend [px].
    bool logarithmic = false;
    double toX(double x) const;
    double toY(double y) const;
    double fromX(double pixel) const;
  };
  std::vector<Frame> frames() const;
  Frame frameOf(const PlotAxes& axes, std::size_t view, int max_levels) const;
  std::size_t axesAt(const QPointF& place) const;
  void zoom(const QPointF& place, double notches);
  void shift(double pixels);
  void moveCursor(const QPointF& place);
  int legendWidth(const PlotCurve& curve) const;
  std::optional<double> pointedAt(const Frame& frame, const PlotAxes& axes) const;
  void paintBare(QPainter& painter) const;
  void paintLevels(QPainter& painter, const Frame& frame, const PlotAxes& axes) const;
  void paintX(QPainter& painter, const Frame& frame, const PlotAxes& axes, bool has_words) const;
  void paintCurves(QPainter& painter, const Frame& frame, const PlotAxes& axes) const;
  void paintLegend(QPainter& painter, const Frame& frame, const PlotAxes& axes) const;
  void paintMarks(QPainter& painter, const QRectF& area, const Frame& frame) const;

  PlotContent content_;
  // Zoomed part of x by the index of its axes; stacked axes share index 0.
  std::map<std::size_t, AxisSpan> chosen_;
  std::optional<std::size_t> dragged_;
  std::optional<QPointF> pointer_;
  double last_ = 0; // Last position of a drag [px].
};

} // namespace patina
