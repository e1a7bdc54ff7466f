#include "app/gui/window/desk.h"

#include <algorithm>

#include <QCoreApplication>

namespace patina {
namespace {

QString tr(const char* words) {
  return QCoreApplication::translate("Desk", words);
}

std::vector<DeskRow> makeDesks() {
  using P = Panel;
  const ToolChoice feel{Handling::feel, {}}, color{Handling::paint, Tool::color};
  return {{Desk::feel,
           "feel",
           tr("Feel"),
           tr("Touch the surface and set how it feels"),
           {P::tool, P::relief, P::touch, P::objects, P::mesh, P::device, P::display, P::paint,
            P::forces, P::energy, P::history, P::messages},
           feel,
           Tab::surface,
           P::forces,
           false},
          {Desk::paint,
           "paint",
           tr("Paint"),
           tr("Paint colour, relief and material onto the surface"),
           {P::tool, P::brush, P::relief, P::touch, P::objects, P::mesh, P::display, P::paint,
            P::forces, P::history, P::messages},
           color,
           Tab::tool,
           P::history,
           true},
          {Desk::analyse,
           "analyse",
           tr("Analyse"),
           tr("Look inside: slices, distances, stability, forces and energy"),
           {P::touch, P::objects, P::mesh, P::device, P::display, P::paint, P::forces, P::energy,
            P::messages},
           feel,
           Tab::show,
           P::forces,
           true}};
}

} // namespace

std::optional<Tab> tabOf(Panel panel) {
  switch (panel) {
  case Panel::tool:
  case Panel::brush:
  case Panel::relief:
    return Tab::tool;
  case Panel::touch:
    return Tab::surface;
  case Panel::objects:
  case Panel::mesh:
    return Tab::object;
  case Panel::device:
    return Tab::device;
  case Panel::display:
  case Panel::paint:
    return Tab::show;
  default:
    return std::nullopt;
  }
}

bool inDrawer(Panel panel) {
  return panel >= Panel::forces;
}

const std::vector<DeskRow>& deskRows() {
  static const std::vector<DeskRow> kRows = makeDesks();
  return kRows;
}

const DeskRow& rowOf(Desk desk) {
  return deskRows()[static_cast<std::size_t>(desk)];
}

const std::vector<TabRow>& tabRows() {
  static const std::vector<TabRow> kRows = {
      {Tab::tool, "tool", tr("Tool"), tr("What the tool in hand does, and its brush")},
      {Tab::surface, "surface", tr("Surface"), tr("How the surface feels")},
      {Tab::object, "object", tr("Object"), tr("What is felt, and where it is")},
      {Tab::device, "device", tr("Device"), tr("What it is felt with")},
      {Tab::show, "show", tr("Show"), tr("What the picture shows")}};
  return kRows;
}

bool hasTool(Desk desk, const ToolChoice& tool) {
  const bool paints = tool.handling == Handling::paint || tool.handling == Handling::pick;
  return desk == Desk::paint || !paints;
}

Desk deskFor(const ToolChoice& tool, Desk here) {
  return hasTool(here, tool) ? here : Desk::paint;
}

} // namespace patina
