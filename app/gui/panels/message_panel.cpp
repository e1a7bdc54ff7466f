#include "app/gui/panels/message_panel.h"

#include <QHBoxLayout>
#include <QTime>

#include "app/gui/window/theme.h"

namespace patina {
namespace {
constexpr int kShownFor = 8000; // [ms]
} // namespace

MessagePanel::MessagePanel(QWidget* parent) : QListWidget(parent) {
  setObjectName(QStringLiteral("messages"));
  setFocusPolicy(Qt::NoFocus); // keys are the view's
  setWordWrap(true);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setSelectionMode(QAbstractItemView::NoSelection);
  dress(*this, QStringLiteral("QListWidget { border: none; background: @card; }"
                              "QListWidget::item { padding: 2px 6px; border: none; }"));
  setToolTip(tr("What the window has said since it was opened"));
}

void MessagePanel::add(const Message& message) {
  auto* item = new QListWidgetItem(
      QTime::currentTime().toString(QStringLiteral("hh:mm  ")) + message.words, this);
  item->setData(Qt::UserRole, message.warns);
  if (message.warns) item->setForeground(ink("warn"));
  scrollToBottom();
}

void MessagePanel::changeEvent(QEvent* event) {
  QListWidget::changeEvent(event);
  if (event->type() != QEvent::PaletteChange) return;
  for (int i = 0; i < count(); ++i)
    if (item(i)->data(Qt::UserRole).toBool()) item(i)->setForeground(ink("warn"));
}

NoticeLine::NoticeLine(QWidget* parent) : QWidget(parent), words_(new ElidedLabel(this)) {
  auto* line = new QHBoxLayout(this);
  line->setContentsMargins(6, 0, 0, 0);
  line->setSpacing(2);
  words_->setObjectName(QStringLiteral("notice"));
  line->addWidget(words_, 1);
  auto* away = new QToolButton(this);
  away->setObjectName(QStringLiteral("dismiss"));
  away->setText(QStringLiteral("✕"));
  away->setAutoRaise(true);
  away->setToolTip(tr("Put this line away; it stays under Messages"));
  line->addWidget(away);
  connect(away, &QToolButton::clicked, this, &QWidget::hide);
  patience_.setSingleShot(true);
  patience_.setInterval(kShownFor);
  connect(&patience_, &QTimer::timeout, this, &QWidget::hide);
  hide();
}

void NoticeLine::show(const Message& message) {
  dress(*words_, message.warns ? QStringLiteral("color: @warn;") : QStringLiteral("color: @text;"));
  words_->setText(message.words);
  message.warns ? patience_.stop() : patience_.start();
  setVisible(true);
}

void NoticeLine::mousePressEvent(QMouseEvent*) {
  emit opened();
}

} // namespace patina
