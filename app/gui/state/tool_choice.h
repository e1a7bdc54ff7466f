// The tools: what the left button does, and what it paints.
#pragma once

#include <optional>

#include <QIcon>
#include <QKeySequence>
#include <QString>

#include "app/gui/toolkit/interaction_mode.h"
#include "scene/stroke.h"
#include "visualization/values/paint_quantity.h"

namespace patina {

struct ToolChoice {
  InteractionMode handling = InteractionMode::press;
  Tool tool = Tool::color; // Used while painting.
  bool operator==(const ToolChoice& other) const {
    return handling == other.handling && (handling != InteractionMode::paint || tool == other.tool);
  }
};

// Caption, icon and key of a tool.
struct ToolCard {
  ToolChoice choice;
  std::string name; // Object name of its action.
  QString words, tip;
  int key;                  // 0: none.
  bool in_overflow = false; // In the overflow menu.
};
const std::vector<ToolCard>& toolCards(); // In the order of the tool bar.
QIcon iconOf(const ToolChoice& choice);   // Drawn for 20 pixels.

QString captionOf(const Tool& tool); // "static friction", "colour"

// Returns the quantity that shows the tool's paint; nullopt: it does not paint, or erases.
std::optional<PaintQuantity> quantityOf(const ToolChoice& choice);

} // namespace patina
