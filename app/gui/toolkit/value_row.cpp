#include "app/gui/toolkit/value_row.h"

#include <algorithm>
#include <cmath>

#include <QAbstractItemView>
#include <QApplication>
#include <QComboBox>
#include <QGridLayout>
#include <QKeyEvent>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QSignalBlocker>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/elided_label.h"
#include "app/gui/toolkit/words.h"

namespace patina {
namespace {
constexpr int kSteps = 1000;

class NumberBox : public QDoubleSpinBox {
 public:
  using QDoubleSpinBox::QDoubleSpinBox;
  QString textFromValue(double value) const override {
    return QDoubleSpinBox::textFromValue(shownAs(value, decimals()));
  }
};

bool holdsValue(const QWidget& widget) {
  return qobject_cast<const QAbstractSpinBox*>(&widget) != nullptr ||
         qobject_cast<const QSlider*>(&widget) != nullptr ||
         qobject_cast<const QComboBox*>(&widget) != nullptr;
}

// A line edit passes Enter to its parents even though it uses it.
bool isText(const QWidget* widget) {
  return qobject_cast<const QLineEdit*>(widget) != nullptr ||
         qobject_cast<const QTextEdit*>(widget) != nullptr ||
         qobject_cast<const QPlainTextEdit*>(widget) != nullptr;
}

// Unread text would be taken when the focus leaves.
void commitText(QWidget& widget, bool keeps) {
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

// The panel's main button. Qt presses it only in dialogs.
QPushButton* mainButton(const QWidget& panel) {
  for (QPushButton* button : panel.findChildren<QPushButton*>())
    if (button->isDefault() && button->isVisible() && button->isEnabled()) return button;
  return nullptr;
}

// Panels create rows later, so each widget would need a filter.
class ValueFocus : public QObject {
 public:
  ValueFocus(QWidget& panel, QWidget& view) : QObject(&panel), panel_(panel), view_(view) {
    for (QWidget* widget : panel.findChildren<QWidget*>()) // Those are already polished.
      if (holdsValue(*widget)) widget->setFocusPolicy(Qt::StrongFocus);
    QApplication::instance()->installEventFilter(this);
  }

 protected:
  bool eventFilter(QObject* receiver, QEvent* event) override {
    const QEvent::Type type = event->type();
    auto* widget = qobject_cast<QWidget*>(receiver);
    const bool takes_space = qobject_cast<QAbstractButton*>(receiver) != nullptr ||
                             qobject_cast<QAbstractItemView*>(receiver) != nullptr;
    if (type == QEvent::ShortcutOverride && takes_space && panel_.isAncestorOf(widget) &&
        static_cast<QKeyEvent*>(event)->key() == Qt::Key_Space) {
      event->accept(); // The button or the list takes it.
      return true;
    }
    if (type != QEvent::Polish && type != QEvent::Wheel && type != QEvent::KeyPress) return false;
    if (widget == nullptr) return false;
    // Ignored keys reach the window: tool bar buttons ignore Enter.
    if (widget != panel_.window() && !panel_.isAncestorOf(widget)) return false;
    if (!holdsValue(*widget)) {
      if (type != QEvent::KeyPress) return false;
      const auto& pressed = *static_cast<QKeyEvent*>(event);
      return isEnter(pressed) && press(pressed.isAutoRepeat());
    }
    if (type == QEvent::Polish) {
      widget->setFocusPolicy(Qt::StrongFocus); // Otherwise the wheel would set the focus.
      return false;
    }
    if (type == QEvent::Wheel) {
      if (widget->hasFocus()) return false;
      event->ignore(); // The scroll area gets it.
      return true;
    }
    const auto& key = *static_cast<QKeyEvent*>(event);
    const bool enter = isEnter(key);
    if (!enter && key.key() != Qt::Key_Escape) return false;
    commitText(*widget, enter);
    view_.setFocus(Qt::OtherFocusReason);
    return true;
  }

 private:
  // Presses the focused button, or the main one; `again`: the key repeats.
  bool press(bool again) {
    QWidget* focused = QApplication::focusWidget();
    if (qobject_cast<QAbstractItemView*>(focused) != nullptr) return false;
    if (isText(focused)) return false;
    auto* button = qobject_cast<QAbstractButton*>(focused);
    if (button == nullptr) button = mainButton(panel_);
    if (button == nullptr) return false;
    if (again) return true; // Key repeats are ignored, because Qt would press the button for each.
    button->setFocus();     // The next Enter presses it, too.
    button->click();
    return true;
  }

  QWidget& panel_;
  QWidget& view_;
};

} // namespace

QDoubleSpinBox* numberBox(const QString& caption, const QString& unit, const RowRange& range,
                          QWidget* parent) {
  auto* box = new NumberBox(parent);
  box->setAccessibleName(caption);
  box->setDecimals(range.decimals);
  box->setRange(range.low, range.high);
  box->setSingleStep(range.step);
  box->setSuffix(unit.isEmpty() ? QString() : QStringLiteral(" ") + unit);
  box->setKeyboardTracking(false);
  return box;
}

ValueRow::ValueRow(const QString& caption, const QString& unit, const RowRange& range,
                   QWidget* parent)
    : QWidget(parent), range_(range), slider_(new QSlider(Qt::Horizontal, this)),
      number_(numberBox(caption, unit, range, this)), cross_(new QToolButton(this)) {
  auto* layout = layoutIn<QGridLayout>(this);
  layout->setVerticalSpacing(1);
  auto* label = new ElidedLabel(this);
  label->setText(caption);
  label->setProperty("quiet", true);
  auto* top = new QHBoxLayout;
  top->addWidget(label, 1);
  layout->addLayout(top, 0, 0, 1, 2);
  cross_->setText(QStringLiteral("✕"));
  cross_->setAutoRaise(true);
  cross_->setVisible(false);
  cross_->setFixedSize(18, 18);
  top->addWidget(cross_);
  layout->addWidget(slider_, 1, 0);
  layout->addWidget(number_, 1, 1);
  layout->setColumnStretch(0, 1);
  slider_->setRange(0, kSteps);
  number_->setMinimumWidth(96);
  slider_->setAccessibleName(caption);

  connect(slider_, &QSlider::valueChanged, this, [this](int position) {
    const QSignalBlocker quiet(number_);
    number_->setValue(fromSlider(position));
    emit edited(number_->value());
  });
  connect(number_, qOverload<double>(&QDoubleSpinBox::valueChanged), this, [this](double value) {
    const QSignalBlocker quiet(slider_);
    slider_->setValue(toSlider(value));
    emit edited(value);
  });
  connect(cross_, &QToolButton::clicked, this, &ValueRow::removed);
}

int ValueRow::toSlider(double value) const {
  const double v = std::clamp(value, range_.low, range_.high);
  const double fraction = range_.logarithmic
                              ? std::log(v / range_.low) / std::log(range_.high / range_.low)
                              : (v - range_.low) / (range_.high - range_.low);
  return static_cast<int>(std::lround(kSteps * fraction));
}

double ValueRow::fromSlider(int position) const {
  const double fraction = static_cast<double>(position) / kSteps;
  return range_.logarithmic ? range_.low * std::pow(range_.high / range_.low, fraction)
                            : range_.low + fraction * (range_.high - range_.low);
}

void ValueRow::setValue(double value) {
  const QSignalBlocker quiet_number(number_), quiet_slider(slider_);
  number_->setValue(value);
  slider_->setValue(toSlider(value));
}

void takeValueKeys(QWidget& panel, QWidget& view) {
  new ValueFocus(panel, view);
}

void takeAway(QWidget* rows) {
  if (rows == nullptr) return;
  rows->hide();
  rows->setParent(nullptr);
  rows->deleteLater();
}

} // namespace patina
