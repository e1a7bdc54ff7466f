#include "app/gui/window/desk.h"

#include <algorithm>

#include <QCoreApplication>

#include "app/gui/widgets/words.h"

namespace patina {
namespace {

std::vector<DeskRow> makeDesks() {
  using P = Panel;
  const ToolChoice feel{Handling::feel, {}}, color{Handling::paint, Tool::color};
  std::vector<DeskRow> rows;
#ifdef PATINA_HAS_ACQUISITION
  rows.push_back({Desk::scan,
                  "scan",
                  tr("Scan"),
                  tr("See what a camera and a probe have recorded, and the path made of it"),
                  Qt::Key_0,
                  {P::scan, P::recorder, P::calibration, P::timeline, P::findings, P::messages},
                  {Handling::navigate, {}},
                  Tab::scan,
                  P::timeline,
                  true,
                  270});
  rows.push_back({Desk::align,
                  "align",
                  tr("Align"),
                  tr("Lay a scan's path onto the mesh by hand, and fit it from there"),
                  Qt::Key_8,
                  {P::align, P::basin, P::messages},
                  {Handling::navigate, {}},
                  Tab::align,
                  P::basin,
                  true,
                  190});
  rows.push_back({Desk::texture,
                  "texture",
                  tr("Texture"),
                  tr("From a scan to a feel: register, fit, map"),
                  Qt::Key_9,
                  {P::steps, P::library, P::profile, P::history, P::messages},
                  {Handling::navigate, {}},
                  Tab::steps,
                  P::profile,
                  true,
                  220});
#endif
  rows.insert(rows.end(), {{Desk::feel,
                            "feel",
                            tr("Feel"),
                            tr("Touch the surface and set how it feels"),
                            Qt::Key_1,
                            {P::tool, P::relief, P::touch, P::objects, P::mesh, P::device,
                             P::display, P::paint, P::forces, P::energy, P::history, P::messages},
                            feel,
                            Tab::surface,
                            P::forces,
                            false},
                           {Desk::paint,
                            "paint",
                            tr("Paint"),
                            tr("Paint colour, relief and material onto the surface"),
                            Qt::Key_2,
                            {P::tool, P::brush, P::relief, P::touch, P::objects, P::mesh,
                             P::display, P::paint, P::forces, P::history, P::messages},
                            color,
                            Tab::tool,
                            P::history,
                            true},
                           {Desk::analyse,
                            "analyse",
                            tr("Analyse"),
                            tr("Look inside: slices, distances, stability, forces and energy"),
                            Qt::Key_3,
                            {P::touch, P::objects, P::mesh, P::device, P::display, P::paint,
                             P::forces, P::energy, P::messages},
                            feel,
                            Tab::show,
                            P::forces,
                            true}});
  return rows;
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
  case Panel::scan:
  case Panel::recorder:
  case Panel::calibration:
    return Tab::scan;
  case Panel::steps:
    return Tab::steps;
  case Panel::align:
    return Tab::align;
  case Panel::library:
    return Tab::library;
  default:
    return std::nullopt;
  }
}

bool inDrawer(Panel panel) {
  return panel >= Panel::forces && panel <= Panel::basin;
}

const std::vector<DeskRow>& deskRows() {
  static const std::vector<DeskRow> kRows = makeDesks();
  return kRows;
}

bool isBuilt(Desk desk) {
  return std::any_of(deskRows().begin(), deskRows().end(),
                     [desk](const DeskRow& row) { return row.desk == desk; });
}

const DeskRow& rowOf(Desk desk) {
  return *std::find_if(deskRows().begin(), deskRows().end(),
                       [desk](const DeskRow& row) { return row.desk == desk; });
}

const std::vector<TabRow>& tabRows() {
  static const std::vector<TabRow> kRows = {
      {Tab::scan, "scan", tr("Scan"), tr("What was recorded, and what it came to")},
      {Tab::align, "align", tr("Place"), tr("Where the path lies, and how far off")},
      {Tab::steps, "steps", tr("Steps"), tr("From a scan to a feel, step by step")},
      {Tab::library, "library", tr("Library"), tr("Textures, and how they come onto the mesh")},
      {Tab::tool, "tool", tr("Tool"), tr("What the tool in hand does, and its brush")},
      {Tab::surface, "surface", tr("Surface"), tr("How the surface feels")},
      {Tab::object, "object", tr("Object"), tr("What is felt, and where it is")},
      {Tab::device, "device", tr("Device"), tr("What it is felt with")},
      {Tab::show, "show", tr("Show"), tr("What the picture shows")}};
  return kRows;
}

bool hasTool(Desk desk, const ToolChoice& tool) {
  if (desk >= Desk::scan) return tool.handling == Handling::navigate;
  const bool paints = tool.handling == Handling::paint || tool.handling == Handling::pick;
  return desk == Desk::paint || !paints;
}

Desk deskFor(const ToolChoice& tool, Desk here) {
  if (hasTool(here, tool)) return here;
  return hasTool(Desk::feel, tool) ? Desk::feel : Desk::paint;
}

} // namespace patina
