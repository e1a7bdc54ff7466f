// What the window is at, as one value, and what of the window follows from it.
#pragma once

#include <filesystem>
#include <optional>

#include <QString>

#include "app/gui/window/guide_strip.h"

namespace patina {

// The 3D view holds nothing, the mesh of a file that is still being opened, or a scene.
enum class Content { nothing, preview, scene };

// Something that takes its time.
struct Work {
  QString title;       // the same while it lasts
  QString words;       // what it is at
  double fraction = 0; // below 0: nobody knows, and it cannot be cancelled
  bool later = false;  // seen only if it lasts
  bool operator==(const Work&) const = default;
};

struct WindowState {
  Content content = Content::nothing;
  bool open = false; // a scene is, though a preview may stand before it
  Desk desk = Desk::feel;
  Tab tab = Tab::surface;     // of the column; another is in front where it has nothing to show
  Panel page = Panel::forces; // of the drawer; the same
  ToolChoice tool;
  bool relief = false, paint = false; // the scene has some
  bool scan = false;                  // one is open
  bool sequence = false;              // from a scan to a feel on the toy, begun
  bool texture = false;               // one was fitted
  bool chosen_texture = false;        // one of the library is
  bool path = false;                  // there is one on a mesh, to be aligned
  GuideFacts guide;                   // how far a scan has come to a feel
  std::size_t undoable = 0, redoable = 0;
  bool unsaved = false;
  bool in_folder = false; // of its own, where it can be saved
  bool recording = false;
  QString name; // of what is seen; empty: nothing is
  std::optional<Work> work;
  std::optional<std::filesystem::path> left_behind; // by a crash, and offered
};

// The toy of the sequence is, and not what is open: no history, no step of the guide is its.
bool showsSequence(const WindowState& state);
bool isWelcome(const WindowState& state);            // nothing is open, nor about to be
bool isSeen(const WindowState& state);               // what is opened, or the page to begin from
bool isThere(Panel panel, const WindowState& state); // the desk has it, and a use for it
bool isShown(Panel panel, const WindowState& state); // it is in front as well
Tab tabInFront(const WindowState& state);
Panel pageInFront(const WindowState& state);
std::vector<Tab> tabsThere(const WindowState& state);
std::vector<Panel> pagesThere(const WindowState& state);

enum class Command { save, save_as, export_scene, record, undo, redo, paint };
bool isEnabled(Command command, const WindowState& state);

QString titleOf(const WindowState& state); // with the place of the mark of what is unsaved

} // namespace patina
