// Feels what is open: the servo, what it says, and what is kept of that.
#pragma once

#include <memory>
#include <vector>

#include <QObject>

#include "app/gui/panels/message_panel.h"
#include "app/gui/servo/live_plots.h"
#include "app/gui/servo/recording.h"
#include "app/gui/servo/stability_job.h"
#include "haptics/devices/device_mount.h"
#include "haptics/devices/link/device_clock.h"
#include "haptics/devices/link/link_notes.h"
#include "haptics/servo/tip_servo.h"
#include "scene/scene.h"

namespace patina {

class FeelController : public QObject {
  Q_OBJECT
 public:
  struct Parts {
    QWidget& window; // which questions are asked over
    ForcePlot& force;
    EnergyPlot& energy;
  };
  FeelController(const Parts& parts, QObject* parent);
  ~FeelController() override;

  TipServo& servo() { return servo_; }
  StabilityJob& stability() { return stability_; }
  // What the device's own thread tells; null for a device that has none. And what of it keeps the
  // force back, in one line.
  const LinkNotes* notes() const { return notes_.get(); }
  const QString& heldBack() const { return held_back_; }
  // By a person: none at all, or only while a button of the device is held.
  void setForce(bool on);
  void setNeedsButton(bool on);
  const ToolSample& sample() const { return sample_; } // the last one
  void open(const Scene& scene, const Vec3& start);
  void place(const Scene& scene, const Vec3& tip); // there, as if it had never been elsewhere
  void close();                                    // and nothing that the servo said is lost
  void look();    // at the device, which gives no force to one that nobody watches
  void collect(); // what it has said since the last time; of every window tick

  bool recording() const { return recording_.on(); }
  double recordedSeconds() const { return recording_.seconds(); }
  void toggleRecording(); // begins, or ends and is saved
  bool settleRecording(); // saved or dropped; false: the person goes on
  void startLog();        // a recording of its own
  Recording& log();       // up to this tick

 signals:
  void collected(const std::vector<patina::ToolSample>& samples); // also none
  void failed(const QString& problem);                            // of the device
  void changed();
  void said(const patina::Message& message);

 private:
  bool saveRecording(); // false: not written, the samples are kept

  Parts at_;
  TipServo servo_;
  std::shared_ptr<LinkNotes> notes_;
  std::shared_ptr<MountControls> controls_ = std::make_shared<MountControls>();
  bool needs_button_ = false;
  std::shared_ptr<DeviceClock> clock_ = systemClock(); // that the notes are in
  QString held_back_;
  StabilityJob stability_;
  ToolSample sample_;
  Recording recording_, log_;
};

} // namespace patina
