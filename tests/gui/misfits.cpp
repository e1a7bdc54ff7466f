#include "gui/misfits.h"

#include <QAbstractButton>
#include <QAbstractSpinBox>
#include <QComboBox>
#include <QGroupBox>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QScrollArea>
#include <QScrollBar>
#include <QSlider>
#include <QSplitterHandle>
#include <QStyle>
#include <QStyleOptionComboBox>
#include <QToolBar>

#include "app/gui/toolkit/elided_label.h"
#include "app/gui/toolkit/strip_plot.h"

namespace patina::test {
namespace {

QString nameOf(const QWidget& widget) {
  QString name = QString::fromUtf8(widget.metaObject()->className());
  if (!widget.objectName().isEmpty()) name += ' ' + widget.objectName();
  if (const auto* label = qobject_cast<const QLabel*>(&widget)) name += " '" + label->text() + "'";
  if (const auto* button = qobject_cast<const QAbstractButton*>(&widget))
    name += " '" + button->text() + "'";
  return name;
}

int widthOf(const QWidget& widget, const QString& text) {
  return widget.fontMetrics().horizontalAdvance(text);
}

// Widgets that draw more than their text, and the room for the rest.
bool cutsText(const QWidget& widget) {
  if (const auto* number = qobject_cast<const QAbstractSpinBox*>(&widget)) {
    const auto* line = number->findChild<const QLineEdit*>();
    return widthOf(*line, line->text()) + 2 > line->width();
  }
  if (const auto* choice = qobject_cast<const QComboBox*>(&widget)) {
    QStyleOptionComboBox option;
    option.initFrom(choice);
    const QRect room = choice->style()->subControlRect(QStyle::CC_ComboBox, &option,
                                                       QStyle::SC_ComboBoxEditField, choice);
    return widthOf(*choice, choice->currentText()) > room.width();
  }
  const auto* label = qobject_cast<const QLabel*>(&widget);
  if (label != nullptr && label->wordWrap()) {
    // A word wider than the label is cut, too.
    return label->heightForWidth(label->width()) > label->height() ||
           label->minimumSizeHint().width() > label->width();
  }
  if (dynamic_cast<const ElidedLabel*>(&widget) != nullptr) return false; // its tooltip has it
  if (label != nullptr || qobject_cast<const QAbstractButton*>(&widget) != nullptr ||
      qobject_cast<const StripPlot*>(&widget) != nullptr) {
    const bool fixed = widget.minimumSize() == widget.maximumSize(); // a swatch, a cross
    const QSize least = widget.minimumSizeHint();
    return !fixed && (least.width() > widget.width() || least.height() > widget.height());
  }
  if (const auto* card = qobject_cast<const QGroupBox*>(&widget))
    return widthOf(*card, card->title()) > card->width();
  return false;
}

void checkItems(const QListWidget& list, QStringList& found) {
  for (int i = 0; i < list.count(); ++i) {
    const QListWidgetItem& item = *list.item(i);
    const bool cut = !list.wordWrap() && widthOf(list, item.text()) + 12 > list.viewport()->width();
    if (cut && item.toolTip().isEmpty()) found << nameOf(list) + " cuts '" + item.text() + "'";
  }
}

// Containers that check their own content.
bool holdsItsOwn(const QWidget& widget) {
  return qobject_cast<const QAbstractSpinBox*>(&widget) != nullptr ||
         qobject_cast<const QComboBox*>(&widget) != nullptr ||
         qobject_cast<const QAbstractItemView*>(&widget) != nullptr ||
         widget.inherits("QVTKOpenGLNativeWidget");
}

QList<const QWidget*> childrenOf(const QWidget& widget) {
  QList<const QWidget*> children;
  for (const QObject* object : widget.children()) {
    const auto* child = qobject_cast<const QWidget*>(object);
    if (child != nullptr && !child->isWindow() && child->isVisible() &&
        qobject_cast<const QSplitterHandle*>(child) == nullptr)
      children << child;
  }
  return children;
}

void walk(const QWidget& widget, QStringList& found) {
  if (cutsText(widget))
    found << QStringLiteral("%1 has %2x%3 and needs %4x%5")
                 .arg(nameOf(widget))
                 .arg(widget.width())
                 .arg(widget.height())
                 .arg(widget.minimumSizeHint().width())
                 .arg(widget.minimumSizeHint().height());
  if (widget.inherits("QToolBarExtension")) found << QStringLiteral("a tool bar hides its end");
  if (const auto* list = qobject_cast<const QListWidget*>(&widget)) checkItems(*list, found);
  if (holdsItsOwn(widget)) return;
  if (const auto* scroll = qobject_cast<const QScrollArea*>(&widget)) {
    if (scroll->widget()->width() > scroll->viewport()->width())
      found << nameOf(*scroll->widget()) + " is wider than what it scrolls in";
    return walk(*scroll->widget(), found);
  }
  const QList<const QWidget*> children = childrenOf(widget);
  for (int i = 0; i < children.size(); ++i) {
    const QWidget& child = *children[i];
    if (!widget.rect().contains(child.geometry()))
      found << nameOf(child) + " reaches beyond " + nameOf(widget);
    for (int k = 0; k < i; ++k)
      if (child.geometry().intersects(children[k]->geometry()))
        found << nameOf(child) + " lies over " + nameOf(*children[k]);
    walk(child, found);
  }
}

bool isControl(const QWidget& widget) {
  return qobject_cast<const QAbstractButton*>(&widget) != nullptr ||
         qobject_cast<const QAbstractSpinBox*>(&widget) != nullptr ||
         qobject_cast<const QSlider*>(&widget) != nullptr ||
         qobject_cast<const QComboBox*>(&widget) != nullptr ||
         qobject_cast<const QAbstractItemView*>(&widget) != nullptr ||
         qobject_cast<const StripPlot*>(&widget) != nullptr;
}

} // namespace

QStringList misfits(const QWidget& window) {
  QStringList found;
  walk(window, found);
  return found;
}

QStringList muteControls(const QWidget& window) {
  QStringList found;
  for (const QWidget* widget : window.findChildren<QWidget*>()) {
    if (!widget->isVisible() || widget->window() != &window || !isControl(*widget)) continue;
    if (qobject_cast<const QScrollBar*>(widget) != nullptr) continue;
    const QWidget* says = widget;
    while (says != nullptr && says->toolTip().isEmpty() &&
           qobject_cast<const QGroupBox*>(says) == nullptr && !says->isWindow())
      says = says->parentWidget();
    if (says == nullptr || says->toolTip().isEmpty()) found << nameOf(*widget);
  }
  return found;
}

} // namespace patina::test
