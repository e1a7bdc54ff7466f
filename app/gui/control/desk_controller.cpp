#include "app/gui/control/desk_controller.h"

#include <algorithm>

#include <QSettings>

namespace patina {
namespace {

QString keyOf(Desk desk, const char* what) {
  return QStringLiteral("desks/%1/%2").arg(QString::fromUtf8(rowOf(desk).name), what);
}

// Settings of another version of the program may be out of range.
template <typename Value> Value read(const QString& key, Value usual, int low, int high) {
  bool is_number = false;
  const int kept = QSettings().value(key).toInt(&is_number);
  return is_number && kept >= low && kept <= high ? static_cast<Value>(kept) : usual;
}

// Calls visit(name, value, smallest, largest) for each stored value.
template <typename Layout, typename Visit> void forEachValue(Layout& layout, const Visit& visit) {
  visit("tab", layout.tab, 0, static_cast<int>(tabRows().size()) - 1);
  visit("page", layout.page, static_cast<int>(Panel::forces),
        static_cast<int>(Panel::cost_profile));
  visit("column", layout.side_panel, 300, 480);
  visit("drawer", layout.bottom_panel, 60, 4000);
  visit("column_folded", layout.side_panel_folded, 0, 1);
  visit("drawer_folded", layout.bottom_panel_folded, 0, 1);
}

} // namespace

DeskLayout usualLayout(Desk desk) {
  const DeskRow& row = rowOf(desk);
  return {row.tab, row.page, 300, row.bottom_panel, false, !row.bottom_panel_open};
}

DeskLayout rememberedLayout(Desk desk) {
  DeskLayout layout = usualLayout(desk);
  forEachValue(layout, [desk](const char* what, auto& value, int low, int high) {
    value = read(keyOf(desk, what), value, low, high);
  });
  return layout;
}

void remember(Desk desk, const DeskLayout& layout) {
  QSettings settings;
  forEachValue(layout, [&](const char* what, const auto& value, int, int) {
    settings.setValue(keyOf(desk, what), static_cast<int>(value));
  });
}

WindowGeometry rememberedPlace() {
  WindowGeometry place;
  const QSize size = QSettings().value(QStringLiteral("window/size")).toSize();
  if (size.isValid()) place.size = size.expandedTo({640, 480});
  place.maximized = QSettings().value(QStringLiteral("window/maximized")).toBool();
  const Desk desk =
      read(QStringLiteral("window/desk"), place.desk, 0, static_cast<int>(Desk::align));
  place.desk = desk;
  return place;
}

void remember(const WindowGeometry& place) {
  QSettings settings;
  settings.setValue(QStringLiteral("window/size"), place.size);
  settings.setValue(QStringLiteral("window/maximized"), place.maximized);
  settings.setValue(QStringLiteral("window/desk"), static_cast<int>(place.desk));
}

DeskController::DeskController(const Parts& parts, QObject* parent)
    : QObject(parent), at_(parts), group_(new QActionGroup(this)) {
  int key = Qt::Key_1;
  for (const DeskRow& row : deskRows()) {
    layouts_[row.desk] = usualLayout(row.desk);
    tools_[row.desk] = row.tool;
    QAction* action = group_->addAction(row.words);
    action->setObjectName(QStringLiteral("desk_") + QString::fromUtf8(row.name));
    action->setCheckable(true);
    action->setData(static_cast<int>(row.desk));
    action->setChecked(row.desk == desk_);
    action->setShortcut(Qt::CTRL | key++);
    action->setToolTip(row.tip);
    connect(action, &QAction::triggered, this, [this, desk = row.desk] { choose(desk); });
  }
  at_.tools.setDesk(desk_);
  connect(&at_.tools, &ToolBar::chosen, this, &DeskController::takeTool);
  for (QSplitter* splitter : {&at_.across, &at_.down})
    connect(splitter, &QSplitter::splitterMoved, this, &DeskController::takeSizes);
  connect(&at_.side_panel, &FoldingTabs::foldRequested, this, &DeskController::foldSidePanel);
  connect(&at_.bottom_panel, &FoldingTabs::foldRequested, this, &DeskController::foldBottomPanel);
  connect(&at_.side_panel, &FoldingTabs::chosen, this, [this](int tab) {
    layouts_[desk_].tab = static_cast<Tab>(tab);
    emit changed();
  });
  connect(&at_.bottom_panel, &FoldingTabs::chosen, this, [this](int page) {
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
  // The card of Measure and Pin comes in front, and the tab of before with another tool.
  if (tool.handling == InteractionMode::measure || tool.handling == InteractionMode::pin) {
    tab_before_.try_emplace(desk_, layouts_[desk_].tab);
    open(Panel::measure);
  } else if (const auto before = tab_before_.extract(desk_)) {
    layouts_[desk_].tab = before.mapped();
    emit changed();
  }
}

void DeskController::open(Panel panel) {
  if (const auto tab = tabOf(panel)) {
    layouts_[desk_].tab = *tab;
    foldSidePanel(false);
  } else {
    layouts_[desk_].page = panel;
    foldBottomPanel(false);
  }
}

void DeskController::show(Panel panel) {
  const auto has = [panel](const DeskRow& row) {
    return std::find(row.panels.begin(), row.panels.end(), panel) != row.panels.end();
  };
  const auto other = std::find_if(deskRows().begin(), deskRows().end(), has);
  if (!has(rowOf(desk_)) && other != deskRows().end()) choose(other->desk);
  open(panel);
}

void DeskController::foldSidePanel(bool folded) {
  if (!narrow_)
    layouts_[desk_].side_panel_folded = folded;
  else if (folded)
    opened_.erase(desk_);
  else
    opened_.insert(desk_);
  arrange();
  emit changed();
}

void DeskController::foldBottomPanel(bool folded) {
  layouts_[desk_].bottom_panel_folded = folded;
  arrange();
  emit changed();
}

void DeskController::setNarrow(bool narrow) {
  if (narrow == narrow_) return;
  narrow_ = narrow;
  opened_ = {Desk::texture}; // The steps there are started by buttons in the side panel.
  arrange();
}

void DeskController::arrange() {
  const DeskLayout& layout = layouts_[desk_];
  at_.side_panel.setFolded(narrow_ ? !opened_.contains(desk_) : layout.side_panel_folded);
  at_.bottom_panel.setFolded(layout.bottom_panel_folded);
  at_.down.handle(1)->setEnabled(!at_.bottom_panel.folded()); // A folded panel has a fixed height.
  const int wide = at_.side_panel.folded() ? at_.side_panel.maximumWidth() : layout.side_panel;
  const int high =
      at_.bottom_panel.folded() ? at_.bottom_panel.maximumHeight() : layout.bottom_panel;
  at_.across.setSizes({at_.across.width() - at_.across.handleWidth() - wide, wide});
  at_.down.setSizes({at_.down.height() - at_.down.handleWidth() - high, high});
}

void DeskController::takeSizes() {
  DeskLayout& layout = layouts_[desk_];
  // A hidden panel has an arbitrary size.
  if (at_.side_panel.isVisible() && !at_.side_panel.folded())
    layout.side_panel = at_.side_panel.width();
  if (at_.bottom_panel.isVisible() && !at_.bottom_panel.folded())
    layout.bottom_panel = at_.bottom_panel.height();
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
      WindowGeometry{maximized ? window.normalGeometry().size() : window.size(), maximized, desk_});
  for (const auto& [desk, layout] : layouts_) patina::remember(desk, layout);
}

} // namespace patina
