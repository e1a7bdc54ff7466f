// The state of the window as one value, and what is shown and enabled in that state.
#pragma once

#include <filesystem>
#include <optional>

#include <QString>

#include "app/gui/state/guide_strip.h"

namespace patina {

// Content of the 3D view: nothing, the mesh of a file being opened, or a scene.
enum class Content { nothing, preview, scene };

// Progress of a running task.
struct TaskProgress {
  QString title;        // Constant during the task.
  QString words;        // The current step.
  double fraction = 0;  // -1: unknown, and the task cannot be cancelled.
  bool delayed = false; // Shown only if it lasts.
  bool operator==(const TaskProgress&) const = default;
};

struct WindowState {
  Content content = Content::nothing;
  bool open = false; // A scene is open, even behind a preview.
  Desk desk = Desk::feel;
  Tab tab = Tab::surface;     // Tab of the side panel, unless it has nothing to show.
  Panel page = Panel::forces; // Tab of the bottom panel, likewise.
  ToolChoice tool;
  bool relief = false;         // The scene has it.
  bool colored = false;        // The selected thing has colours.
  bool scan = false;           // A scan is open.
  bool sequence = false;       // The demonstration was started.
  bool texture = false;        // A texture was fitted.
  bool chosen_texture = false; // A texture of the library is selected.
  bool path = false;           // There are a path and a mesh to align.
  GuideFacts guide;            // Progress from a scan to haptic rendering.
  std::size_t undoable = 0, redoable = 0;
  bool unsaved = false;
  bool in_folder = false; // It has a folder and can be saved there.
  bool recording = false;
  QString name; // Name of what is shown; empty: nothing.
  std::optional<TaskProgress> work;
  std::optional<std::filesystem::path> recoverable_scenes; // Offered after a crash.
  QString storage_problem; // Why edits do not reach the scene's folder; empty: they do.
};

// True if the demonstration is shown instead of the scene: no history and no guide then.
bool showsSequence(const WindowState& state);
bool isWelcome(const WindowState& state);            // Nothing is open or being opened.
bool isSeen(const WindowState& state);               // The scene, or the welcome page.
bool isThere(Panel panel, const WindowState& state); // The desk has it, and it has content.
bool isShown(Panel panel, const WindowState& state); // It is also in front.
Tab tabInFront(const WindowState& state);
Panel pageInFront(const WindowState& state);
std::vector<Tab> tabsThere(const WindowState& state);
std::vector<Panel> pagesThere(const WindowState& state);

enum class Command {
  save,
  save_as,
  export_scene,
  export_mesh,
  export_relief,
  export_video,
  record,
  undo,
  redo,
  paint
};
bool isEnabled(Command command, const WindowState& state);

// Includes the placeholder for the mark of unsaved edits.
QString titleOf(const WindowState& state);

} // namespace patina
