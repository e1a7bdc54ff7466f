#include "app/gui/toolkit/card.h"

#include <algorithm>
#include <utility>

#include <QFileInfo>
#include <QSettings>
#include <QVBoxLayout>

#include "app/gui/toolkit/elided_label.h"
#include "app/gui/toolkit/theme.h"

namespace patina {

QLabel* quietLabel(const QString& words) {
  auto* label = new QLabel(words);
  label->setProperty("quiet", true);
  return label;
}

QLabel* addNote(QLayout* layout, const char* name, const char* kind) {
  auto* note = named(new QLabel, name);
  note->setWordWrap(true);
  if (*kind != '\0') note->setProperty(kind, true);
  note->hide();
  layout->addWidget(note);
  return note;
}

void say(QLabel* note, const QString& words) {
  note->setText(words);
  note->setVisible(!words.isEmpty());
}

void dressPage(QListWidget* list, const char* name, const QString& tip) {
  named(list, name, tip);
  list->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list->setTextElideMode(Qt::ElideRight);
  applyStyleSheet(
      *list, QStringLiteral("QListWidget { border: none; background: @card; }"
                            "QListWidget::item { padding: 2px 6px; border: none; }"
                            "QListWidget::item:selected { background: @chosen; color: @text; }"));
}

QListWidget* addList(QLayout* layout, const char* name, const QString& tip) {
  auto* list = named(new QListWidget, name, tip);
  applyStyleSheet(*list, QStringLiteral("QListWidget { border: 1px solid @line; }"));
  list->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list->setTextElideMode(Qt::ElideRight);
  layout->addWidget(list);
  return list;
}

void fillList(QListWidget* list, const QStringList& lines) {
  list->clear();
  for (const QString& line : lines) (new QListWidgetItem(line, list))->setToolTip(line);
  list->setFixedHeight(std::clamp(list->count(), 1, 5) * std::max(18, list->sizeHintForRow(0)) + 4);
}

QWidget* emptyPage(QLabel* words, QPushButton* button) {
  auto* page = new QWidget;
  auto* column = new QVBoxLayout(page);
  words->setWordWrap(true);
  words->setAlignment(Qt::AlignCenter);
  column->addStretch(1);
  column->addWidget(words);
  if (button != nullptr) column->addWidget(button, 0, Qt::AlignCenter);
  column->addStretch(1);
  return page;
}

FactTable::FactTable(QWidget* parent) : QWidget(parent), grid_(layoutIn<QGridLayout>(this, 3)) {
  grid_->setHorizontalSpacing(10);
  grid_->setColumnStretch(1, 1);
}

void FactTable::row(const QString& caption, const QString& value, const QString& tip, bool bad) {
  const int line = grid_->rowCount();
  QLabel *left = quietLabel(caption), *right = new ElidedLabel;
  right->setText(value);
  right->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  right->setProperty("bad", bad);
  for (QLabel* label : {left, right}) label->setToolTip(tip);
  grid_->addWidget(left, line, 0);
  grid_->addWidget(right, line, 1);
}

void FactTable::heading(const QString& words) {
  auto* label = new ElidedLabel;
  label->setText(words);
  QFont bold = font();
  bold.setBold(true);
  label->setFont(bold);
  label->setContentsMargins(0, grid_->count() > 0 ? 6 : 0, 0, 0);
  grid_->addWidget(label, grid_->rowCount(), 0, 1, 2);
}

QString lastFolder() {
  return QSettings().value(QStringLiteral("last_folder")).toString();
}

void rememberFolder(const QString& path) {
  QSettings().setValue(QStringLiteral("last_folder"), QFileInfo(path).absolutePath());
}

void beginInLastFolder(QFileDialog& dialog) {
  if (QFileInfo(lastFolder()).isDir()) dialog.setDirectory(lastFolder());
  QObject::connect(&dialog, &QFileDialog::accepted, &dialog, [&dialog] {
    if (!dialog.selectedFiles().isEmpty()) rememberFolder(dialog.selectedFiles().front());
  });
}

void askForPath(QWidget* window, const QString& title, QFileDialog::FileMode mode,
                const QString& filter, std::function<void(const QString&)> then) {
  auto* dialog = new QFileDialog(window, title, {}, filter);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(mode);
  beginInLastFolder(*dialog);
  dialog->setOption(QFileDialog::ShowDirsOnly, mode == QFileDialog::Directory);
  // Queued, because a question may follow and the dialog must be closed by then.
  QObject::connect(dialog, &QFileDialog::fileSelected, window, std::move(then),
                   Qt::QueuedConnection);
  dialog->open();
}

QFileDialog* saveDialog(QWidget* window, const QString& title, const QString& filter,
                        const QString& name, std::function<void(const QString&)> then) {
  auto* dialog = new QFileDialog(window, title, {}, filter);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  beginInLastFolder(*dialog);
  dialog->setDefaultSuffix(QFileInfo(name).suffix());
  dialog->selectFile(name);
  QObject::connect(dialog, &QFileDialog::fileSelected, window, std::move(then));
  return dialog;
}

} // namespace patina
