#include "app/gui/window/window_layout.h"

#include <algorithm>

#include <QScrollArea>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "app/gui/widgets/drawn_icon.h"
#include "app/gui/widgets/value_focus.h"
#include "app/gui/window/theme.h"
#ifdef PATINA_HAS_ACQUISITION
#include "app/gui/aligning/align_desk.h"
#include "app/gui/scanning/scan_desk.h"
#include "app/gui/texturing/texture_desk.h"
#endif

namespace patina {
namespace {

struct Page {
  Panel panel;
  const char* name;
  QString words, tip;
};

std::vector<Page> pages() {
  const auto tr = [](const char* words) { return QMainWindow::tr(words); };
  return {{Panel::timeline, "page_timeline", tr("Timeline"), tr("Frames, force and acceleration")},
          {Panel::findings, "page_findings", tr("Findings"), tr("What is missing, and why")},
          {Panel::profile, "page_profile", tr("Profile"), tr("Heights, harmonics and forces")},
          {Panel::basin, "page_basin", tr("Error"), tr("How the error grows about this place")},
          {Panel::forces, "page_forces", tr("Forces"), tr("Force on the hand, the last 5 s")},
          {Panel::energy, "page_energy", tr("Energy"), tr("Energy taken by the surface")},
          {Panel::history, "page_history", tr("History"), tr("Every edit; a click goes there")},
          {Panel::messages, "page_messages", tr("Messages"), tr("What the window has said")}};
}

FoldingTabs* makeColumn(const WindowParts& parts) {
  auto* side = new QWidget;
  auto* stack = new QVBoxLayout(side);
  stack->setContentsMargins(8, 0, 4, 8);
  stack->setSpacing(4);
  for (const Panel card :
       {Panel::scan, Panel::recorder, Panel::calibration, Panel::align, Panel::steps,
        Panel::library, Panel::tool, Panel::brush, Panel::relief, Panel::touch, Panel::display,
        Panel::device, Panel::objects, Panel::mesh})
    if (parts.panels.contains(card)) stack->addWidget(parts.panels.at(card));
  stack->addStretch(1);
  parts.display->layout()->addWidget(parts.paint);
  auto* scroll = new QScrollArea;
  scroll->setObjectName(QStringLiteral("cards"));
  dressAsCards(*scroll);
  scroll->setWidget(side);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  // Room for the scroll bar from the start, or it would cover the cards when it comes.
  scroll->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOn);
  auto* column = new FoldingTabs(FoldingTabs::Folds::aside, scroll);
  column->setObjectName(QStringLiteral("column"));
  for (const TabRow& row : tabRows())
    column->add(static_cast<int>(row.tab), QStringLiteral("tab_") + QString::fromUtf8(row.name),
                iconOf(row.tab), row.words, row.tip);
  return column;
}

FoldingTabs* makeDrawer(const WindowParts& parts) {
  auto* body = new QWidget;
  body->setMinimumHeight(110);
  auto* stack = new QVBoxLayout(body);
  stack->setContentsMargins(0, 0, 0, 0);
  auto* drawer = new FoldingTabs(FoldingTabs::Folds::down, body);
  drawer->setObjectName(QStringLiteral("drawer"));
  for (const Page& page : pages()) {
    if (!parts.panels.contains(page.panel)) continue;
    stack->addWidget(parts.panels.at(page.panel));
    drawer->add(static_cast<int>(page.panel), QString::fromUtf8(page.name), {}, page.words,
                page.tip);
  }
  auto* said = new QWidget;
  auto* line = new QHBoxLayout(said);
  line->setContentsMargins(0, 0, 0, 0);
  for (QWidget* each : std::initializer_list<QWidget*>{parts.load_bar, parts.recover, parts.notice})
    line->addWidget(each, 1);
  drawer->addToStrip(said);
  return drawer;
}

} // namespace

