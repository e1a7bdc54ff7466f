// The one time of the open scan that is looked at, and what there is at it.
#pragma once

#include <optional>

#include <QObject>

#include "app/gui/scanning/scan_path.h"

namespace patina {

class OpenScan;

class ScanCursor : public QObject {
  Q_OBJECT
 public:
  explicit ScanCursor(const OpenScan& scan) : scan_(scan) {}

  double time() const { return time_; } // [s]
  void set(double time);                // within the span of the scan
  void step(int frames);                // of frames, or of what there is in place of them
  void rewind();                        // without moved(): the scan tells that it is another
  std::size_t frame() const;            // nearest; there must be one
  // The finding that holds it, the shortest first; nullptr: none.
  const Finding* finding() const;
  // Where the probe is; nullopt: nobody saw it.
  std::optional<Pose> probe() const;

 signals:
  void moved();

 private:
  const OpenScan& scan_;
  double time_ = 0;
};

} // namespace patina
