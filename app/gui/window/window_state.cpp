#include "app/gui/window/window_state.h"

#include <QCoreApplication>

namespace patina {

bool isShown(Panel panel, const WindowState& state) {
  const bool scene = state.content == Content::scene;
  const bool paints = state.tool.handling == Handling::paint;
  switch (panel) {
  case Panel::recovery:
    return state.left_behind.has_value();
  case Panel::warnings:
    return !state.warnings.isEmpty();
  case Panel::brush:
    return scene && paints;
  case Panel::relief:
    return scene && (state.relief || (paints && state.tool.tool == Tool::relief));
  case Panel::display:
  case Panel::mesh:
    return state.content != Content::nothing;
  case Panel::paint:
    return state.paint;
  case Panel::history:
    return scene && state.undoable + state.redoable > 0;
  case Panel::touch:
  case Panel::device:
  case Panel::objects:
    return scene;
  }
  return false;
}

bool isEnabled(Command command, const WindowState& state) {
  switch (command) {
  case Command::save:
  case Command::save_as:
  case Command::record:
    return state.open;
  case Command::undo:
    return state.undoable > 0;
  case Command::redo:
    return state.redoable > 0;
  case Command::paint:
    return state.content == Content::scene;
  }
  return false;
}

QString titleOf(const WindowState& state) {
  return state.name.isEmpty() ? QStringLiteral("Patina[*]")
                              : QStringLiteral("%1[*] – Patina").arg(state.name);
}

} // namespace patina
