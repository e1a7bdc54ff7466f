// An edit thread with somebody who waits for its events.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <unistd.h>

#include "geometry/mesh/shapes.h"
#include "session/edit/edit_thread.h"

namespace patina::test {

inline Scene oneBall(int resolution = 50, int frequency = 8) {
  Scene scene;
  scene.field.resolution = resolution;
  scene.paint_size = 128;
  scene.objects.push_back({"ball",
                           std::make_shared<const TriangleMesh>(icosphere(0.02, frequency)),
                           Pose::Identity(),
                           {}});
  return scene;
}

inline Brush stiffBrush(double value = 900) {
  Brush brush;
  brush.tool = Tool::material(MaterialChannel::stiffness);
  brush.value = value;
  brush.radius = 0.005;
  brush.falloff = 8;
  return brush;
}

// Along a circle of latitude, `count` of them from t = 0 on.
inline std::vector<StrokeSample> circle(int count, double from = 0, double to = 1) {
  std::vector<StrokeSample> samples;
  for (int i = 0; i < count; ++i) {
    const double angle = from + (to - from) * i / std::max(1, count - 1);
    samples.push_back(
        {i / 120.0, 0.02 * Vec3(std::cos(angle), std::sin(angle), 0.1).normalized(), 0.5});
  }
  return samples;
}

class Desk {
 public:
  explicit Desk(std::filesystem::path autosave_root = {},
                std::function<void(const CompiledScene&)> publish = {})
      : edits({std::move(publish), [this] { wake(); }, std::move(autosave_root)}) {}

  // A new editor of the scene, as a loader makes it.
  void open(Scene scene) {
    Progress progress;
    edits.adopt(std::make_unique<Editor>(std::move(scene), progress, edits.listener()));
    waitUntil([this] { return compiled != nullptr; });
  }

  // The workspace, as its own.
  void openFolder(const std::filesystem::path& folder) {
    Progress progress;
    edits.adopt(Editor::open(folder, {}, progress, edits.listener()));
    waitUntil([&] { return compiled && status.folder == folder; });
  }

  // Takes events until it is so; false after 20 s.
  bool waitUntil(const std::function<bool()>& so) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    for (;;) {
      takeEvents();
      if (so()) return true;
      std::unique_lock lock(mutex_);
      if (!woken_.wait_until(lock, end, [this] { return changed_; })) return false;
    }
  }
  // What was asked for so far is done, and its events taken.
  bool settle() {
    bool done = false;
    edits.goTo(1000000, [&](const EditOutcome&) { done = true; }); // nothing to redo: in its turn
    return waitUntil([&] { return done; });
  }
  void takeEvents() {
    {
      const std::lock_guard lock(mutex_);
      changed_ = false;
    }
    EditEvents events = edits.take();
    if (events.compiled) compiled = events.compiled;
    if (events.status) status = *events.status;
    problems.insert(problems.end(), events.problems.begin(), events.problems.end());
    for (const auto& then : events.done) then();
  }

  std::shared_ptr<const CompiledScene> compiled;
  EditStatus status;
  std::vector<std::string> problems;

 private:
  void wake() {
    {
      const std::lock_guard lock(mutex_);
      changed_ = true;
    }
    woken_.notify_one();
  }
  std::mutex mutex_;
  std::condition_variable woken_;
  bool changed_ = false;

 public:
  EditThread edits; // last: it wakes what stands above
};

// A folder of a test's own, gone with it.
class Folder {
 public:
  Folder() {
    char name[] = "/tmp/patina-desk-XXXXXX";
    path_ = mkdtemp(name);
  }
  ~Folder() {
    std::error_code code;
    std::filesystem::remove_all(path_, code);
  }
  Folder(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

} // namespace patina::test
