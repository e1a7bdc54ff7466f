// The state of the servo and the scene in one line.
#pragma once

#include <QStatusBar>

#include "app/gui/toolkit/elided_label.h"
#include "haptics/servo/servo_loop.h"
#include "session/compile/compile_scene.h"

namespace patina {

class StatusLine : public QObject {
  Q_OBJECT
 public:
  explicit StatusLine(QStatusBar* bar);
  void showScene(const CompiledScene* scene); // nullptr: no scene.
  // held_back: why a device gives no force; empty: it does.
  void showTiming(const ServoTiming& timing, bool running);
  // Shows why force is missing, empty: it is not. Returns true for a new reason, to be drawn.
  bool showHeldBack(const QString& words);
  // The force jumped and was faded to zero (F13).
  void showFault(bool on) { fault_->setVisible(on); }
  // Values under the pointer; empty: none.
  void showPicked(const QString& words);

 private:
  void showStabilisers(const CompiledScene& scene);

  QLabel *fault_, *rate_, *late_, *missed_, *policy_, *stabilisers_, *bytes_;
  ElidedLabel *stages_, *picked_;
  QString held_back_;
};

} // namespace patina
