#include "app/gui/state/window_state.h"

#include <algorithm>

#include "app/gui/toolkit/words.h"

namespace patina {
namespace {

template <typename List, typename Value> bool has(const List& list, const Value& value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

template <typename Value> Value orFirst(const Value& wanted, const std::vector<Value>& there) {
  return there.empty() || has(there, wanted) ? wanted : there.front();
}

} // namespace

bool showsSequence(const WindowState& state) {
  return state.desk == Desk::texture && state.sequence &&
         !(state.open && tabInFront(state) == Tab::library);
}

bool isWelcome(const WindowState& state) {
  return state.content == Content::nothing && !state.open && !state.work;
}

bool isSeen(const WindowState& state) {
  switch (state.desk) {
  case Desk::scan:
    return false;
  case Desk::align:
    return !isWelcome(state) && state.guide.samples > 0; // Shows no mesh without a path.
  case Desk::texture:
    return !isWelcome(state) && state.tab == Tab::library;
  default:
    return true;
  }
}

bool isThere(Panel panel, const WindowState& state) {
  if (panel == Panel::recovery) return state.recoverable_scenes.has_value();
  if (panel == Panel::storage) return state.open && !state.storage_problem.isEmpty();
  if (!has(rowOf(state.desk).panels, panel)) return false;
  const bool scene = state.content == Content::scene;
  const bool paints = state.tool.handling == InteractionMode::paint;
  switch (panel) {
  case Panel::messages:
  case Panel::scan:
  case Panel::recorder:
  case Panel::calibration:
  case Panel::steps:
  case Panel::align:
    return true;
  case Panel::timeline:
  case Panel::findings:
    return state.scan;
  case Panel::profile:
    return tabInFront(state) == Tab::library ? state.chosen_texture : state.texture;
  case Panel::cost_profile:
    return state.path;
  case Panel::display:
  case Panel::mesh:
    return state.content != Content::nothing;
  case Panel::colors:
    return scene && state.colored && (state.desk != Desk::align || state.path);
  case Panel::measure:
    return scene && (state.tool.handling == InteractionMode::measure ||
                     state.tool.handling == InteractionMode::pin);
  case Panel::tool:
    return scene && !paints;
  case Panel::brush:
    return scene && paints;
  case Panel::relief:
    return scene && (state.relief || (paints && state.tool.tool == Tool::relief));
  case Panel::history:
    return scene && !showsSequence(state) && state.undoable + state.redoable > 0;
  default:
    return scene;
  }
}

std::vector<Tab> tabsThere(const WindowState& state) {
  std::vector<Tab> tabs;
  for (const TabRow& row : tabRows())
    for (const Panel panel : rowOf(state.desk).panels)
      if (tabOf(panel) == row.tab && !has(tabs, row.tab) && isThere(panel, state))
        tabs.push_back(row.tab);
  return tabs;
}

std::vector<Panel> pagesThere(const WindowState& state) {
  std::vector<Panel> pages;
  for (const Panel panel : rowOf(state.desk).panels)
    if (inBottomPanel(panel) && isThere(panel, state)) pages.push_back(panel);
  return pages;
}

Tab tabInFront(const WindowState& state) {
  return orFirst(state.tab, tabsThere(state));
}

Panel pageInFront(const WindowState& state) {
  return orFirst(state.page, pagesThere(state));
}

bool isShown(Panel panel, const WindowState& state) {
  if (!isThere(panel, state)) return false;
  if (inBottomPanel(panel)) return panel == pageInFront(state);
  const auto tab = tabOf(panel);
  return !tab || *tab == tabInFront(state);
}

bool isEnabled(Command command, const WindowState& state) {
  switch (command) {
  case Command::save:
  case Command::save_as:
  case Command::export_scene:
  case Command::export_mesh:
  case Command::export_video:
  case Command::record:
    return state.open;
  case Command::export_relief:
    return state.open && state.relief;
  case Command::undo:
    return state.undoable > 0 && !showsSequence(state);
  case Command::redo:
    return state.redoable > 0 && !showsSequence(state);
  case Command::paint:
    return state.content == Content::scene;
  }
  return false;
}

QString titleOf(const WindowState& state) {
  if (showsSequence(state)) return tr("The toy's scan – Patina");
  if (state.name.isEmpty()) return QStringLiteral("Patina[*]");
  const bool never = state.unsaved && !state.in_folder;
  return (never ? tr("%1 (never saved)[*] – Patina") : QStringLiteral("%1[*] – Patina"))
      .arg(state.name);
}

} // namespace patina
