#include "app/gui/window/action_search.h"

#include <algorithm>
#include <vector>

#include <QAction>
#include <QDialog>
#include <QKeyEvent>
#include <QLineEdit>
#include <QListWidget>
#include <QMenu>
#include <QMenuBar>
#include <QVBoxLayout>

namespace patina {
namespace {

constexpr int kWidth = 520, kHeight = 360; // [px]

struct Found {
  QString words;
  QAction* action;
};

QString plain(QString words) {
  return words.remove('&').remove(QStringLiteral("…"));
}

// "File › Save workspace as"
void collect(const QMenu& menu, const QString& above, std::vector<Found>& into) {
  for (QAction* action : menu.actions()) {
    if (action->isSeparator() || !action->isVisible()) continue;
    const QString words = above + QStringLiteral(" › ") + plain(action->text());
    if (action->menu())
      collect(*action->menu(), words, into);
    else
      into.push_back({words, action});
  }
}

class ActionSearch final : public QDialog {
 public:
  explicit ActionSearch(QMainWindow& window) : QDialog(&window) {
    setObjectName(QStringLiteral("action_search"));
    setWindowTitle(tr("Search actions"));
    setAttribute(Qt::WA_DeleteOnClose);
    resize(kWidth, kHeight);
    for (QAction* entry : window.menuBar()->actions())
      if (entry->menu()) collect(*entry->menu(), plain(entry->text()), all_);
    line_ = new QLineEdit(this);
    line_->setObjectName(QStringLiteral("action_words"));
    line_->setPlaceholderText(tr("A word of what you want to do"));
    list_ = new QListWidget(this);
    list_->setObjectName(QStringLiteral("action_list"));
    list_->setFocusPolicy(Qt::NoFocus);
    auto* column = new QVBoxLayout(this);
    column->addWidget(line_);
    column->addWidget(list_);
    connect(line_, &QLineEdit::textChanged, this, &ActionSearch::show);
    connect(line_, &QLineEdit::returnPressed, this, &ActionSearch::act);
    connect(list_, &QListWidget::itemClicked, this, &ActionSearch::act);
    line_->installEventFilter(this);
    show({});
  }

 protected:
  bool eventFilter(QObject*, QEvent* event) override {
    if (event->type() != QEvent::KeyPress) return false;
    const int key = static_cast<QKeyEvent*>(event)->key();
    if (key != Qt::Key_Up && key != Qt::Key_Down) return false;
    const int row = list_->currentRow() + (key == Qt::Key_Down ? 1 : -1);
    list_->setCurrentRow(std::clamp(row, 0, std::max(0, list_->count() - 1)));
    return true;
  }

 private:
  void show(const QString& typed) {
    list_->clear();
    const QStringList words = typed.split(' ', Qt::SkipEmptyParts);
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const auto holds = [&](const QString& word) {
        return all_[i].words.contains(word, Qt::CaseInsensitive);
      };
      if (!std::all_of(words.begin(), words.end(), holds)) continue;
      const QString key = all_[i].action->shortcut().toString(QKeySequence::NativeText);
      auto* item = new QListWidgetItem(
          key.isEmpty() ? all_[i].words : all_[i].words + QStringLiteral("   ") + key, list_);
      item->setData(Qt::UserRole, static_cast<int>(i));
      if (!all_[i].action->isEnabled()) item->setFlags(Qt::NoItemFlags);
    }
    for (int row = 0; row < list_->count() && list_->currentRow() < 0; ++row)
      if (list_->item(row)->flags() & Qt::ItemIsEnabled) list_->setCurrentRow(row);
  }

  void act() {
    const QListWidgetItem* item = list_->currentItem();
    if (!item || !(item->flags() & Qt::ItemIsEnabled)) return;
    QAction* action = all_[static_cast<std::size_t>(item->data(Qt::UserRole).toInt())].action;
    accept();
    action->trigger();
  }

  std::vector<Found> all_;
  QLineEdit* line_;
  QListWidget* list_;
};

} // namespace

void searchActions(QMainWindow& window) {
  (new ActionSearch(window))->open();
}

} // namespace patina
