#include "app/gui/loading/file_question.h"

#include <QFileInfo>

#ifdef PATINA_HAS_ACQUISITION
#include "scan/scan_files.h"
#endif
#include "workspace/workspace.h"

namespace patina {
namespace {

bool isScan([[maybe_unused]] const QString& path) {
#ifdef PATINA_HAS_ACQUISITION
  return isScanFolder(path.toStdString());
#else
  return false;
#endif
}

} // namespace

FileQuestion::FileQuestion(QWidget* parent, const QString& title, For purpose)
    : QFileDialog(parent, title) {
  setOption(QFileDialog::DontUseNativeDialog); // a desktop's own would enter the folder
  setOption(QFileDialog::DontConfirmOverwrite);
  setAcceptMode(purpose == For::saving ? AcceptSave : AcceptOpen);
  setFileMode(purpose == For::saving ? AnyFile : ExistingFile);
  connect(this, &QFileDialog::directoryEntered, this, [this](const QString& path) {
    if (!isWorkspace(path.toStdString())) return;
    setDirectory(QFileInfo(path).absolutePath());
    take(path);
  });
}

bool FileQuestion::take(const QString& path) {
  if (!isWorkspace(path.toStdString())) return false;
  done(Accepted);
  emit chosen(path);
  return true;
}

void FileQuestion::accept() {
  const QStringList files = selectedFiles();
  if (files.isEmpty() || take(files.front())) return;
  if (acceptMode() == AcceptOpen && isScan(files.front())) {
    done(Accepted);
    emit chosen(files.front());
    return;
  }
  const bool is_file = acceptMode() == AcceptSave || QFileInfo(files.front()).isFile();
  if (!is_file || QFileInfo(files.front()).isDir()) return QFileDialog::accept();
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
