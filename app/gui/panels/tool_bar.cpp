#include "app/gui/panels/tool_bar.h"

#include <algorithm>

#include "app/gui/toolkit/theme.h"
#include "app/gui/toolkit/words.h"

namespace patina {
namespace {

// Channels of one tool share its button; the brush panel chooses between them.
ToolChoice shownAs(ToolChoice choice) {
  if (const auto channel = channelOf(choice.tool))
    choice.tool = Tool::material(firstOfTool(*channel));
  return choice;
}

const ToolCard& cardOf(const ToolChoice& choice) {
  const std::vector<ToolCard>& cards = toolCards();
  const ToolChoice shown = shownAs(choice);
  return *std::find_if(cards.begin(), cards.end(),
                       [&](const ToolCard& card) { return card.choice == shown; });
}

bool paints(const ToolChoice& choice) {
  return choice.handling == InteractionMode::paint || choice.handling == InteractionMode::pick;
}

} // namespace

ToolBar::ToolBar(QWidget* parent)
    : QToolBar(tr("Tools"), parent), group_(new QActionGroup(this)), more_(new QToolButton(this)) {
  setObjectName(QStringLiteral("brush_tools"));
  setMovable(false);
  setOrientation(Qt::Vertical);
  setIconSize({20, 20});
  setToolButtonStyle(Qt::ToolButtonIconOnly);
  applyStyleSheet(
      *this,
      QStringLiteral(
          "QToolBar { border: none; border-right: 1px solid @line; padding: 6px 3px; spacing: "
          "2px; }"
          "QToolButton { padding: 5px; border: 1px solid transparent; border-radius: 4px; }"
          "QToolButton:hover { background: @hover; }"
          "QToolButton:checked { background: @chosen; border-color: @accent; }"
          "QToolButton::menu-indicator { subcontrol-position: bottom right; }"));
  auto* menu = new QMenu(more_);
  for (const ToolCard& card : toolCards()) {
    QAction* action = group_->addAction(iconOf(card.choice), card.words);
    action->setObjectName(shownText(card.name));
    action->setCheckable(true);
    if (card.key != 0) action->setShortcut(card.key);
    action->setToolTip(card.tip);
    const ToolChoice choice = card.choice;
    connect(action, &QAction::triggered, this, [this, choice] { choose(choice); });
    if (card.in_overflow) menu->addAction(action);
  }
  more_->setObjectName(QStringLiteral("more_tools"));
  more_->setMenu(menu);
  more_->setPopupMode(QToolButton::InstantPopup);
  more_->setDefaultAction(menu->actions().front());
  more_action_ = addWidget(more_);
  setDesk(Desk::feel);
  actionOf(choice_)->setChecked(true);
}

void ToolBar::setDesk(Desk desk) {
  for (QAction* action : actions()) {
    removeAction(action);
    if (action->isSeparator()) delete action;
  }
  for (const ToolCard& card : toolCards()) {
    if (!hasTool(desk, card.choice)) continue;
    if (card.choice.handling == InteractionMode::pick ||
        card.choice == ToolChoice{InteractionMode::paint, {}})
      addSeparator();
    if (!card.in_overflow) addAction(actionOf(card.choice));
    if (card.in_overflow && !actions().contains(more_action_)) addAction(more_action_);
  }
}

QAction* ToolBar::actionOf(const ToolChoice& choice) const {
  return group_->actions()[static_cast<int>(&cardOf(choice) - toolCards().data())];
}

void ToolBar::choose(const ToolChoice& choice) {
  QAction* action = actionOf(choice);
  if (!action->isEnabled()) return;
  action->setChecked(true);
  if (cardOf(choice).in_overflow) more_->setDefaultAction(action);
  if (choice == choice_) return;
  choice_ = choice;
  emit chosen(choice_);
}

void ToolBar::toggleNavigation() {
  if (choice_.handling == InteractionMode::navigate) return choose(before_navigating_);
  before_navigating_ = choice_;
  choose({InteractionMode::navigate, {}});
}

void ToolBar::setPaints(bool can) {
  for (int i = 0; i < group_->actions().size(); ++i)
    if (paints(toolCards()[static_cast<std::size_t>(i)].choice))
      group_->actions()[i]->setEnabled(can);
  more_->setEnabled(can);
}

} // namespace patina
