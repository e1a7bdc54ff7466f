// What of a scan is missing or was left out, a line each; a click goes there.
#pragma once

#include <QListWidget>

#include "app/gui/scanning/open_scan.h"

namespace patina {

class FindingList : public QListWidget {
  Q_OBJECT
 public:
  explicit FindingList(OpenScan& scan, QWidget* parent = nullptr);

 private:
  void fill();
  void follow(); // the cursor

  OpenScan& scan_;
};

} // namespace patina
