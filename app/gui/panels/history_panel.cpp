#include "app/gui/panels/history_panel.h"

#include "app/gui/panels/history_words.h"
#include "app/gui/window/theme.h"

namespace patina {

HistoryPanel::HistoryPanel(QWidget* parent) : QListWidget(parent) {
  setObjectName(QStringLiteral("history"));
  setUniformItemSizes(true);
  setToolTip(tr("Every edit, the oldest first; a click goes there"));
  setFocusPolicy(Qt::NoFocus); // keys are the view's
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setTextElideMode(Qt::ElideRight);
  dress(*this, QStringLiteral("QListWidget { border: none; background: @card; }"
                              "QListWidget::item { padding: 2px 6px; border: none; }"
                              "QListWidget::item:selected { background: @chosen;"
                              " color: @text; }"));
  connect(this, &QListWidget::itemClicked, this,
          [this](QListWidgetItem* item) { emit asked(static_cast<std::size_t>(row(item))); });
}

void HistoryPanel::show(const EditStatus& status) {
  // Painting appends: a history of thousands is not made anew for each stroke.
  std::size_t kept = 0;
  while (kept < edits_.size() && kept < status.edits.size() && edits_[kept] == status.edits[kept])
    ++kept;
  if (count() == 0) addItem(tr("As it was opened"));
  while (count() > static_cast<int>(kept) + 1) delete takeItem(count() - 1);
  for (std::size_t i = kept; i < status.edits.size(); ++i) addItem(wordsOfEdit(status.edits[i]));
  edits_ = status.edits;
  done_ = status.done;
  mark();
  setCurrentRow(static_cast<int>(status.done));
  scrollToItem(currentItem());
}

void HistoryPanel::changeEvent(QEvent* event) {
  QListWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange) mark();
}

void HistoryPanel::mark() {
  for (int i = 0; i < count(); ++i) {
    const bool done = i <= static_cast<int>(done_);
    QFont font = this->font();
    font.setItalic(!done);
    item(i)->setFont(font);
    item(i)->setForeground(done ? ink("text") : ink("faint"));
    item(i)->setToolTip(done ? item(i)->text() : tr("%1 (undone)").arg(item(i)->text()));
  }
}

} // namespace patina
