// An edit thread with a client that waits for its events.
#pragma once

#include <atomic>
#include <chrono>
#include <cmath>
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

// Samples along a circle of latitude, `count` of them from t = 0 on.
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
      : edits({std::move(publish), [this] { wake(); }, std::move(autosave_root),
               [this](std::vector<ToolSample>& into) { takeTicks(into); }}) {}

  // Presses the tip along the samples with this brush.
  void press(const Brush& brush, const std::vector<StrokeSample>& samples) {
    edits.paint({true, samples.front().position, 1, 1}, brush);
    move(samples);
  }
  // Adds the servo's ticks along the samples.
  void move(const std::vector<StrokeSample>& samples) {
    const std::lock_guard lock(mutex_);
    for (const StrokeSample& sample : samples) {
      ToolSample tick;
      tick.t = time_ + sample.t;
      tick.contact = true;
      tick.surface = tick.tip = sample.position;
      tick.force = {sample.force, 0, 0};
      ticks_.push_back(tick);
    }
    time_ = std::ceil(time_ + samples.back().t) + 1;
  }
  // Does the same and lifts the tip.
  void stroke(const Brush& brush, const std::vector<StrokeSample>& samples) {
    press(brush, samples);
    edits.finishPainting();
  }

  // Opens a new editor of the scene, like a loader.
  void open(Scene scene) {
    Progress progress;
    edits.adopt(std::make_unique<Editor>(std::move(scene), progress, edits.listener()));
    waitUntil([this] { return compiled != nullptr; });
  }

  // Opens the workspace as the editor's own folder.
  void openFolder(const std::filesystem::path& folder) {
    Progress progress;
    edits.adopt(Editor::open(folder, {}, progress, edits.listener()));
    waitUntil([&] { return compiled && status.folder == folder; });
  }

  // Takes events until the condition holds; returns false after 20 s.
  bool waitUntil(const std::function<bool()>& so) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    for (;;) {
      takeEvents();
      if (so()) return true;
      std::unique_lock lock(mutex_);
      if (!woken_.wait_until(lock, end, [this] { return changed_; })) return false;
    }
  }
  // Waits until all requests are done and takes their events.
  bool settle() {
    bool done = false;
    edits.goTo(1000000, [&](const EditOutcome&) { done = true; }); // nothing to redo
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
  void takeTicks(std::vector<ToolSample>& into) {
    const std::lock_guard lock(mutex_);
    into.insert(into.end(), ticks_.begin(), ticks_.end());
    ticks_.clear();
  }

  std::mutex mutex_;
  std::condition_variable woken_;
  bool changed_ = false;
  std::vector<ToolSample> ticks_;
  double time_ = 0; // servo time of the next tick [s]

 public:
  EditThread edits; // declared last: it wakes the members above
};

// A temporary folder that is removed with the test.
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
