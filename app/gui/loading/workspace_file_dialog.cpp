#include "app/gui/loading/workspace_file_dialog.h"

#include <QFileInfo>

#include "scan/scan_files.h"
#include "workspace/workspace.h"

namespace patina {
WorkspaceFileDialog::WorkspaceFileDialog(QWidget* parent, const QString& title, For purpose)
    : QFileDialog(parent, title) {
  setOption(QFileDialog::DontUseNativeDialog); // A native dialog would enter the folder.
  setOption(QFileDialog::DontConfirmOverwrite);
  setAcceptMode(purpose == For::saving ? AcceptSave : AcceptOpen);
  setFileMode(purpose == For::saving ? AnyFile : ExistingFile);
  connect(this, &QFileDialog::directoryEntered, this, [this](const QString& path) {
    if (!isWorkspace(path.toStdString())) return;
    setDirectory(QFileInfo(path).absolutePath());
    take(path);
  });
}

bool WorkspaceFileDialog::take(const QString& path) {
  if (!isWorkspace(path.toStdString())) return false;
  done(Accepted);
  emit chosen(path);
  return true;
}

void WorkspaceFileDialog::accept() {
  const QStringList files = selectedFiles();
  if (files.isEmpty() || take(files.front())) return;
  const bool is_scan = acceptMode() == AcceptOpen && isScanFolder(files.front().toStdString());
  const bool is_file = acceptMode() == AcceptSave || QFileInfo(files.front()).isFile();
  if (!is_scan && (!is_file || QFileInfo(files.front()).isDir())) return QFileDialog::accept();
  done(Accepted);
  emit chosen(files.front());
}

QString freeName(const std::filesystem::path& folder, const QString& name) {
  const QString stem = QFileInfo(name).completeBaseName();
  const QString first = (stem.isEmpty() ? QStringLiteral("scene") : stem) + ".patina";
  QString free = first;
  for (int number = 2; std::filesystem::exists(folder / free.toStdString()); ++number)
    free = QStringLiteral("%1-%2.patina").arg(first.left(first.size() - 7)).arg(number);
  return free;
}

std::filesystem::path workspaceAround(const std::filesystem::path& path) {
  for (auto folder = std::filesystem::absolute(path).parent_path(); folder.has_relative_path();
       folder = folder.parent_path())
    if (isWorkspace(folder)) return folder;
  return {};
}

} // namespace patina
