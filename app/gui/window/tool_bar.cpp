#include "app/gui/window/tool_bar.h"

namespace patina {
namespace {

// Seldom needed: in a small menu.
bool isMore(const ToolChoice& choice) {
  return choice.handling == Handling::paint &&
         (choice.tool == Tool::damping || choice.tool == Tool::roughness);
}

// Both frictions are one tool whose brush says which.
ToolChoice shownAs(ToolChoice choice) {
  if (choice.handling == Handling::paint && choice.tool == Tool::dynamic_friction)
    choice.tool = Tool::static_friction;
  return choice;
}

bool paints(const ToolChoice& choice) {
  return choice.handling == Handling::paint || choice.handling == Handling::pick;
}

} // namespace

ToolBar::ToolBar(QWidget* parent)
    : QToolBar(tr("Tools"), parent), group_(new QActionGroup(this)), more_(new QToolButton(this)) {
  setObjectName(QStringLiteral("brush_tools"));
  setMovable(false);
  setOrientation(Qt::Vertical);
  setIconSize({20, 20});
  setToolButtonStyle(Qt::ToolButtonIconOnly);
  setStyleSheet(QStringLiteral(
      "QToolBar { border: none; border-right: 1px solid #d5dae2; padding: 6px 3px; spacing: 2px; }"
      "QToolButton { padding: 5px; border: 1px solid transparent; border-radius: 4px; }"
      "QToolButton:hover { background: #e0e6ee; }"
      "QToolButton:checked { background: #cfe0f3; border-color: #2b6cb0; }"
      "QToolButton::menu-indicator { subcontrol-position: bottom right; }"));
  auto* menu = new QMenu(more_);
  bool has_more = false;
  for (const ToolCard& card : toolCards()) {
    QAction* action = group_->addAction(iconOf(card.choice), card.words);
    action->setObjectName(QString::fromUtf8(card.name));
    action->setCheckable(true);
    action->setShortcut(card.key);
    action->setToolTip(
        QStringLiteral("<b>%1</b> (%2)<br>%3")
            .arg(card.words, QKeySequence(card.key).toString(QKeySequence::NativeText), card.tip));
    const ToolChoice choice = card.choice;
    connect(action, &QAction::triggered, this, [this, choice] { choose(choice); });
    if (!isMore(choice)) {
      if (choice.handling == Handling::pick ||
          (choice.handling == Handling::paint && choice.tool == Tool::color))
        addSeparator();
      addAction(action);
      continue;
    }
    menu->addAction(action);
    if (!has_more) {
      more_->setObjectName(QStringLiteral("more_tools"));
      more_->setMenu(menu);
      more_->setPopupMode(QToolButton::InstantPopup);
      more_->setDefaultAction(action);
      addWidget(more_);
      has_more = true;
    }
  }
  actionOf(choice_)->setChecked(true);
  setPaints(false);
}

QAction* ToolBar::actionOf(const ToolChoice& choice) const {
  const ToolChoice shown = shownAs(choice);
  for (int i = 0; i < group_->actions().size(); ++i)
    if (toolCards()[static_cast<std::size_t>(i)].choice == shown) return group_->actions()[i];
  return group_->actions().front();
}

void ToolBar::choose(const ToolChoice& choice) {
  QAction* action = actionOf(choice);
  if (!action->isEnabled()) return;
  action->setChecked(true);
  if (isMore(choice)) more_->setDefaultAction(action);
  if (choice == choice_) return;
  choice_ = choice;
  emit chosen(choice_);
}

void ToolBar::setPaints(bool can) {
  for (int i = 0; i < group_->actions().size(); ++i)
    if (paints(toolCards()[static_cast<std::size_t>(i)].choice))
      group_->actions()[i]->setEnabled(can);
  more_->setEnabled(can);
}

} // namespace patina
