// The card of the Align desk: which path, where it lies on the mesh, how far off it is.
#pragma once

#include <array>

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QWidget>

#include "app/gui/aligning/alignment.h"
#include "app/gui/panels/value_row.h"
#include "geometry/mesh/pose_values.h"

namespace patina {

class AlignPanel : public QWidget {
  Q_OBJECT
 public:
  explicit AlignPanel(QWidget* parent = nullptr);

  void setScans(const QStringList& names);                // of the scene, that have a path
  void setPath(const QString& name, std::size_t samples); // 0: there is none
  void setReady(bool ready, bool works);                  // there is something to align; or not now
  void setValues(const PoseValues& values, double reach); // [m] that shifts may be
  void setResiduals(const Residuals& residuals);
  bool linesShown() const { return lines_->isChecked(); }
  bool mapShown() const { return map_->isChecked(); }
  void setStretch(double times);         // of the lines; 0: there are none
  void setFit(const QString& words);     // of a registration; empty: none
  void setPicking(const QString& words); // what is to be clicked; empty: it is over

 signals:
  void openAsked();
  void edited(const patina::PoseValues& values);
  void pickToggled(bool on);
  void fitAsked();
  void beginAsked();
  void keepAsked();
  void storeAsked();
  void shownChanged(); // lines or map
  void scanChosen(const QString& name);

 private:
  PoseValues values() const;

  QLabel *path_, *off_, *fit_words_, *hint_;
  std::array<ValueRow*, 6> rows_;
  QPushButton *pick_, *fit_, *begin_, *keep_, *store_;
  QComboBox* scans_;
  QCheckBox *lines_, *map_;
  QWidget *place_, *error_;
};

} // namespace patina
