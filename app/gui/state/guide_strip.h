// Shows the steps from a scan to haptic rendering in a line: what is done, what is open, and a
// figure each. A click opens the step's desk. It stays closed in the next session.
#pragma once

#include <optional>
#include <vector>

#include <QLabel>
#include <QToolButton>
#include <QWidget>

#include "app/gui/state/desk.h"

namespace patina {

// Progress of the job; zero or nullopt: not reached.
struct GuideFacts {
  std::size_t frames = 0, poses = 0; // Counts of the open scan.
  std::size_t samples = 0;           // Samples of a path, aligned or not.
  std::optional<double> off;         // Residual rms of the fit [m].
  std::size_t faces = 0;             // Faces with a texture.
  double force = 0;                  // Largest force so far [N].
  QString doubt{};                   // Why the fitted pose is unreliable; empty: it is not.
  bool operator==(const GuideFacts&) const = default;
};

struct GuideStep {
  Desk desk;
  QString words, tip, figure;
  bool done = false;
};
std::vector<GuideStep> guideSteps(const GuideFacts& facts);

class GuideStrip : public QWidget {
  Q_OBJECT
 public:
  explicit GuideStrip(QWidget* parent = nullptr);

  void show(const GuideFacts& facts, bool here); // here: the desk in front belongs to the job.
  void setOpen(bool open);                       // Used for the user's choice.
  bool isOpen() const { return open_; }

 signals:
  void chosen(patina::Desk desk);
  void openChanged(bool open);

 private:
  std::vector<QToolButton*> steps_;
  std::optional<GuideFacts> shown_;
  bool open_, here_ = false;
};

} // namespace patina
