// The cells of the desk Align: a path over its mesh from four sides, or what is missing for that.
#pragma once

#include <filesystem>

#include <QLabel>
#include <QPushButton>
#include <QStackedWidget>

#include "app/gui/aligning/align_view.h"

namespace patina {

class AlignCells : public QStackedWidget {
  Q_OBJECT
 public:
  AlignCells();

  // That lies beside the path, to be opened where no scene is; empty: none.
  void offerMesh(const std::filesystem::path& file);
  void showMissing(bool has_path); // the mesh is, or both are
  void showMesh(const std::shared_ptr<const TriangleMesh>& mesh);
  void setPicking(bool picks);
  void draw(DrawnPath path, const std::vector<DrawnMark>& marks, const std::optional<Vec3>& handle);
  void setMeshValues(const std::vector<float>& values); // see ScanPicture
  void fit();
  void refresh(); // of every tick of the window

 signals:
  void meshAsked(const QString& file);
  void dragBegun(); // as of each view
  void dragged(const patina::Pose& motion);
  void dropped();
  void clicked(const patina::Ray& sight, double reach);
  void escaped();

 private:
  void makeViews();

  QLabel* empty_ = new QLabel;
  QPushButton* offer_ = new QPushButton;
  std::filesystem::path offered_;
  bool has_path_ = false;
  std::vector<AlignView*> views_; // made with the first path
};

} // namespace patina
