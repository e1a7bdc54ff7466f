// Runs the servo on the open scene, passes on its samples and records them.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <QObject>
#include <QString>
#include <QTimer>

#include "app/gui/panels/message_panel.h"
#include "app/gui/servo/live_plots.h"
#include "app/gui/servo/recording.h"
#include "app/gui/toolkit/background.h"
#include "haptics/device/device_mount.h"
#include "haptics/link/device_clock.h"
#include "haptics/link/link_statistics.h"
#include "haptics/servo/tip_servo.h"
#include "scene/scene.h"
#include "scene/tool_sample.h"
#include "session/open/surface_stability.h"

namespace patina {

// Computes the stability map of the open scene in the background (MATH 2.1.7).
class StabilityJob : public QObject {
  Q_OBJECT
 public:
  explicit StabilityJob(QObject* parent = nullptr);

  // Starts after a short delay and replaces earlier requests. nullptr: no map.
  void request(std::shared_ptr<const CompiledScene> scene);
  void cancel() {
    timer_.stop();
    jobs_.discardResult();
  }

 signals:
  void notified(const QString& words); // Progress, or a summary of the map.
  void done(std::shared_ptr<const patina::SurfaceStability> stability);

 private:
  void begin();

  std::shared_ptr<const CompiledScene> scene_;
  QTimer timer_;
  Background jobs_{this};
};

class FeelController : public QObject {
  Q_OBJECT
 public:
  struct Parts {
    QWidget& window; // Parent of dialogs.
    ForcePlot& force;
    EnergyPlot& energy;
  };
  FeelController(const Parts& parts, QObject* parent)
      : QObject(parent), at_(parts), stability_(this) {}
  ~FeelController() override { servo_.close(); }

  TipServo& servo() { return servo_; }
  StabilityJob& stability() { return stability_; }
  // Why the device gives no force, in one line; empty: it does.
  const QString& inhibitText() const { return held_back_; }
  // User settings: force off, or only while a button of the device is held.
  void setForce(bool on) {
    controls_->enabled = on;
    emit forceSet(on);
  }
  void setNeedsButton(bool on) {
    needs_button_ = on;
    if (notes_) notes_->requires_deadman = on;
  }
  bool hasOwnHand() const { return notes_ != nullptr; } // A device moves the tip.
  const ToolSample& sample() const { return sample_; }
  void open(const Scene& scene, const Vec3& start);
  void place(const Scene& scene, const Vec3& tip); // Moves the tip without a path between.
  void close(); // Samples that are still queued are collected first.
  // Shows why there is no force. Must be called regularly, or the device stops the force.
  void checkDevice();
  void collect(); // Takes the new samples; called on each tick of the window.

  bool recording() const { return recording_.on(); }
  double recordedSeconds() const { return recording_.log() ? recording_.log()->seconds() : 0; }
  void toggleRecording();  // Starts, or stops and saves.
  bool confirmRecording(); // Asks to save or discard; false: cancelled.
  void keepForRecovery() { recording_.keepForRecovery(); } // At exit, for the next start.
  void recover(const std::filesystem::path& place); // Saves what a killed program has recorded.
  // Starts a table beside it, which needs no saving. Throws FileError.
  void startLog(const std::filesystem::path& path);
  SampleLog* log() { return log_ ? &*log_ : nullptr; } // nullptr: not started.

 signals:
  void collected(const std::vector<patina::ToolSample>& samples); // The list may be empty.
  void failed(const QString& problem);
  void changed();
  void forceSet(bool on);
  void notified(const patina::Message& message);

 private:
  void startRecording();
  // Asks for a file and writes it. False: not written, the recording stays.
  bool saveTable(const std::function<void(const std::filesystem::path&)>& save);
  bool saveRecording();
  void checkDisk(); // Says once that ticks cannot be written.

  Parts at_;
  TipServo servo_;
  std::shared_ptr<LinkStatistics> notes_; // State reported by the device's thread, or nullptr.
  std::shared_ptr<MountControls> controls_ = std::make_shared<MountControls>();
  bool needs_button_ = false;
  std::shared_ptr<DeviceClock> clock_ = systemClock(); // Clock of the notes.
  QString held_back_;
  StabilityJob stability_;
  ToolSample sample_;
  Recording recording_{stateFolder()};
  std::optional<SampleLog> log_;
  QString disk_problem_;
};

} // namespace patina
