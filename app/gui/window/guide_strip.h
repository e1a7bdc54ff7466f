// The steps of a job in a line, from a scan to a feel: what is done, what is open, one figure each.
// A click on a step goes to its desk. It can be closed, and stays so at the next start.
#pragma once

#include <optional>
#include <vector>

#include <QLabel>
#include <QToolButton>
#include <QWidget>

#include "app/gui/window/desk.h"

namespace patina {

// How far the job is; what is absent was not come to.
struct GuideFacts {
  std::size_t frames = 0, poses = 0; // of the scan that is open
  std::size_t samples = 0;           // of a path, on a mesh or not yet
  std::optional<double> off;         // rms of what counts from the mesh, where a fit put it [m]
  std::size_t faces = 0;             // that have a texture
  double force = 0;                  // the greatest that was felt [N]
  QString doubt{};                   // why the fit is not sure of the place; empty: it is
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

  void show(const GuideFacts& facts, bool here); // here: the desk that is up belongs to the job
  void setOpen(bool open);                       // by a person
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
