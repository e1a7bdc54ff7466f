// Creates and arranges the widgets of the window, and shows its state.
#pragma once

#include <map>

#include <QAction>
#include <QMainWindow>
#include <QMenu>
#include <QSplitter>

#include "app/gui/loading/load_bar.h"
#include "app/gui/loading/notice_bar.h"
#include "app/gui/painting/brush_panel.h"
#include "app/gui/painting/paint_display.h"
#include "app/gui/painting/relief_panel.h"
#include "app/gui/panels/color_panel.h"
#include "app/gui/panels/device_panel.h"
#include "app/gui/panels/display_panel.h"
#include "app/gui/panels/haptics_panel.h"
#include "app/gui/panels/history_panel.h"
#include "app/gui/panels/measure_panel.h"
#include "app/gui/panels/message_panel.h"
#include "app/gui/panels/object_list.h"
#include "app/gui/panels/object_panel.h"
#include "app/gui/panels/tool_bar.h"
#include "app/gui/panels/tool_panel.h"
#include "app/gui/servo/live_plots.h"
#include "app/gui/state/window_state.h"
#include "app/gui/toolkit/folding_tabs.h"
#include "app/gui/toolkit/scene_widget.h"
#include "app/gui/window/welcome_page.h"

class QStackedWidget;

namespace patina {

class ScanDesk;
class TextureDesk;
class AlignDesk;
class StatusLine;

struct WindowParts {
  SceneWidget* view = new SceneWidget;
  WelcomePage* welcome = new WelcomePage(*view);
  QStackedWidget* central_views = nullptr; // The 3D view and the views of other desks.
  ScanDesk* scan = nullptr;
  TextureDesk* texture = nullptr;
  AlignDesk* align = nullptr;
  GuideStrip* guide = new GuideStrip;
  LoadBar* load_bar = new LoadBar;
  NoticeBar* recover = nullptr; // Offers a scene after a crash, below the picture.
  NoticeBar* storage = nullptr; // Says above it that edits do not reach the scene's folder.
  NoticeLine* notice = new NoticeLine;
  ToolBar* tools = new ToolBar;
  ToolPanel* tool = new ToolPanel;
  MeasurePanel* measure = new MeasurePanel;
  BrushPanel* brush = new BrushPanel;
  ReliefPanel* relief = new ReliefPanel;
  HapticsPanel* haptics = new HapticsPanel;
  DisplayPanel* display = new DisplayPanel;
  PaintDisplay* paint = new PaintDisplay;
  ColorPanel* colors = new ColorPanel;
  DevicePanel* device = new DevicePanel;
  ObjectList* objects = new ObjectList;
  ObjectPanel* mesh = new ObjectPanel;
  HistoryPanel* history = new HistoryPanel;
  MessagePanel* messages = new MessagePanel;
  ForcePlot* force = new ForcePlot;
  EnergyPlot* energy = new EnergyPlot;
  QSplitter* across = new QSplitter(Qt::Horizontal);
  QSplitter* down = new QSplitter(Qt::Vertical);
  FoldingTabs* side_panel = nullptr;
  FoldingTabs* bottom_panel = nullptr;
  QMenu* recent = nullptr;
  StatusLine* status = nullptr;
  std::map<Panel, QWidget*> panels;
  std::map<Command, QAction*> commands; // See addMenus().
};
WindowParts layOut(QMainWindow& window);

// The only function that shows and hides panels and enables commands.
void showState(const WindowState& state, const WindowParts& parts, QMainWindow& window);

} // namespace patina
