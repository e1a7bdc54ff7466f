// The servo and the scene in one line: what runs, how well, and what it costs.
#pragma once

#include <QStatusBar>

#include "app/gui/widgets/elided_label.h"
#include "haptics/servo/servo_loop.h"
#include "session/build/session.h"

namespace patina {

class StatusLine : public QObject {
  Q_OBJECT
 public:
  explicit StatusLine(QStatusBar* bar);
  void showScene(const CompiledScene* scene); // nullptr: no scene, no stage
  // held_back: why a device gives no force; empty: it does.
  void showTiming(const ServoTiming& timing, bool running);
  // Why there is no force, or not all of it, in place of the rate from now on; empty: there is.
  // True where it is new, and there is a reason: the label must be drawn.
  bool showHeldBack(const QString& words);
  void showFault(bool on);               // the force jumped and was faded to zero (F13)
  void showPicked(const QString& words); // what is under the pointer; empty: nothing

 private:
  void showStabilisers(const CompiledScene& scene);

  QLabel* fault_;
  QLabel* rate_;
  QString held_back_;
  QLabel* late_;
  QLabel* missed_;
  QLabel* policy_;
  ElidedLabel* stages_;
  QLabel* stabilisers_;
  QLabel* bytes_;
  ElidedLabel* picked_;
};

} // namespace patina
