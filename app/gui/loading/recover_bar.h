// Scenes that a crash left behind: offered above the picture, and nothing waits for the answer.
#pragma once

#include <filesystem>
#include <vector>

#include <QLabel>
#include <QWidget>

namespace patina {

class RecoverBar : public QWidget {
  Q_OBJECT
 public:
  explicit RecoverBar(QWidget* parent = nullptr);
  void offer(std::vector<std::filesystem::path> places); // see autosave.h; none: hidden

 signals:
  void recoverAsked(const std::filesystem::path& place);

 private:
  void next();
  void showFirst();

  std::vector<std::filesystem::path> places_; // what is offered comes first
  QLabel* words_;
};

} // namespace patina
