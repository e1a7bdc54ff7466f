// The frames of a scan in a row, with their tracking quality. Loads only visible thumbnails.
#pragma once

#include <map>

#include <QImage>
#include <QListWidget>

#include "app/gui/scanning/open_scan.h"

namespace patina {

class FrameStrip : public QListWidget {
  Q_OBJECT
 public:
  explicit FrameStrip(OpenScan& scan, QWidget* parent = nullptr);
  // Position in the viewport, even if scrolled out.
  QRect placeOf(std::size_t frame) const { return visualItemRect(item(static_cast<int>(frame))); }
  std::size_t held() const { return thumbs_.size(); }
  void paintFrame(QPainter& painter, const QRect& cell, std::size_t frame) const;
  QSize minimumSizeHint() const override;
  QSize sizeHint() const override { return minimumSizeHint(); }

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void takeScan();
  void showCursor();
  void load(); // Loads missing thumbnails and frees distant ones.

  OpenScan& scan_;
  Background job_;
  std::map<std::size_t, QImage> thumbs_; // Null image: unreadable.
};

} // namespace patina