WindowParts layOut(QMainWindow& window) {
  WindowParts parts;
  parts.status = new StatusLine(window.statusBar());
  parts.recent = new QMenu(QMainWindow::tr("Open &recent"), &window);
  parts.panels = {{Panel::recovery, parts.recover}, {Panel::tool, parts.tool},
                  {Panel::brush, parts.brush},      {Panel::relief, parts.relief},
                  {Panel::touch, parts.haptics},    {Panel::display, parts.display},
                  {Panel::paint, parts.paint},      {Panel::device, parts.device},
                  {Panel::objects, parts.objects},  {Panel::mesh, parts.mesh},
                  {Panel::forces, parts.force},     {Panel::energy, parts.energy},
                  {Panel::history, parts.history},  {Panel::messages, parts.messages}};
  parts.cells = new QStackedWidget;
  parts.cells->addWidget(parts.view);
#ifdef PATINA_HAS_ACQUISITION
  parts.scan = new ScanDesk(window);
  parts.cells->addWidget(parts.scan->cells());
  parts.panels.merge(parts.scan->panels());
  parts.texture = new TextureDesk(window);
  parts.cells->addWidget(parts.texture->cells());
  parts.panels.merge(parts.texture->panels());
  parts.align = new AlignDesk(window);
  parts.cells->addWidget(parts.align->cells());
  parts.panels.merge(parts.align->panels());
#endif
  parts.column = makeColumn(parts);
  parts.drawer = makeDrawer(parts);
  auto* above = new QWidget;
  auto* stack = new QVBoxLayout(above);
  stack->setContentsMargins(0, 0, 0, 0);
  stack->setSpacing(0);
  stack->addWidget(parts.guide);
  stack->addWidget(parts.cells, 1);
  parts.down->addWidget(above);
  parts.down->addWidget(parts.drawer);
  parts.across->addWidget(parts.down);
  parts.across->addWidget(parts.column);
  for (QSplitter* splitter : {parts.down, parts.across}) {
    splitter->setChildrenCollapsible(false);
    splitter->setStretchFactor(0, 1);
    splitter->setStretchFactor(1, 0);
    splitter->setHandleWidth(4);
  }
  parts.down->setObjectName(QStringLiteral("down"));
  parts.across->setObjectName(QStringLiteral("across"));
  new ValueFocus(*parts.across, *parts.view);
  window.setCentralWidget(parts.across);
  window.addToolBar(Qt::LeftToolBarArea, parts.tools);
  return parts;
}

void showState(const WindowState& state, const WindowParts& parts, QMainWindow& window) {
  parts.load_bar->setWork(state.work);
  if (state.left_behind) parts.recover->setPlace(*state.left_behind);
  for (const auto& [panel, widget] : parts.panels) {
    const bool shown = isShown(panel, state);
    if (widget->isHidden() == shown) widget->setVisible(shown);
  }
  const auto tabs = tabsThere(state);
  for (const TabRow& row : tabRows())
    parts.column->setThere(static_cast<int>(row.tab),
                           std::find(tabs.begin(), tabs.end(), row.tab) != tabs.end());
  const auto there = pagesThere(state);
  for (const Page& page : pages())
    if (parts.panels.contains(page.panel))
      parts.drawer->setThere(static_cast<int>(page.panel),
                             std::find(there.begin(), there.end(), page.panel) != there.end());
  parts.column->setVisible(!tabs.empty());
  parts.welcome->setShown(isWelcome(state));
  const int other = static_cast<int>(state.desk) - static_cast<int>(Desk::scan); // desks in a row
  parts.cells->setCurrentIndex(std::max(0, other + 1));
  parts.tools->setVisible(other < 0);
  parts.guide->show(state.guide, other >= 0 && !showsSequence(state));
#ifdef PATINA_HAS_ACQUISITION
  parts.texture->showLibrary(tabInFront(state) == Tab::library);
#endif
  parts.column->setInFront(static_cast<int>(tabInFront(state)));
  parts.drawer->setInFront(static_cast<int>(pageInFront(state)));
  for (const auto& [command, action] : parts.commands)
    action->setEnabled(isEnabled(command, state));
  parts.commands.at(Command::record)->setChecked(state.recording);
  parts.tools->setPaints(isEnabled(Command::paint, state));
  window.setWindowTitle(titleOf(state));
  window.setWindowModified(state.unsaved && !showsSequence(state));
}

} // namespace patina
