// What happens on the edit thread, gathered until somebody asks: bounded, however seldom that is.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "session/build/compile_scene.h"

namespace patina {

// Where the history stands, and what of it is in the workspace's folder.
struct EditStatus {
  std::vector<std::string> edits; // of all edits, oldest first
  std::size_t done = 0;           // how many of them are done; the others can be redone
  bool unsaved = false;
  std::optional<std::filesystem::path> folder{}; // absent: the scene has none of its own
  bool operator==(const EditStatus&) const = default;
};

// What an edit that takes its time is at.
struct EditProgress {
  std::string title; // "Merging the objects"
  double fraction = 0;
  std::string what;
};

// All that has happened since the last time, however many edits that were.
struct EditEvents {
  std::shared_ptr<const CompiledScene> compiled; // null: the scene is as it was
  bool anew = false;                             // it is another scene: see EditThread::adopt()
  std::shared_ptr<const EditStatus> status;      // null: as it was
  std::optional<EditProgress> progress;          // absent: nothing that takes time is under way
  std::vector<std::string> problems;             // one line each: what could not be done, and why
  std::vector<std::function<void()>> done;       // to be called, in this order
};

// Any thread.
class EditEventBuffer {
 public:
  explicit EditEventBuffer(std::function<void()> wake) : wake_(std::move(wake)) {}

  void addScene(std::shared_ptr<const CompiledScene> compiled, bool anew);
  void setStatus(std::shared_ptr<const EditStatus> status);
  void setProgress(std::optional<EditProgress> progress);
  void addProblem(const std::string& line);
  void addDone(std::function<void()> then);
  EditEvents take();

 private:
  template <typename Change> void change(Change&& change);

  std::function<void()> wake_;
  std::mutex mutex_;
  EditEvents events_;
  bool woken_ = false;
};

} // namespace patina
