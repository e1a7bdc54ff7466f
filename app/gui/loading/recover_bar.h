// A scene that a crash left behind: offered below the picture, and nothing waits for the answer.
#pragma once

#include <filesystem>

#include <QWidget>

#include "app/gui/widgets/elided_label.h"

namespace patina {

class RecoverBar : public QWidget {
  Q_OBJECT
 public:
  explicit RecoverBar(QWidget* parent = nullptr);
  void setPlace(const std::filesystem::path& place); // see autosave.h

 signals:
  void recoverAsked();
  void forgetAsked();
  void laterAsked();

 private:
  ElidedLabel* words_;
};

} // namespace patina
