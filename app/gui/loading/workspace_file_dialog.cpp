#include "app/gui/loading/workspace_file_dialog.h"

#include <QFileInfo>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>

#include "app/gui/loading/up_choice.h"
#include "app/gui/toolkit/card.h"
#include "scan/scan_files.h"
#include "workspace/workspace.h"

namespace patina {
WorkspaceFileDialog::WorkspaceFileDialog(QWidget* parent, const QString& title, For purpose)
    : QFileDialog(parent, title) {
  setOption(QFileDialog::DontUseNativeDialog); // A native dialog would enter the folder.
  setOption(QFileDialog::DontConfirmOverwrite);
  setAcceptMode(purpose == For::saving ? AcceptSave : AcceptOpen);
  setFileMode(purpose == For::saving ? AnyFile : ExistingFile);
  beginInLastFolder(*this);
  if (purpose == For::opening) addMeshChoices();
  connect(this, &QFileDialog::directoryEntered, this, [this](const QString& path) {
    if (!isWorkspace(path.toStdString())) return;
    setDirectory(QFileInfo(path).absolutePath());
    take(path);
  });
}

void WorkspaceFileDialog::addMeshChoices() {
  auto* line = new QHBoxLayout;
  unit_ = named(new QComboBox(this), "open_unit", tr("Mesh files contain no unit"));
  unit_->addItems({tr("automatic: mm if likely"), tr("mm"), tr("cm"), tr("m"), tr("inches"),
                   tr("longest side 100 mm")});
  line->addWidget(unit_);
  y_up_ = addButton<QCheckBox>(line, "open_y_up", tr("y points upwards"),
                               tr("Rotates the mesh so that its y axis points up"));
  y_up_->setChecked(rememberedUp() == UpAxis::y);
  line->addStretch(1);
  // The dialog's own rows have labels in the first column.
  auto* grid = qobject_cast<QGridLayout*>(layout());
  const int row = grid->rowCount();
  grid->addWidget(new QLabel(tr("Unit of a mesh:"), this), row, 0);
  grid->addLayout(line, row, 1);
}

std::optional<MeshUnit> WorkspaceFileDialog::unit() const {
  if (unit_->currentIndex() == 0) return std::nullopt;
  return static_cast<MeshUnit>(unit_->currentIndex() - 1);
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
