#include "app/gui/window/action_search.h"

#include <algorithm>
#include <utility>

#include <QAbstractButton>
#include <QAbstractSpinBox>
#include <QAction>
#include <QComboBox>
#include <QGroupBox>
#include <QKeyEvent>
#include <QMenuBar>
#include <QPointer>
#include <QScrollArea>
#include <QTextDocumentFragment>
#include <QVBoxLayout>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/words.h"

namespace patina {
namespace {

// Name of a setting: the words on it, or the first ones of its tooltip.
QString nameOf(const QWidget& widget) {
  if (const auto* button = qobject_cast<const QAbstractButton*>(&widget);
      button != nullptr && button->text().size() > 1)
    return button->text();
  if (!widget.accessibleName().isEmpty()) return widget.accessibleName();
  return QTextDocumentFragment::fromHtml(widget.toolTip())
      .toPlainText()
      .section(QRegExp("[;\n]"), 0, 0);
}

bool isSetting(const QWidget& widget) {
  return qobject_cast<const QAbstractButton*>(&widget) != nullptr ||
         qobject_cast<const QAbstractSpinBox*>(&widget) != nullptr ||
         qobject_cast<const QComboBox*>(&widget) != nullptr ||
         qobject_cast<const QLineEdit*>(&widget) != nullptr;
}

void reveal(QWidget& widget) {
  for (QWidget* up = &widget; up != nullptr; up = up->parentWidget())
    if (auto* area = qobject_cast<QScrollArea*>(up)) area->ensureWidgetVisible(&widget);
  widget.setFocus(Qt::TabFocusReason);
}

} // namespace

QString withoutMarks(QString words) {
  return words.remove('&').remove(QStringLiteral("…"));
}

ActionSearch::ActionSearch(QMainWindow& window, const std::vector<Settings>& panels,
                           const std::function<void(Panel)>& show)
    : QDialog(&window), line_(named(new QLineEdit(this), "action_words")),
      list_(named(new QListWidget(this), "action_list")) {
  setObjectName(QStringLiteral("action_search"));
  setWindowTitle(tr("Search actions"));
  setAttribute(Qt::WA_DeleteOnClose);
  resize(520, 360);
  for (QAction* entry : window.menuBar()->actions())
    if (entry->menu()) collect(*entry->menu(), withoutMarks(entry->text()));
  for (const Settings& settings : panels) collect(settings, show);
  line_->setPlaceholderText(tr("Search the actions and settings"));
  list_->setFocusPolicy(Qt::NoFocus);
  auto* column = new QVBoxLayout(this);
  column->addWidget(line_);
  column->addWidget(list_);
  connect(line_, &QLineEdit::textChanged, this, &ActionSearch::find);
  connect(line_, &QLineEdit::returnPressed, this, &ActionSearch::act);
  connect(list_, &QListWidget::itemClicked, this, &ActionSearch::act);
  line_->installEventFilter(this);
  find({});
}

// Collects entries such as "File › Save workspace as".
void ActionSearch::collect(const QMenu& menu, const QString& above) {
  for (QAction* action : menu.actions()) {
    if (action->isSeparator() || !action->isVisible()) continue;
    const QString words = above + QStringLiteral(" › ") + withoutMarks(action->text());
    if (action->menu())
      collect(*action->menu(), words);
    else
      all_.push_back({words, action->shortcut().toString(QKeySequence::NativeText),
                      action->isEnabled(), [action] { action->trigger(); }});
  }
}

// Collects entries such as "Show › Slice" and "Surface › Stiffness".
void ActionSearch::collect(const Settings& settings, const std::function<void(Panel)>& show) {
  const auto* card = qobject_cast<const QGroupBox*>(settings.widget);
  if (card == nullptr) return;
  const auto add = [&](const QString& name, bool enabled, const std::function<void()>& then) {
    const QString words = card->title() + QStringLiteral(" › ") + withoutMarks(name);
    const auto known = [&](const Found& found) { return found.words == words; };
    if (name.isEmpty() || std::any_of(all_.begin(), all_.end(), known)) return;
    all_.push_back({words, {}, settings.is_there && enabled, [=, panel = settings.panel] {
                      show(panel);
                      then();
                    }});
  };
  for (QWidget* widget : settings.widget->findChildren<QWidget*>()) {
    if (auto* list = qobject_cast<QListWidget*>(widget))
      for (int row = 0; row < list->count(); ++row)
        if (list->item(row)->flags() & Qt::ItemIsUserCheckable)
          add(list->item(row)->text(), !list->item(row)->isHidden(), [=] {
            list->setCurrentRow(row);
            reveal(*list);
          });
    const QWidget* owner = widget->parentWidget();
    const bool is_part = qobject_cast<const QAbstractSpinBox*>(owner) != nullptr ||
                         qobject_cast<const QComboBox*>(owner) != nullptr;
    if (!isSetting(*widget) || is_part || !widget->isVisibleTo(settings.widget)) continue;
    add(nameOf(*widget), widget->isEnabledTo(settings.widget), [setting = QPointer(widget)] {
      if (setting) reveal(*setting);
    });
  }
}

void ActionSearch::find(const QString& typed) {
  list_->clear();
  const QStringList words = typed.split(' ', Qt::SkipEmptyParts);
  for (std::size_t i = 0; i < all_.size(); ++i) {
    const Found& found = all_[i];
    const auto holds = [&](const QString& word) {
      return found.words.contains(word, Qt::CaseInsensitive);
    };
    if (!std::all_of(words.begin(), words.end(), holds)) continue;
    auto* item = new QListWidgetItem(
        found.key.isEmpty() ? found.words : found.words + QStringLiteral("   ") + found.key, list_);
    item->setData(Qt::UserRole, static_cast<int>(i));
    if (!found.enabled) item->setFlags(Qt::NoItemFlags);
  }
  if (list_->count() == 0)
    (new QListWidgetItem(tr("Nothing is called “%1”").arg(typed.trimmed()), list_))
        ->setFlags(Qt::NoItemFlags);
  for (int row = 0; row < list_->count() && list_->currentRow() < 0; ++row)
    if (list_->item(row)->flags() & Qt::ItemIsEnabled) list_->setCurrentRow(row);
}

void ActionSearch::act() {
  const QListWidgetItem* item = list_->currentItem();
  if (!item || !(item->flags() & Qt::ItemIsEnabled)) return;
  const auto act = all_[static_cast<std::size_t>(item->data(Qt::UserRole).toInt())].act;
  accept();
  act();
}

bool ActionSearch::eventFilter(QObject*, QEvent* event) {
  if (event->type() != QEvent::KeyPress) return false;
  const int key = static_cast<QKeyEvent*>(event)->key();
  if (key != Qt::Key_Up && key != Qt::Key_Down) return false;
  const int row = list_->currentRow() + (key == Qt::Key_Down ? 1 : -1);
  list_->setCurrentRow(std::clamp(row, 0, std::max(0, list_->count() - 1)));
  return true;
}

} // namespace patina
