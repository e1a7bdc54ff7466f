#include "app/gui/control/desk_controller.h"

namespace patina {

DeskController::DeskController(const Parts& parts, QObject* parent)
    : QObject(parent), at_(parts), group_(new QActionGroup(this)) {
  for (const DeskRow& row : deskRows()) {
    layouts_[row.desk] = usualLayout(row.desk);
    tools_[row.desk] = row.tool;
    QAction* action = group_->addAction(row.words);
    action->setObjectName(QStringLiteral("desk_") + QString::fromUtf8(row.name));
    action->setCheckable(true);
    action->setData(static_cast<int>(row.desk));
    action->setChecked(row.desk == desk_);
    action->setShortcut(Qt::CTRL | row.key);
    action->setToolTip(row.tip);
    connect(action, &QAction::triggered, this, [this, desk = row.desk] { choose(desk); });
  }
  at_.tools.setDesk(desk_);
  connect(&at_.tools, &ToolBar::chosen, this, &DeskController::takeTool);
  for (QSplitter* splitter : {&at_.across, &at_.down})
    connect(splitter, &QSplitter::splitterMoved, this, &DeskController::takeSizes);
  connect(&at_.column, &FoldingTabs::foldAsked, this, &DeskController::foldColumn);
  connect(&at_.drawer, &FoldingTabs::foldAsked, this, &DeskController::foldDrawer);
  connect(&at_.column, &FoldingTabs::chosen, this, [this](int tab) {
    layouts_[desk_].tab = static_cast<Tab>(tab);
    emit changed();
  });
  connect(&at_.drawer, &FoldingTabs::chosen, this, [this](int page) {
    layouts_[desk_].page = static_cast<Panel>(page);
    emit changed();
  });
}

void DeskController::choose(Desk desk) {
  for (QAction* action : group_->actions())
    if (action->data().toInt() == static_cast<int>(desk)) action->setChecked(true);
  if (desk == desk_) return;
  desk_ = desk;
  at_.tools.setDesk(desk);
  at_.tools.choose(tools_[desk]);
  arrange();
  emit changed();
}

void DeskController::takeTool(const ToolChoice& tool) {
  tools_[deskFor(tool, desk_)] = tool;
  choose(deskFor(tool, desk_));
}

void DeskController::open(Panel panel) {
  if (const auto tab = tabOf(panel)) {
    layouts_[desk_].tab = *tab;
    foldColumn(false);
  } else {
    layouts_[desk_].page = panel;
    foldDrawer(false);
  }
}

void DeskController::foldColumn(bool folded) {
  if (!narrow_)
    layouts_[desk_].column_folded = folded;
  else if (folded)
    opened_.erase(desk_);
  else
    opened_.insert(desk_);
  arrange();
  emit changed();
}

void DeskController::foldDrawer(bool folded) {
  layouts_[desk_].drawer_folded = folded;
  arrange();
  emit changed();
}

void DeskController::setNarrow(bool narrow) {
  if (narrow == narrow_) return;
  narrow_ = narrow;
  opened_ = {Desk::texture}; // whose steps begin and go on by buttons there
  arrange();
}

void DeskController::arrange() {
  const DeskLayout& layout = layouts_[desk_];
  at_.column.setFolded(narrow_ ? !opened_.contains(desk_) : layout.column_folded);
  at_.drawer.setFolded(layout.drawer_folded);
  at_.down.handle(1)->setEnabled(!at_.drawer.folded()); // it has one height then
  const int wide = at_.column.folded() ? at_.column.maximumWidth() : layout.column;
  const int high = at_.drawer.folded() ? at_.drawer.maximumHeight() : layout.drawer;
  at_.across.setSizes({at_.across.width() - at_.across.handleWidth() - wide, wide});
  at_.down.setSizes({at_.down.height() - at_.down.handleWidth() - high, high});
}

void DeskController::takeSizes() {
  DeskLayout& layout = layouts_[desk_];
  // Hidden ones have a width that nobody gave them.
  if (at_.column.isVisible() && !at_.column.folded()) layout.column = at_.column.width();
  if (at_.drawer.isVisible() && !at_.drawer.folded()) layout.drawer = at_.drawer.height();
}

void DeskController::restore() {
  keeps_ = true;
  for (auto& [desk, layout] : layouts_) layout = rememberedLayout(desk);
  choose(rememberedPlace().desk);
  arrange();
  emit changed();
}

void DeskController::remember(const QWidget& window) const {
  if (!keeps_) return;
  const bool maximized = window.isMaximized();
  patina::remember(
      WindowPlace{maximized ? window.normalGeometry().size() : window.size(), maximized, desk_});
  for (const auto& [desk, layout] : layouts_) patina::remember(desk, layout);
}

} // namespace patina
