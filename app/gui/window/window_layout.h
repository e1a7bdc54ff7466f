// The widgets of the window, where they are, and how they show its state.
#pragma once

#include <map>
#include <optional>

#include <QAction>
#include <QLabel>
#include <QMainWindow>
#include <QMenu>

#include "app/gui/loading/load_bar.h"
#include "app/gui/loading/recover_bar.h"
#include "app/gui/painting/brush_panel.h"
#include "app/gui/painting/paint_display.h"
#include "app/gui/painting/relief_panel.h"
#include "app/gui/panels/device_panel.h"
#include "app/gui/panels/display_panel.h"
#include "app/gui/panels/haptics_panel.h"
#include "app/gui/panels/history_panel.h"
#include "app/gui/panels/object_list.h"
#include "app/gui/panels/object_panel.h"
#include "app/gui/servo/live_plots.h"
#include "app/gui/window/scene_widget.h"
#include "app/gui/window/status_line.h"
#include "app/gui/window/tool_bar.h"
#include "app/gui/window/window_state.h"

namespace patina {

// All belong to the window that they are laid out in.
struct WindowParts {
  SceneWidget* view = new SceneWidget;
  LoadBar* load_bar = new LoadBar;
  RecoverBar* recover = new RecoverBar;
  QLabel* warnings = new QLabel;
  ToolBar* tools = new ToolBar;
  BrushPanel* brush = new BrushPanel;
  ReliefPanel* relief = new ReliefPanel;
  HapticsPanel* haptics = new HapticsPanel;
  DisplayPanel* display = new DisplayPanel;
  PaintDisplay* paint = new PaintDisplay;
  DevicePanel* device = new DevicePanel;
  ObjectList* objects = new ObjectList;
  ObjectPanel* mesh = new ObjectPanel;
  HistoryPanel* history = new HistoryPanel;
  ForcePlot* force = new ForcePlot;
  EnergyPlot* energy = new EnergyPlot;
  QMenu* recent = nullptr;
  StatusLine* status = nullptr;
  std::map<Panel, QWidget*> panels;
  std::map<Command, QAction*> commands; // see addMenus()
};
WindowParts layOut(QMainWindow& window);

// The one place where panels are shown and hidden and commands allowed. A panel is touched only
// where it differs from `before`: a dock that a person has closed stays closed.
void showState(const WindowState& state, const std::optional<WindowState>& before,
               const WindowParts& parts, QMainWindow& window);

} // namespace patina
