#include "app/gui/state/desk.h"

#include <algorithm>
#include <map>

#include "app/gui/toolkit/words.h"

namespace patina {
namespace {

std::vector<DeskRow> makeDesks() {
  using P = Panel;
  const ToolChoice look{InteractionMode::navigate, {}}, press{InteractionMode::press, {}},
      color{InteractionMode::paint, Tool::color};
  std::vector<DeskRow> rows;
  const auto add = [&](Desk desk, const char* name, const QString& words, const QString& tip,
                       const std::vector<Panel>& panels, const ToolChoice& tool, Tab tab,
                       Panel page, bool is_open, int high = 170) {
    rows.push_back({desk, name, words, tip, panels, tool, tab, page, is_open, high});
  };
  add(Desk::scan, "scan", tr("Scan"),
      tr("View the recording of a camera and a probe, and its path"),
      {P::scan, P::recorder, P::calibration, P::timeline, P::findings, P::messages}, look,
      Tab::scan, P::timeline, true, 270);
  add(Desk::align, "align", tr("Align"),
      tr("Align a scan's path with the mesh by hand, and fit it from there"),
      {P::align, P::colors, P::cost_profile, P::messages}, look, Tab::align, P::cost_profile, true,
      190);
  add(Desk::texture, "texture", tr("Texture"), tr("From a scan to a feel: register, fit, map"),
      {P::steps, P::library, P::profile, P::history, P::messages}, look, Tab::steps, P::profile,
      true, 220);
  add(Desk::feel, "feel", tr("Feel"), tr("Touch the surface and set how it feels"),
      {P::tool, P::measure, P::relief, P::touch, P::objects, P::mesh, P::device, P::display,
       P::colors, P::forces, P::energy, P::history, P::messages},
      press, Tab::surface, P::forces, false);
  add(Desk::paint, "paint", tr("Paint"), tr("Paint colour, relief and material onto the surface"),
      {P::tool, P::measure, P::brush, P::relief, P::touch, P::objects, P::mesh, P::display,
       P::colors, P::forces, P::history, P::messages},
      color, Tab::tool, P::history, true);
  add(Desk::analyse, "analyse", tr("Analyse"),
      tr("Inspect slices, distances, stability, forces and energy"),
      {P::measure, P::touch, P::objects, P::mesh, P::device, P::display, P::colors, P::forces,
       P::energy, P::messages},
      press, Tab::show, P::forces, true);
  return rows;
}

} // namespace

std::optional<Tab> tabOf(Panel panel) {
  static const std::map<Panel, Tab> kTabs = {
      {Panel::tool, Tab::tool},        {Panel::measure, Tab::tool},  {Panel::brush, Tab::tool},
      {Panel::relief, Tab::tool},      {Panel::touch, Tab::surface}, {Panel::objects, Tab::object},
      {Panel::mesh, Tab::object},      {Panel::device, Tab::device}, {Panel::display, Tab::show},
      {Panel::colors, Tab::show},      {Panel::scan, Tab::scan},     {Panel::recorder, Tab::scan},
      {Panel::calibration, Tab::scan}, {Panel::steps, Tab::steps},   {Panel::align, Tab::align},
      {Panel::library, Tab::library}};
  const auto tab = kTabs.find(panel);
  return tab == kTabs.end() ? std::nullopt : std::optional(tab->second);
}

const std::vector<DeskRow>& deskRows() {
  static const std::vector<DeskRow> kRows = makeDesks();
  return kRows;
}

const DeskRow& rowOf(Desk desk) {
  return *std::find_if(deskRows().begin(), deskRows().end(),
                       [desk](const DeskRow& row) { return row.desk == desk; });
}

const std::vector<TabRow>& tabRows() {
  static const std::vector<TabRow> kRows = {
      {Tab::scan, "scan", tr("Scan"), tr("The recording and its results")},
      {Tab::align, "align", tr("Place"), tr("Pose of the path, and its distance from the mesh")},
      {Tab::steps, "steps", tr("Steps"), tr("From a scan to a feel, step by step")},
      {Tab::library, "library", tr("Library"), tr("Textures, and mapping them onto the mesh")},
      {Tab::tool, "tool", tr("Tool"), tr("The current tool and its brush")},
      {Tab::surface, "surface", tr("Surface"), tr("How the surface feels")},
      {Tab::object, "object", tr("Object"), tr("The objects and their poses")},
      {Tab::device, "device", tr("Device"), tr("The haptic device")},
      {Tab::show, "show", tr("Show"), tr("Layers of the picture")}};
  return kRows;
}

bool hasTool(Desk desk, const ToolChoice& tool) {
  if (desk >= Desk::scan) return tool.handling == InteractionMode::navigate;
  const bool paints =
      tool.handling == InteractionMode::paint || tool.handling == InteractionMode::pick;
  return desk == Desk::paint || !paints;
}

Desk deskFor(const ToolChoice& tool, Desk here) {
  if (hasTool(here, tool)) return here;
  return hasTool(Desk::feel, tool) ? Desk::feel : Desk::paint;
}

} // namespace patina
