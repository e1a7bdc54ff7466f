// The colour of a brush: that which is chosen, swatches, and those that were chosen last.
#pragma once

#include <array>

#include <QHBoxLayout>
#include <QToolButton>
#include <QWidget>

namespace patina {

class ColorChoice : public QWidget {
  Q_OBJECT
 public:
  using Color = std::array<double, 3>; // sRGB
  explicit ColorChoice(const Color& now, QWidget* parent);

 signals:
  void chosen(const std::array<double, 3>& color);

 private:
  QToolButton* swatch(QHBoxLayout& line, int wide);
  void offer(QToolButton& button, const Color& color); // to be chosen by a click
  void choose(const Color& color);
  void ask();
  void showRecent();

  Color color_;
  QToolButton* now_;
  QWidget* recent_;
};

} // namespace patina
