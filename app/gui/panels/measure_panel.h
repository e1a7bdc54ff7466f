// Chooses what is measured, and lists measurements and pins.
#pragma once

#include <QComboBox>
#include <QGroupBox>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QStringList>

#include "app/gui/toolkit/interaction_mode.h"
#include "app/gui/toolkit/value_row.h"

namespace patina {

enum class MeasureKind { distance, angle, sphere, cylinder, area };

class MeasurePanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit MeasurePanel(QWidget* parent = nullptr);

  void setMode(InteractionMode mode); // measure or pin
  MeasureKind kind() const { return static_cast<MeasureKind>(kind_->currentIndex()); }
  double patchRadius() const { return 1e-3 * radius_->value(); } // [m]
  void setExtent(double extent);                                 // Sets the patch's radius [m].
  void setNext(int done); // Shows which point is clicked next, after `done` ones.
  void setBusy(bool on);  // A measurement is being made, which the button Clear then stops.
  void setResults(const QStringList& results);
  void setPins(const QStringList& pins);

 signals:
  void kindChosen();
  void cleared();
  void pinRemoved(int row);
  void exportRequested();

 private:
  void arrange();

  InteractionMode mode_ = InteractionMode::measure;
  QComboBox* kind_;
  ValueRow* radius_;
  QLabel* next_;
  QListWidget *results_, *pins_;
  QStringList shown_pins_; // the list's lines
  QPushButton *clear_, *remove_, *export_;
  bool busy_ = false;
};

} // namespace patina
