#include "app/gui/toolkit/elided_label.h"

#include <QHelpEvent>
#include <QPainter>
#include <QStyle>
#include <QToolTip>

namespace patina {

ElidedLabel::ElidedLabel(QWidget* parent) : QLabel(parent) {
  setTextFormat(Qt::PlainText);
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Preferred);
}

QSize ElidedLabel::minimumSizeHint() const {
  return {3 * fontMetrics().horizontalAdvance(QLatin1Char('m')),
          QLabel::minimumSizeHint().height()};
}

void ElidedLabel::paintEvent(QPaintEvent* event) {
  if (!elides()) return QLabel::paintEvent(event);
  QPainter painter(this);
  drawFrame(&painter);
  const QString shown = fontMetrics().elidedText(text(), Qt::ElideRight, contentsRect().width());
  style()->drawItemText(&painter, contentsRect(), static_cast<int>(alignment()), palette(),
                        isEnabled(), shown, foregroundRole());
}

bool ElidedLabel::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip || !elides()) return QLabel::event(event);
  const QString more = toolTip().isEmpty() ? QString() : QStringLiteral("<br>") + toolTip();
  QToolTip::showText(static_cast<QHelpEvent*>(event)->globalPos(),
                     QStringLiteral("<p>%1</p>%2").arg(text().toHtmlEscaped(), more), this);
  return true;
}

} // namespace patina
