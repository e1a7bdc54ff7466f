// Plots force and accelerations of the probe over time, the findings and the cursor.
#pragma once

#include "app/gui/scanning/open_scan.h"
#include "app/gui/toolkit/plot.h"

namespace patina {

class ScanTraces : public PlotWidget {
  Q_OBJECT
 public:
  explicit ScanTraces(OpenScan& scan, QWidget* parent = nullptr);

 protected:
  void resizeEvent(QResizeEvent*) override { describe(); } // The number of pixels has changed.

 private:
  void describe();

  OpenScan& scan_;
};

} // namespace patina
