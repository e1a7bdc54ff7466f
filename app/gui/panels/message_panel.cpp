#include "app/gui/panels/message_panel.h"

#include <QDesktopServices>
#include <QHBoxLayout>
#include <QTime>
#include <QUrl>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/theme.h"

namespace patina {
namespace {
constexpr int kShownFor = 8000; // [ms]
constexpr int kFileRole = Qt::UserRole + 1;

void openFile(const QString& file) {
  if (!file.isEmpty()) QDesktopServices::openUrl(QUrl::fromLocalFile(file));
}
} // namespace

MessagePanel::MessagePanel(QWidget* parent) : QListWidget(parent) {
  setFocusPolicy(Qt::NoFocus); // The view gets the keys.
  setWordWrap(true);
  setSelectionMode(QAbstractItemView::NoSelection);
  dressPage(this, "messages", tr("All messages since the start"));
  connect(this, &QListWidget::itemClicked, this,
          [](const QListWidgetItem* item) { openFile(item->data(kFileRole).toString()); });
}

void MessagePanel::add(const Message& message) {
  auto* item = new QListWidgetItem(
      QTime::currentTime().toString(QStringLiteral("hh:mm  ")) + message.words, this);
  item->setData(Qt::UserRole, message.warns);
  if (!message.file.isEmpty()) {
    item->setData(kFileRole, message.file);
    item->setToolTip(tr("Opens %1").arg(message.file));
    QFont font = item->font();
    font.setUnderline(true);
    item->setFont(font);
  }
  if (message.warns) item->setForeground(themeColor("warn"));
  scrollToBottom();
}

void MessagePanel::changeEvent(QEvent* event) {
  QListWidget::changeEvent(event);
  if (event->type() != QEvent::PaletteChange) return;
  for (int i = 0; i < count(); ++i)
    if (item(i)->data(Qt::UserRole).toBool()) item(i)->setForeground(themeColor("warn"));
}

NoticeLine::NoticeLine(QWidget* parent) : QWidget(parent), words_(new ElidedLabel(this)) {
  auto* line = new QHBoxLayout(this);
  line->setContentsMargins(6, 0, 0, 0);
  line->setSpacing(2);
  line->addWidget(named(words_, "notice"), 1);
  open_ =
      addButton<QToolButton>(line, "open_saved", tr("Open"), tr("Opens the file"), this, [this] {
        hide();
        act_();
      });
  auto* away = addButton<QToolButton>(line, "dismiss", QStringLiteral("✕"),
                                      tr("Hides this line; the message stays under Messages"), this,
                                      &QWidget::hide);
  away->setAutoRaise(true);
  delay_.setSingleShot(true);
  delay_.setInterval(kShownFor);
  connect(&delay_, &QTimer::timeout, this, &QWidget::hide);
  hide();
}

void NoticeLine::show(const Message& message) {
  applyStyleSheet(*words_, message.warns ? QStringLiteral("color: @warn;")
                                         : QStringLiteral("color: @text;"));
  words_->setText(message.words);
  const bool opens = message.action.words.isEmpty();
  act_ = opens ? [file = message.file] { openFile(file); } : message.action.act;
  open_->setText(opens ? tr("Open") : message.action.words);
  open_->setToolTip(opens ? tr("Opens the file") : tr("Does what the message proposes"));
  open_->setVisible(!opens || !message.file.isEmpty());
  message.warns ? delay_.stop() : delay_.start();
  setVisible(true);
}

} // namespace patina
