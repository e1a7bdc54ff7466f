// Shows a picture with marks on it. The wheel zooms around the pointer, a drag shifts the zoomed
// picture, a double click shows all of it.
#pragma once

#include <vector>

#include <QColor>
#include <QImage>
#include <QPolygonF>
#include <QString>
#include <QWidget>

namespace patina {

// Drawn with a dark outline, to be visible on any picture.
struct PictureMark {
  enum class Shape { line, crosses, ring }; // Crosses stand at each point, a ring at the first.
  QPolygonF points;                         // Pixels of the picture; (0, 0) is a pixel's centre.
  QColor color;
  double width = 1.6; // Width in the widget [px].
  Shape shape = Shape::line;
  QString tag{}; // Stands at the end, or beside a closed line.
};

struct PictureContent {
  QImage picture;
  std::vector<PictureMark> marks{};
  QString words{};    // Stands instead of an empty picture.
  bool smooth = true; // False: pixels have sharp edges.
};

class PictureView : public QWidget {
  Q_OBJECT
 public:
  explicit PictureView(QWidget* parent = nullptr);
  void setContent(PictureContent content) { // Keeps the zoom.
    content_ = std::move(content);
    update();
  }
  QPointF placeOf(const QPointF& pixel) const; // Position in the widget.

 protected:
  bool event(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  double scale() const; // Widget pixels per picture pixel.
  void zoom(const QPointF& place, double notches);
  void paintMark(QPainter& painter, const PictureMark& mark) const;

  PictureContent content_;
  double zoom_ = 1; // Relative to the fitted size.
  QPointF shift_, last_;
};

} // namespace patina
