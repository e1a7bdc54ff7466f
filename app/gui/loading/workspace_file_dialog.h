// A file dialog that treats a workspace folder as a file. A scan folder can be opened, or entered
// by a double click, because it may contain a mesh.
#pragma once

#include <filesystem>

#include <QFileDialog>

namespace patina {

class WorkspaceFileDialog : public QFileDialog {
  Q_OBJECT
 public:
  enum class For { opening, saving };
  WorkspaceFileDialog(QWidget* parent, const QString& title, For purpose);

 signals:
  void chosen(const QString& path);

 protected:
  void accept() override;

 private:
  bool take(const QString& path); // False: it is no workspace.
};

// Returns "cup.patina", or "cup-2.patina" if that exists.
QString freeName(const std::filesystem::path& folder, const QString& name);
// Returns the workspace that contains a path; empty: none.
std::filesystem::path workspaceAround(const std::filesystem::path& path);

} // namespace patina
