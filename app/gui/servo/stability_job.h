// The stability map of what is open, made behind the picture (MATH 2.1.7).
#pragma once

#include <memory>

#include <QObject>
#include <QString>
#include <QTimer>

#include "app/gui/window/background.h"
#include "session/build/surface_stability.h"

namespace patina {

class StabilityJob : public QObject {
  Q_OBJECT
 public:
  explicit StabilityJob(QObject* parent = nullptr);

  // Soon, so that a slider that is dragged does not begin a map for each of its places; what was
  // asked for before is dropped. nullptr: nothing is wanted.
  void request(std::shared_ptr<const CompiledScene> scene);
  bool busy() const { return jobs_.busy() || timer_.isActive(); }
  bool resting() const { return jobs_.resting(); }
  void cancel();

 signals:
  void said(const QString& words); // how far it is, or what the map says
  void done(std::shared_ptr<const patina::SurfaceStability> stability);
  void rested();

 private:
  void begin();

  std::shared_ptr<const CompiledScene> scene_;
  QTimer timer_;
  Background jobs_;
};

} // namespace patina
