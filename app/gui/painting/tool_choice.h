// The tools that can be chosen: what the left button does, and what it paints.
#pragma once

#include <optional>

#include <QIcon>
#include <QKeySequence>
#include <QString>

#include "app/gui/window/handling.h"
#include "scene/stroke.h"
#include "visualization/values/paint_quantity.h"

namespace patina {

struct ToolChoice {
  Handling handling = Handling::feel;
  Tool tool = Tool::color; // of paint
  bool operator==(const ToolChoice& other) const {
    return handling == other.handling && (handling != Handling::paint || tool == other.tool);
  }
};

// How a tool is called, drawn and reached.
struct ToolCard {
  ToolChoice choice;
  std::string name; // object name of its action
  QString words, tip;
  int key;             // 0: none
  bool seldom = false; // in the small menu
};
const std::vector<ToolCard>& toolCards(); // in the order of the tool bar
QIcon iconOf(const ToolChoice& choice);   // drawn for 20 pixels

QString captionOf(const Tool& tool); // "static friction", "colour"

// What shows what a tool does; nullopt for what does not paint, and for the eraser.
std::optional<PaintQuantity> quantityOf(const ToolChoice& choice);

} // namespace patina
