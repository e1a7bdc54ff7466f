// One value of a panel: caption, slider and number with its unit; optionally removable.
#pragma once

#include <QDoubleSpinBox>
#include <QSlider>
#include <QToolButton>
#include <QWidget>

namespace patina {

struct RowRange {
  double low = 0, high = 1, step = 0.1;
  int decimals = 2;
  bool logarithmic = false; // Requires low > 0.
};

// Makes a number with its unit that reports a value when it is typed completely.
QDoubleSpinBox* numberBox(const QString& caption, const QString& unit, const RowRange& range,
                          QWidget* parent);

class ValueRow : public QWidget {
  Q_OBJECT
 public:
  ValueRow(const QString& caption, const QString& unit, const RowRange& range,
           QWidget* parent = nullptr);

  void setValue(double value); // Sends no signal.
  double value() const { return number_->value(); }
  void setReach(double reach) { // Range of the slider to both sides of 0; the number's range stays.
    range_.low = -reach;
    range_.high = reach;
  }
  void setRemovable(const QString& tip) { // Shows a cross that sends removed().
    cross_->setToolTip(tip);
    cross_->setVisible(true);
  }

 signals:
  void edited(double value);
  void removed();

 private:
  int toSlider(double value) const;
  double fromSlider(int position) const;

  RowRange range_;
  QSlider* slider_;
  QDoubleSpinBox* number_;
  QToolButton* cross_;
};

// Decides on the wheel and keys of the number fields, sliders and choices below `panel`, also later
// ones. The wheel scrolls the panel unless it is over the field being edited. Enter (takes the
// text) and Escape (drops it) return the keys to `view`, whose shortcuts are letters. A focused
// button takes Space and Enter; otherwise Enter presses the main button. Lists and text fields
// handle Enter themselves. `view` must outlive the panel.
void takeValueKeys(QWidget& panel, QWidget& view);

// Removes the rows of a panel (or nullptr) later, as they may be senders of the current signal.
void takeAway(QWidget* rows);

} // namespace patina
