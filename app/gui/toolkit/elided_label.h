// A label that shortens its text to the available width; the tooltip has all of it.
#pragma once

#include <QLabel>

namespace patina {

class ElidedLabel : public QLabel {
 public:
  explicit ElidedLabel(QWidget* parent = nullptr);
  QSize minimumSizeHint() const override;
  bool elides() const { // True if the text is shortened now.
    return fontMetrics().horizontalAdvance(text()) > contentsRect().width();
  }

 protected:
  void paintEvent(QPaintEvent* event) override;
  bool event(QEvent* event) override;
};

} // namespace patina
