#include "app/gui/window/window_layout.h"

#include <algorithm>

#include <QDateTime>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLocale>
#include <QScrollArea>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "app/gui/aligning/align_desk.h"
#include "app/gui/scanning/scan_desk.h"
#include "app/gui/state/desk.h"
#include "app/gui/texturing/texture_desk.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/drawn_icon.h"
#include "app/gui/toolkit/theme.h"
#include "app/gui/toolkit/words.h"
#include "app/gui/window/status_line.h"
#include "session/store/autosave.h"

namespace patina {
namespace {

// The icons of the side panel's tabs, in the order of Tab.
constexpr const char* kTabIcons[] = {
    "round warm 2.4; line 4 16 9 11; round text 2.4; line 10 10 16 4",
    "round accent 1.8; curve 2 13 6 4 9 8 11 11 13 14 16 12 18 8;"
    "square text 1.2; line 4 17 6 15; line 8 17 10 15; line 12 17 14 15; line 16 17 18 15",
    "polygon 10 2 17 6 17 14 10 18 3 14 3 6; line 3 6 10 10 17 6; line 10 10 10 18",
    "box 5 3 10 14 5; line 10 3 10 9; round warm 1.8; line 10 6 10 7",
    "curve 2 10 6 3.5 14 3.5 18 10 14 16.5 6 16.5 2 10; fill accent; ellipse 10 10 2.6 2.6",
    "box 2 5 12 10 2; line 14 9 18 6 18 14 14 11; square accent 1.6; box 5.5 7.5 5 5",
    "line 2 16 18 16; square accent 1.6; curve 2 9 5 1 7 1 10 8 13 15 15 12 18 6",
    "curve 2 17 6 10 13 10 18 17; square accent 1.6; curve 3 8 7 1 13 1 17 8; line 8 7.5 10 10 12 "
    "7.5",
    "box 2 2.5 16 4 1; line 5 4.5 8 4.5; box 2 8 16 4 1; line 5 10 11 10;"
    "box 2 13.5 16 4 1; line 5 15.5 14 15.5"};

struct Page {
  Panel panel;
  const char* name;
  QString words, tip;
};

std::vector<Page> pages() {
  return {
      {Panel::timeline, "page_timeline", tr("Timeline"), tr("Frames, force and acceleration")},
      {Panel::findings, "page_findings", tr("Findings"),
       tr("Missing or rejected parts, with the reason")},
      {Panel::profile, "page_profile", tr("Profile"), tr("Heights, harmonics and forces")},
      {Panel::cost_profile, "page_basin", tr("Error"), tr("RMS distance around the present pose")},
      {Panel::forces, "page_forces", tr("Forces"), tr("Force on the hand, the last 5 s")},
      {Panel::energy, "page_energy", tr("Energy"), tr("Energy absorbed by the surface")},
      {Panel::history, "page_history", tr("History"), tr("Every edit; a click goes there")},
      {Panel::messages, "page_messages", tr("Messages"), tr("All messages")}};
}

FoldingTabs* makeSidePanel(const WindowParts& parts) {
  auto* side = new QWidget;
  auto* stack = new QVBoxLayout(side);
  stack->setContentsMargins(8, 0, 4, 8);
  stack->setSpacing(4);
  for (const Panel card :
       {Panel::scan, Panel::recorder, Panel::calibration, Panel::align, Panel::steps,
        Panel::library, Panel::tool, Panel::measure, Panel::brush, Panel::relief, Panel::touch,
        Panel::display, Panel::colors, Panel::device, Panel::objects, Panel::mesh})
    if (parts.panels.contains(card)) stack->addWidget(parts.panels.at(card));
  stack->addStretch(1);
  parts.display->addValues("paint", parts.paint);
  auto* scroll = new QScrollArea;
  scroll->setObjectName(QStringLiteral("cards"));
  applyCardStyle(*scroll);
  scroll->setWidget(side);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  // Reserves room for the scroll bar, so that it never covers the cards.
  scroll->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOn);
  auto* column = new FoldingTabs(FoldingTabs::Folds::aside, scroll);
  column->setObjectName(QStringLiteral("column"));
  for (const TabRow& row : tabRows())
    column->add(static_cast<int>(row.tab), QStringLiteral("tab_") + QString::fromUtf8(row.name),
                drawnIcon(kTabIcons[static_cast<std::size_t>(row.tab)]), row.words, row.tip);
  return column;
}

FoldingTabs* makeBottomPanel(const WindowParts& parts) {
  auto* body = new QWidget;
  body->setMinimumHeight(110);
  auto* stack = new QVBoxLayout(body);
  stack->setContentsMargins(0, 0, 0, 0);
  auto* bottom_panel = new FoldingTabs(FoldingTabs::Folds::down, body);
  bottom_panel->setObjectName(QStringLiteral("drawer"));
  for (const Page& page : pages()) {
    if (!parts.panels.contains(page.panel)) continue;
    stack->addWidget(parts.panels.at(page.panel));
    bottom_panel->add(static_cast<int>(page.panel), QString::fromUtf8(page.name), {}, page.words,
                      page.tip);
  }
  auto* notified = new QWidget;
  auto* line = new QHBoxLayout(notified);
  line->setContentsMargins(0, 0, 0, 0);
  for (QWidget* each : std::initializer_list<QWidget*>{parts.load_bar, parts.recover, parts.notice})
    line->addWidget(each, 1);
  bottom_panel->addToStrip(notified);
  return bottom_panel;
}

QString recoveryWords(const std::filesystem::path& place) {
  const bool records = holdsRecording(place);
  const QFileInfo info(shownText((place / (records ? "forces.csv" : "scene.patina")).string()));
  return (records ? tr("Patina ended unexpectedly. Recorded forces from %1 can be recovered.")
                  : tr("Patina ended unexpectedly. An unsaved scene from %1 can be recovered."))
      .arg(QLocale().toString(info.lastModified(), QLocale::ShortFormat));
}

} // namespace

