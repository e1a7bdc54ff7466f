#include "app/gui/panels/history_panel.h"

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/history_words.h"
#include "app/gui/toolkit/theme.h"

namespace patina {

HistoryPanel::HistoryPanel(QWidget* parent) : QListWidget(parent) {
  setUniformItemSizes(true);
  setFocusPolicy(Qt::NoFocus); // The view gets the keys.
  dressPage(this, "history", tr("Every edit, the oldest first; a click goes there"));
  connect(this, &QListWidget::itemClicked, this, [this](QListWidgetItem* item) {
    emit positionRequested(static_cast<std::size_t>(row(item)));
  });
}

void HistoryPanel::show(const EditStatus& status) {
  // Painting appends, so only the new end of the list is built.
  std::size_t unchanged = 0;
  while (unchanged < edits_.size() && unchanged < status.edits.size() &&
         edits_[unchanged] == status.edits[unchanged])
    ++unchanged;
  if (count() == 0) addItem(tr("As it was opened"));
  while (count() > static_cast<int>(unchanged) + 1) delete takeItem(count() - 1);
  for (std::size_t i = unchanged; i < status.edits.size(); ++i)
    addItem(wordsOfEdit(status.edits[i]));
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
    item(i)->setForeground(done ? themeColor("text") : themeColor("faint"));
    item(i)->setToolTip(done ? item(i)->text() : tr("%1 (undone)").arg(item(i)->text()));
  }
}

} // namespace patina
