// What the open scan holds, in figures, and how it is shown.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QGridLayout>
#include <QGroupBox>
#include <QPushButton>

#include "app/gui/scanning/open_scan.h"
#include "app/gui/scanning/scan_drawing.h"

namespace patina {

class ScanPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit ScanPanel(OpenScan& scan, QWidget* parent = nullptr);

  PathColor color() const { return static_cast<PathColor>(color_->currentIndex()); }
  bool showsMesh() const { return mesh_->isChecked(); }
  bool showsCamera() const { return camera_->isChecked(); }
  void setHasMesh(bool has);
  void refresh();

 signals:
  void openAsked();
  void keepAsked();
  void textureAsked();
  void closeAsked();
  void shownChanged();

 private:
  void row(const QString& caption, const QString& value, const QString& tip = {});
  void fill();

  OpenScan& scan_;
  QWidget* figures_ = nullptr;
  QGridLayout* grid_ = nullptr;
  QWidget* shown_;
  QComboBox* color_;
  QCheckBox *mesh_, *camera_;
  QPushButton *open_, *keep_, *texture_, *close_;
};

} // namespace patina
