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
  bool logarithmic = false; // low > 0 then
};

class ValueRow : public QWidget {
  Q_OBJECT
 public:
  ValueRow(const QString& caption, const QString& unit, const RowRange& range,
           QWidget* parent = nullptr);

  void setValue(double value); // sends no signal
  double value() const { return number_->value(); }
  void setReach(double reach);           // the slider's, to both sides of 0; the number's stays
  void setRemovable(const QString& tip); // shows a cross that sends removed()

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

// Takes the rows of a panel away, whether or not there are any, so that others can be made. They
// may be the senders of the signal that leads here, and so live on until it is done.
void takeAway(QWidget* rows);

} // namespace patina
