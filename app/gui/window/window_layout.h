// The widgets of the window, where they are, and how they show its state.
#pragma once

#include <map>
#include <optional>

#include <QAction>
#include <QMainWindow>
#include <QMenu>
#include <QSplitter>

#include "app/gui/loading/load_bar.h"
#include "app/gui/loading/recover_bar.h"
#include "app/gui/painting/brush_panel.h"
#include "app/gui/painting/paint_display.h"
#include "app/gui/painting/relief_panel.h"
#include "app/gui/panels/device_panel.h"
#include "app/gui/panels/display_panel.h"
#include "app/gui/panels/haptics_panel.h"
#include "app/gui/panels/history_panel.h"
#include "app/gui/panels/message_panel.h"
#include "app/gui/panels/object_list.h"
#include "app/gui/panels/object_panel.h"
#include "app/gui/panels/tool_panel.h"
#include "app/gui/servo/live_plots.h"
#include "app/gui/widgets/folding_tabs.h"
#include "app/gui/widgets/scene_widget.h"
#include "app/gui/widgets/status_line.h"
#include "app/gui/window/guide_strip.h"
#include "app/gui/window/tool_bar.h"
#include "app/gui/window/welcome_page.h"
#include "app/gui/window/window_state.h"

class QStackedWidget;

namespace patina {

class ScanDesk;
class TextureDesk;
class AlignDesk;

// All belong to the window that they are laid out in.
struct WindowParts {
  SceneWidget* view = new SceneWidget;
  WelcomePage* welcome = new WelcomePage(*view);
  QStackedWidget* cells = nullptr; // the view, and what other desks have in its place
  ScanDesk* scan = nullptr;        // where they are built
  TextureDesk* texture = nullptr;
  AlignDesk* align = nullptr;
  GuideStrip* guide = new GuideStrip; // over them
  LoadBar* load_bar = new LoadBar;
  RecoverBar* recover = new RecoverBar;
  NoticeLine* notice = new NoticeLine;
  ToolBar* tools = new ToolBar;
  ToolPanel* tool = new ToolPanel;
  BrushPanel* brush = new BrushPanel;
  ReliefPanel* relief = new ReliefPanel;
  HapticsPanel* haptics = new HapticsPanel;
  DisplayPanel* display = new DisplayPanel;
  PaintDisplay* paint = new PaintDisplay;
  DevicePanel* device = new DevicePanel;
  ObjectList* objects = new ObjectList;
  ObjectPanel* mesh = new ObjectPanel;
  HistoryPanel* history = new HistoryPanel;
  MessagePanel* messages = new MessagePanel;
  ForcePlot* force = new ForcePlot;
  EnergyPlot* energy = new EnergyPlot;
  QSplitter* across = new QSplitter(Qt::Horizontal);
  QSplitter* down = new QSplitter(Qt::Vertical);
  FoldingTabs* column = nullptr;
  FoldingTabs* drawer = nullptr;
  QMenu* recent = nullptr;
  StatusLine* status = nullptr;
  std::map<Panel, QWidget*> panels;
  std::map<Command, QAction*> commands; // see addMenus()
};
WindowParts layOut(QMainWindow& window);

// The one place where panels are shown and hidden and commands allowed.
void showState(const WindowState& state, const WindowParts& parts, QMainWindow& window);

} // namespace patina
