// A line of text that gives way: what does not fit is left out, and stands in the tooltip.
#pragma once

#include <QLabel>

namespace patina {

class ElidedLabel : public QLabel {
 public:
  explicit ElidedLabel(QWidget* parent = nullptr);
  QSize minimumSizeHint() const override;
  bool elides() const; // now

 protected:
  void paintEvent(QPaintEvent* event) override;
  bool event(QEvent* event) override;
};

} // namespace patina
