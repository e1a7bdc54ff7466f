#include "app/gui/widgets/value_focus.h"

#include <QAbstractButton>
#include <QAbstractSpinBox>
#include <QApplication>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QKeyEvent>
#include <QSlider>

namespace patina {
namespace {

bool holdsValue(const QWidget& widget) {
  return qobject_cast<const QAbstractSpinBox*>(&widget) != nullptr ||
         qobject_cast<const QSlider*>(&widget) != nullptr ||
         qobject_cast<const QComboBox*>(&widget) != nullptr;
}

// Text that is not taken yet would be when the focus goes.
void settleText(QWidget& widget, bool keeps) {
  auto* number = qobject_cast<QDoubleSpinBox*>(&widget);
  if (number == nullptr) return;
  if (keeps)
    number->interpretText();
  else
    number->setValue(number->value());
}

} // namespace

// Panels make rows while the window lives, so that a filter on each widget would be many.
ValueFocus::ValueFocus(QWidget& panel, QWidget& view)
    : QObject(&panel), panel_(panel), view_(view) {
  for (QWidget* widget : panel.findChildren<QWidget*>()) // polished before
    if (holdsValue(*widget)) widget->setFocusPolicy(Qt::StrongFocus);
  QApplication::instance()->installEventFilter(this);
}

bool ValueFocus::eventFilter(QObject* receiver, QEvent* event) {
  const QEvent::Type type = event->type();
  auto* widget = qobject_cast<QWidget*>(receiver);
  if (type == QEvent::ShortcutOverride && qobject_cast<QAbstractButton*>(receiver) != nullptr &&
      panel_.isAncestorOf(widget) && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Space) {
    event->accept(); // it is the button's
    return true;
  }
  if (type != QEvent::Polish && type != QEvent::Wheel && type != QEvent::KeyPress) return false;
  if (widget == nullptr || !holdsValue(*widget) || !panel_.isAncestorOf(widget)) return false;
  if (type == QEvent::Polish) {
    widget->setFocusPolicy(Qt::StrongFocus); // the wheel would give itself the focus
    return false;
  }
  if (type == QEvent::Wheel) {
    if (widget->hasFocus()) return false;
    event->ignore(); // and so it goes on to what scrolls
    return true;
  }
  const int key = static_cast<QKeyEvent*>(event)->key();
  const bool enter = key == Qt::Key_Return || key == Qt::Key_Enter;
  if (!enter && key != Qt::Key_Escape) return false;
  settleText(*widget, enter);
  view_.setFocus(Qt::OtherFocusReason);
  return true;
}

} // namespace patina
