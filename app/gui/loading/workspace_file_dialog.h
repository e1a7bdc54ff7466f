// A file dialog that treats a workspace folder as a file. A scan folder can be opened, or entered
// by a double click, because it may contain a mesh.
#pragma once

#include <filesystem>
#include <optional>

#include <QCheckBox>
#include <QComboBox>
#include <QFileDialog>

#include "geometry/mesh/mesh_unit.h"

namespace patina {

class WorkspaceFileDialog : public QFileDialog {
  Q_OBJECT
 public:
  enum class For { opening, saving };
  WorkspaceFileDialog(QWidget* parent, const QString& title, For purpose);
  // Unit and up axis of a mesh file, as chosen below the list; nullopt: millimetres, unless the
  // size is unlikely.
  std::optional<MeshUnit> unit() const;
  UpAxis up() const { return y_up_->isChecked() ? UpAxis::y : UpAxis::z; }

 signals:
  void chosen(const QString& path);

 protected:
  void accept() override;

 private:
  bool take(const QString& path); // False: it is no workspace.
  void addMeshChoices();

  QComboBox* unit_ = nullptr; // Only for opening, as y_up_.
  QCheckBox* y_up_ = nullptr;
};

// Returns "cup.patina", or "cup-2.patina" if that exists.
QString freeName(const std::filesystem::path& folder, const QString& name);
// Returns the workspace that contains a path; empty: none.
std::filesystem::path workspaceAround(const std::filesystem::path& path);

} // namespace patina
