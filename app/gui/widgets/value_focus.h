// How the number fields, sliders and choices of a panel take wheel and keys: the wheel scrolls the
// panel unless it is over what is being edited, and Enter (takes what was typed) or Escape (drops
// it) hands the keys back to the 3D view, whose shortcuts are single letters. Space on a button is
// the button's, and so is Enter; where nothing else takes it, Enter is the main button's. A list
// and a field of text have their own.
#pragma once

#include <QObject>
#include <QWidget>

namespace patina {

class ValueFocus : public QObject {
 public:
  // For whatever is or comes below panel; owned by panel. view outlives it.
  ValueFocus(QWidget& panel, QWidget& view);

 protected:
  bool eventFilter(QObject* receiver, QEvent* event) override;

 private:
  // The button that has the keys, or the main one; not again while the key is held.
  bool press(bool again);

  QWidget& panel_;
  QWidget& view_;
};

} // namespace patina
