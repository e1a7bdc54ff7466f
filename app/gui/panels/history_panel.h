// Every edit, oldest first; a click goes there.
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
  void asked(std::size_t position); // so many edits are to be done

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void mark(); // what is undone

  std::size_t done_ = 0;
  std::vector<std::string> edits_;
};

} // namespace patina
