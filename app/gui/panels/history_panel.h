// Lists the edits, oldest first; a click goes there.
#pragma once

#include <QListWidget>

#include "session/edit/edit_thread.h"

namespace patina {

class HistoryPanel : public QListWidget {
  Q_OBJECT
 public:
  explicit HistoryPanel(QWidget* parent = nullptr);
  void show(const EditStatus& status);

 signals:
  void positionRequested(std::size_t position); // Requests that this many edits are done.

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void mark(); // Marks the undone edits.

  std::size_t done_ = 0;
  std::vector<std::string> edits_;
};

} // namespace patina