WindowParts layOut(QMainWindow& window) {
  WindowParts parts;
  parts.recover =
      new NoticeBar("recover_bar", 0,
                    {{"recover", tr("Recover"), tr("Open or save it")},
                     {"forget", tr("Delete"), tr("Remove it for good")},
                     {"later", tr("Not now"), tr("It is offered again at the next start")}});
  parts.storage =
      new NoticeBar("storage_bar", 2,
                    {{"save_elsewhere", tr("Save elsewhere…"),
                      tr("Save the scene in another folder, where edits are then written")}});
  parts.status = new StatusLine(window.statusBar());
  parts.recent = new QMenu(QMainWindow::tr("Open &recent"), &window);
  parts.panels = {{Panel::recovery, parts.recover}, {Panel::storage, parts.storage},
                  {Panel::tool, parts.tool},        {Panel::brush, parts.brush},
                  {Panel::measure, parts.measure},  {Panel::colors, parts.colors},
                  {Panel::relief, parts.relief},    {Panel::touch, parts.haptics},
                  {Panel::display, parts.display},  {Panel::device, parts.device},
                  {Panel::objects, parts.objects},  {Panel::mesh, parts.mesh},
                  {Panel::forces, parts.force},     {Panel::energy, parts.energy},
                  {Panel::history, parts.history},  {Panel::messages, parts.messages}};
  parts.central_views = new QStackedWidget;
  parts.central_views->addWidget(parts.view);
  parts.scan = new ScanDesk(window);
  parts.central_views->addWidget(parts.scan->centralViews());
  parts.panels.merge(parts.scan->panels());
  parts.texture = new TextureDesk(window);
  parts.central_views->addWidget(parts.texture->centralViews());
  parts.panels.merge(parts.texture->panels());
  parts.align = new AlignDesk(window);
  parts.central_views->addWidget(parts.align->centralViews());
  parts.panels.merge(parts.align->panels());
  parts.side_panel = makeSidePanel(parts);
  parts.bottom_panel = makeBottomPanel(parts);
  auto* above = new QWidget;
  auto* stack = layoutIn<QVBoxLayout>(above, 0);
  stack->addWidget(parts.storage);
  stack->addWidget(parts.guide);
  stack->addWidget(parts.central_views, 1);
  parts.down->addWidget(above);
  parts.down->addWidget(parts.bottom_panel);
  parts.across->addWidget(parts.down);
  parts.across->addWidget(parts.side_panel);
  for (QSplitter* splitter : {parts.down, parts.across}) {
    splitter->setChildrenCollapsible(false);
    splitter->setStretchFactor(0, 1);
    splitter->setStretchFactor(1, 0);
    splitter->setHandleWidth(4);
  }
  parts.down->setObjectName(QStringLiteral("down"));
  parts.across->setObjectName(QStringLiteral("across"));
  takeValueKeys(*parts.across, *parts.view);
  window.setCentralWidget(parts.across);
  window.addToolBar(Qt::LeftToolBarArea, parts.tools);
  return parts;
}

void showState(const WindowState& state, const WindowParts& parts, QMainWindow& window) {
  parts.load_bar->setWork(state.work);
  if (state.recoverable_scenes) parts.recover->setWords(recoveryWords(*state.recoverable_scenes));
  parts.storage->setWords(state.storage_problem);
  for (const auto& [panel, widget] : parts.panels) {
    const bool shown = isShown(panel, state);
    if (widget->isHidden() == shown) widget->setVisible(shown);
  }
  const auto tabs = tabsThere(state);
  for (const TabRow& row : tabRows())
    parts.side_panel->setThere(static_cast<int>(row.tab),
                               std::find(tabs.begin(), tabs.end(), row.tab) != tabs.end());
  const auto there = pagesThere(state);
  for (const Page& page : pages())
    if (parts.panels.contains(page.panel))
      parts.bottom_panel->setThere(static_cast<int>(page.panel),
                                   std::find(there.begin(), there.end(), page.panel) !=
                                       there.end());
  parts.side_panel->setVisible(!tabs.empty());
  parts.welcome->setShown(isWelcome(state));
  const int other = static_cast<int>(state.desk) - static_cast<int>(Desk::scan);
  parts.central_views->setCurrentIndex(std::max(0, other + 1));
  parts.tools->setVisible(other < 0);
  parts.guide->show(state.guide, other >= 0 && !showsSequence(state));
  parts.texture->showLibrary(tabInFront(state) == Tab::library);
  parts.side_panel->setInFront(static_cast<int>(tabInFront(state)));
  parts.bottom_panel->setInFront(static_cast<int>(pageInFront(state)));
  for (const auto& [command, action] : parts.commands)
    action->setEnabled(isEnabled(command, state));
  parts.commands.at(Command::record)->setChecked(state.recording);
  parts.tools->setPaints(isEnabled(Command::paint, state));
  window.setWindowTitle(titleOf(state));
  window.setWindowModified(state.unsaved && !showsSequence(state));
}

} // namespace patina
