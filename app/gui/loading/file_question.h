// Asks for a file. A workspace is one, though it is a folder: it is chosen, never entered. A scan's
// folder can be opened, and entered by a double click: there may be a mesh in it.
#pragma once

#include <filesystem>

#include <QFileDialog>

namespace patina {

class FileQuestion : public QFileDialog {
  Q_OBJECT
 public:
  enum class For { opening, saving };
  FileQuestion(QWidget* parent, const QString& title, For purpose);

 signals:
  void chosen(const QString& path); // the dialog goes

 protected:
  void accept() override;

 private:
  bool take(const QString& path); // false: it is no workspace
};

// "cup.patina", or "cup-2.patina" where that is taken.
QString freeName(const std::filesystem::path& folder, const QString& name);
// The workspace that a path lies in; empty: none.
std::filesystem::path workspaceAround(const std::filesystem::path& path);

} // namespace patina
