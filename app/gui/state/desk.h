// Desks: arrangements of the window for a task, as a table of panels and first states.
#pragma once

#include <optional>
#include <vector>

#include <QString>

#include "app/gui/state/tool_choice.h"

namespace patina {

enum class Desk { feel, paint, analyse, scan, texture, align };

enum class Panel {
  recovery, // In the line below the picture.
  storage,  // The line above that one.
  tool,     // Groups of the side panel.
  measure,
  brush,
  relief,
  touch,
  objects,
  mesh,
  device,
  display,
  colors,
  forces = 13, // Tabs of the bottom panel; settings store their numbers.
  energy,
  history,
  messages,
  timeline,
  findings,
  profile,
  cost_profile,
  scan, // Groups again.
  recorder,
  calibration,
  steps,
  align,
  library
};

// Tabs of the side panel, with a few groups each.
enum class Tab { tool, surface, object, device, show, scan, steps, align, library };
std::optional<Tab> tabOf(Panel panel); // nullopt: not in the side panel.
inline bool inBottomPanel(Panel panel) {
  return panel >= Panel::forces && panel <= Panel::cost_profile;
}

struct DeskRow {
  Desk desk;
  const char* name; // Name of its button and its settings.
  QString words, tip;
  std::vector<Panel> panels;
  // First state, until the user changes it.
  ToolChoice tool;
  Tab tab;
  Panel page;
  bool bottom_panel_open;
  int bottom_panel = 170; // Height [px].
};
const std::vector<DeskRow>& deskRows(); // In the order of the bar.
const DeskRow& rowOf(Desk desk);

struct TabRow {
  Tab tab;
  const char* name;
  QString words, tip;
};
const std::vector<TabRow>& tabRows(); // In the order of the side panel.

bool hasTool(Desk desk, const ToolChoice& tool);
// Returns a desk that has the tool, `here` if possible.
Desk deskFor(const ToolChoice& tool, Desk here);

} // namespace patina
