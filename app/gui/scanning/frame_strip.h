// The frames of a scan side by side, each with what it is worth. It holds those that are seen.
#pragma once

#include <map>

#include <QAbstractScrollArea>
#include <QImage>

#include "app/gui/scanning/open_scan.h"

namespace patina {

// Told apart by form as well as colour.
void drawBadge(QPainter& painter, const QPointF& middle, FrameQuality quality);
QString wordOf(FrameQuality quality);

class FrameStrip : public QAbstractScrollArea {
  Q_OBJECT
 public:
  explicit FrameStrip(OpenScan& scan, QWidget* parent = nullptr);
  QRect placeOf(std::size_t frame) const; // in the viewport, if it were seen
  std::size_t held() const { return thumbs_.size(); }
  QSize minimumSizeHint() const override;
  QSize sizeHint() const override { return minimumSizeHint(); }

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  bool viewportEvent(QEvent* event) override; // tooltips

 private:
  std::size_t count() const;
  std::optional<std::size_t> frameAt(const QPoint& place) const;
  std::pair<std::size_t, std::size_t> seen() const; // first and behind the last
  void takeScan();
  void showCursor();
  void arrange();
  void load(); // thumbnails that are missing, and lets go of those that are far

  OpenScan& scan_;
  Background job_;
  std::map<std::size_t, QImage> thumbs_; // null: it cannot be read
};

} // namespace patina
