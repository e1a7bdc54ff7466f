#include "app/gui/widgets/value_focus.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSpinBox>
#include <QApplication>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QKeyEvent>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QSlider>
#include <QTextEdit>

namespace patina {
namespace {

bool holdsValue(const QWidget& widget) {
  return qobject_cast<const QAbstractSpinBox*>(&widget) != nullptr ||
         qobject_cast<const QSlider*>(&widget) != nullptr ||
         qobject_cast<const QComboBox*>(&widget) != nullptr;
}

// It has an Enter of its own, which a line edit leaves to its parents all the same.
bool isText(const QWidget* widget) {
  return qobject_cast<const QLineEdit*>(widget) != nullptr ||
         qobject_cast<const QTextEdit*>(widget) != nullptr ||
         qobject_cast<const QPlainTextEdit*>(widget) != nullptr;
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

bool isEnter(const QKeyEvent& event) {
  return event.key() == Qt::Key_Return || event.key() == Qt::Key_Enter;
}

// Of the panel; in a window that is no dialog Qt presses none.
QPushButton* mainButton(const QWidget& panel) {
  for (QPushButton* button : panel.findChildren<QPushButton*>())
    if (button->isDefault() && button->isVisible() && button->isEnabled()) return button;
  return nullptr;
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
  if (widget == nullptr) return false;
  // What no widget takes comes to the window: a bar's buttons leave it Enter.
  if (widget != panel_.window() && !panel_.isAncestorOf(widget)) return false;
  if (!holdsValue(*widget)) {
    if (type != QEvent::KeyPress) return false;
    const auto& pressed = *static_cast<QKeyEvent*>(event);
    return isEnter(pressed) && press(pressed.isAutoRepeat());
  }
  if (type == QEvent::Polish) {
    widget->setFocusPolicy(Qt::StrongFocus); // the wheel would give itself the focus
    return false;
  }
  if (type == QEvent::Wheel) {
    if (widget->hasFocus()) return false;
    event->ignore(); // and so it goes on to what scrolls
    return true;
  }
  const auto& key = *static_cast<QKeyEvent*>(event);
  const bool enter = isEnter(key);
  if (!enter && key.key() != Qt::Key_Escape) return false;
  settleText(*widget, enter);
  view_.setFocus(Qt::OtherFocusReason);
  return true;
}

bool ValueFocus::press(bool again) {
  QWidget* focused = QApplication::focusWidget();
  if (qobject_cast<QAbstractItemView*>(focused) != nullptr) return false; // it chooses a line
  if (isText(focused)) return false;
  auto* button = qobject_cast<QAbstractButton*>(focused);
  if (button == nullptr) button = mainButton(panel_);
  if (button == nullptr) return false;
  if (again) return true; // Qt would press it by each: a key that is held is one press
  button->setFocus();     // and so the next Enter is its own, too
  button->click();
  return true;
}

} // namespace patina
