// The card of the Align desk: which path, its pose on the mesh, its distance from it.
#pragma once

#include <array>

#include <QCheckBox>
#include <QComboBox>

#include "app/gui/aligning/alignment.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/value_row.h"
#include "geometry/mesh/pose_values.h"

namespace patina {

class AlignPanel : public QWidget {
  Q_OBJECT
 public:
  explicit AlignPanel(QWidget* parent = nullptr);

  void setScans(const QStringList& names);                // Scans of the scene that have a path.
  void setPath(const QString& name, std::size_t samples); // samples = 0: no path.
  void setReady(bool ready, bool works); // ready: path and mesh are there. works: a fit is running.
  void setValues(const PoseValues& values, double reach); // reach: limit of the shifts [m].
  void setResiduals(const Residuals& residuals);
  bool linesShown() const { return lines_->isChecked(); }
  bool mapShown() const { return map_->isChecked(); }
  bool nextShown() const { return next_->isChecked(); }
  void setStretch(double times); // Factor of the lines' length; 0: no lines.
  void setFit(const QString& words) { say(fit_words_, words); }
  // Words about the next stroke; empty: none.
  void setNext(const QString& words) { say(next_words_, words); }
  void setPicking(const QString& words); // The next place to click; empty: picking is over.

 signals:
  void openRequested();
  void edited(const patina::PoseValues& values);
  void pickToggled(bool on);
  void fitRequested();
  void beginRequested();
  void keepRequested();
  void storeRequested();
  void shownChanged();
  void scanChosen(const QString& name);

 private:
  PoseValues values() const;

  QLabel *path_, *off_, *fit_words_, *next_words_, *hint_;
  std::array<ValueRow*, 6> rows_;
  QPushButton *pick_, *fit_, *begin_, *keep_, *store_;
  QComboBox* scans_;
  QCheckBox *lines_, *map_, *next_;
  QWidget *place_, *error_;
};

} // namespace patina
