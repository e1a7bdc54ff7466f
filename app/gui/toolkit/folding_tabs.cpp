#include "app/gui/toolkit/folding_tabs.h"

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/theme.h"

namespace patina {
namespace {
constexpr int kMinSideWidth = 300, kMaxSideWidth = 480; // Width of the side panel [px].
}

FoldingTabs::FoldingTabs(Folds folds, QWidget* body, QWidget* parent)
    : QWidget(parent), folds_(folds), strip_(new QWidget(this)),
      row_(new QBoxLayout(QBoxLayout::LeftToRight, strip_)), buttons_(new QButtonGroup(this)),
      body_(body) {
  setAttribute(Qt::WA_StyledBackground);
  applyStyleSheet(
      *strip_,
      QStringLiteral(
          "QToolButton { padding: 3px 4px; border: none; border-bottom: 2px solid transparent; }"
          "QToolButton:hover { background: @hover; }"
          "QToolButton:checked { border-bottom-color: @accent; color: @link; }"));
  row_->setContentsMargins(2, 0, 2, 0);
  row_->setSpacing(0);
  auto* all = layoutIn<QVBoxLayout>(this, 0);
  all->addWidget(strip_);
  all->addWidget(body_, 1);
  connect(buttons_, &QButtonGroup::idClicked, this, &FoldingTabs::click);
  buttons_->setExclusive(false);
}

void FoldingTabs::add(int id, const QString& name, const QIcon& icon, const QString& words,
                      const QString& tip) {
  auto* button = new QToolButton(strip_);
  button->setObjectName(name);
  button->setIcon(icon);
  button->setIconSize({20, 20});
  button->setText(words);
  button->setToolTip(QStringLiteral("<b>%1</b><br>%2").arg(words, tip));
  button->setCheckable(true);
  button->setFocusPolicy(Qt::TabFocus);
  buttons_->addButton(button, id);
  row_->insertWidget(buttons_->buttons().size() - 1, button);
  if (buttons_->buttons().size() == 1) row_->addStretch(1);
}

void FoldingTabs::click(int id) {
  if (!folded_ && id == in_front_) {
    emit foldRequested(true);
  } else {
    in_front_ = id;
    if (folded_) emit foldRequested(false);
    emit chosen(id);
  }
  arrange();
}

void FoldingTabs::arrange() {
  const bool icons = folds_ == Folds::aside && folded_;
  for (QAbstractButton* button : buttons_->buttons()) {
    button->setChecked(!folded_ && buttons_->id(button) == in_front_);
    qobject_cast<QToolButton*>(button)->setToolButtonStyle(icons ? Qt::ToolButtonIconOnly
                                                                 : Qt::ToolButtonTextOnly);
  }
  row_->setDirection(icons ? QBoxLayout::TopToBottom : QBoxLayout::LeftToRight);
  body_->setVisible(!folded_);
  auto* all = static_cast<QVBoxLayout*>(layout());
  all->setStretch(0, icons ? 1 : 0);
  if (folds_ == Folds::aside) {
    setMinimumWidth(icons ? 0 : kMinSideWidth);
    setMaximumWidth(icons ? strip_->sizeHint().width() : kMaxSideWidth);
  } else {
    setMaximumHeight(folded_ ? strip_->sizeHint().height() : QWIDGETSIZE_MAX);
  }
}

} // namespace patina
