#include "app/gui/window/window_layout.h"

#include <QDockWidget>
#include <QScrollArea>
#include <QVBoxLayout>

#include "app/gui/window/value_focus.h"
#include "app/gui/window/window_style.h"

namespace patina {
namespace {

QWidget* makeCentre(const WindowParts& parts) {
  auto* centre = new QWidget;
  auto* column = new QVBoxLayout(centre);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  parts.warnings->setObjectName(QStringLiteral("warnings"));
  parts.warnings->setWordWrap(true);
  parts.warnings->setContentsMargins(10, 5, 10, 5);
  parts.warnings->setStyleSheet(QStringLiteral("background: #fff4d6; color: #6b4e00;"));
  for (QWidget* bar : {static_cast<QWidget*>(parts.load_bar), static_cast<QWidget*>(parts.recover),
                       static_cast<QWidget*>(parts.warnings)})
    column->addWidget(bar);
  column->addWidget(parts.view, 1);
  return centre;
}

QWidget* makeSide(const WindowParts& parts) {
  auto* side = new QWidget;
  side->setStyleSheet(cardStyle());
  auto* stack = new QVBoxLayout(side);
  stack->setContentsMargins(8, 0, 8, 8);
  stack->setSpacing(4);
  for (const Panel card : {Panel::brush, Panel::relief, Panel::touch, Panel::display, Panel::device,
                           Panel::objects, Panel::mesh})
    stack->addWidget(parts.panels.at(card));
  stack->addStretch(1);
  parts.display->layout()->addWidget(parts.paint);
  new ValueFocus(*side, *parts.view);
  auto* scroll = new QScrollArea;
  scroll->setWidget(side);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  // Room for the scroll bar from the start, or it would cover the cards when it comes.
  scroll->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOn);
  scroll->setFixedWidth(318);
  return scroll;
}

} // namespace

WindowParts layOut(QMainWindow& window) {
  WindowParts parts;
  parts.status = new StatusLine(window.statusBar());
  parts.recent = new QMenu(QMainWindow::tr("Open &recent"), &window);
  parts.panels = {{Panel::recovery, parts.recover}, {Panel::warnings, parts.warnings},
                  {Panel::brush, parts.brush},      {Panel::relief, parts.relief},
                  {Panel::touch, parts.haptics},    {Panel::display, parts.display},
                  {Panel::paint, parts.paint},      {Panel::device, parts.device},
                  {Panel::objects, parts.objects},  {Panel::mesh, parts.mesh}};
  const auto dock = [&](const QString& title, const char* name, QWidget* widget,
                        Qt::DockWidgetArea area) {
    auto* made = new QDockWidget(title, &window);
    made->setObjectName(QString::fromUtf8(name));
    made->setWidget(widget);
    made->setFeatures(QDockWidget::DockWidgetClosable | QDockWidget::DockWidgetMovable);
    window.addDockWidget(area, made);
    return made;
  };
  window.setCentralWidget(makeCentre(parts));
  window.addToolBar(Qt::LeftToolBarArea, parts.tools);
  dock(QMainWindow::tr("Scene"), "scene_dock", makeSide(parts), Qt::RightDockWidgetArea);
  QDockWidget* force = dock(QMainWindow::tr("Force on the hand"), "force_dock", parts.force,
                            Qt::BottomDockWidgetArea);
  QDockWidget* energy = dock(QMainWindow::tr("Energy taken by the surface"), "energy_dock",
                             parts.energy, Qt::BottomDockWidgetArea);
  window.splitDockWidget(force, energy, Qt::Horizontal);
  window.resizeDocks({force, energy}, {1, 1}, Qt::Horizontal);
  window.setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  QDockWidget* history =
      dock(QMainWindow::tr("History"), "history_dock", parts.history, Qt::RightDockWidgetArea);
  parts.history->setMinimumHeight(60);
  window.resizeDocks({history}, {170}, Qt::Vertical);
  parts.panels[Panel::history] = history;
  return parts;
}

void showState(const WindowState& state, const std::optional<WindowState>& before,
               const WindowParts& parts, QMainWindow& window) {
  parts.load_bar->setWork(state.work);
  parts.warnings->setText(state.warnings.join(QStringLiteral("\n")));
  if (state.left_behind) parts.recover->setPlace(*state.left_behind);
  for (const auto& [panel, widget] : parts.panels) {
    const bool shown = isShown(panel, state);
    if (!before || isShown(panel, *before) != shown) widget->setVisible(shown);
  }
  for (const auto& [command, action] : parts.commands)
    action->setEnabled(isEnabled(command, state));
  parts.commands.at(Command::record)->setChecked(state.recording);
  parts.tools->setPaints(isEnabled(Command::paint, state));
  window.setWindowTitle(titleOf(state));
  window.setWindowModified(state.unsaved);
}

} // namespace patina
