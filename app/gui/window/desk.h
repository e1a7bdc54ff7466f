// Desks: what the window is set up for. Each is a row of one table: the panels at hand, and how it
// begins.
#pragma once

#include <optional>
#include <vector>

#include <QString>

#include "app/gui/painting/tool_choice.h"

namespace patina {

enum class Desk { feel, paint, analyse, scan, texture, align };

enum class Panel {
  recovery, // in the line below the picture
  tool,     // cards of the column at its side
  brush,
  relief,
  touch,
  objects,
  mesh,
  device,
  display,
  paint,
  forces, // pages of the drawer below it
  energy,
  history,
  messages,
  timeline,
  findings,
  profile,
  basin,
  scan, // cards again
  recorder,
  calibration,
  steps,
  align,
  library
};

// The cards of the column, a few at a time.
enum class Tab { tool, surface, object, device, show, scan, steps, align, library };
std::optional<Tab> tabOf(Panel panel); // nullopt: no card
bool inDrawer(Panel panel);

struct DeskRow {
  Desk desk;
  const char* name; // of its button and of what is remembered
  QString words, tip;
  int key; // with Ctrl
  std::vector<Panel> panels;
  // As it is before a person has changed it.
  ToolChoice tool;
  Tab tab;
  Panel page;
  bool drawer_open;
  int drawer = 170; // its height [px]
};
const std::vector<DeskRow>& deskRows(); // in the order of the bar
bool isBuilt(Desk desk);                // a program may be built without some
const DeskRow& rowOf(Desk desk);        // that is built

struct TabRow {
  Tab tab;
  const char* name;
  QString words, tip;
};
const std::vector<TabRow>& tabRows(); // in the order of the column

bool hasTool(Desk desk, const ToolChoice& tool);
// Where a tool is at hand: here if it can be.
Desk deskFor(const ToolChoice& tool, Desk here);

} // namespace patina
