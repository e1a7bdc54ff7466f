// What goes into the desk and out of it: files, and scans of the scene.
#include <QFileDialog>

#include "acquisition/files/registered_file.h"
#include "acquisition/files/scan_files.h"
#include "app/gui/aligning/align_desk.h"
#include "app/gui/aligning/aligned_scan.h"
#include "app/gui/loading/load_dialogs.h"
#include "core/error.h"
#include "core/file.h"
#include "geometry/io/pose_file.h"

namespace patina {

void AlignDesk::openPath(const std::filesystem::path& file) {
  try {
    setPath(QString::fromStdString(file.filename().string()), readPath(file));
  } catch (const Error& error) {
    showProblem(&window_, tr("The path cannot be read"), QString::fromStdString(error.what()),
                tr("What was open before is as it was."));
  }
}

void AlignDesk::offerMesh(const std::filesystem::path& file) {
  offered_ = file;
  offer_->setText(tr("Open the scan's %1").arg(QString::fromStdString(file.filename().string())));
  offer_->setVisible(!offered_.empty() && !alignment_.path().empty());
}

void AlignDesk::setScans(std::shared_ptr<const Scene> scene) {
  scene_ = std::move(scene);
  QStringList names;
  if (scene_)
    for (const SceneScan& scan : scene_->scans)
      if (scan.text("path.csv")) names.push_back(QString::fromStdString(scan.name));
  panel_->setScans(names);
  panel_->setReady(alignment_.isReady(), work_.has_value());
}

void AlignDesk::openScan(const QString& name) {
  const SceneScan* scan = scene_ ? findScan(*scene_, name.toStdString()) : nullptr;
  if (scan == nullptr) return;
  try {
    AlignedPath stored = alignedPathOf(*scan);
    setPath(name, std::move(stored.path));
    if (!stored.mesh_from_path || !alignment_.isReady()) return;
    move(*stored.mesh_from_path);
    settle();
  } catch (const Error& error) {
    showProblem(&window_, tr("The path cannot be read"), QString::fromStdString(error.what()),
                tr("What was open before is as it was."));
  }
}

void AlignDesk::store() {
  if (scene_ && alignment_.isReady()) emit storeAsked(alignedScan(name_.toStdString(), alignment_));
}

void AlignDesk::openDialog() {
  auto* dialog =
      new QFileDialog(&window_, tr("Open a scan's path"), {}, tr("Paths (*.csv);;All files (*)"));
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::ExistingFile);
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& file) { openPath(file.toStdString()); });
  dialog->open();
}

void AlignDesk::keepDialog() {
  auto* dialog =
      new QFileDialog(&window_, tr("Keep the path on the mesh"), {}, tr("Paths (*.csv)"));
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->setDefaultSuffix(QStringLiteral("csv"));
  dialog->selectFile(QStringLiteral("registered.csv"));
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& file) { keep(file.toStdString()); });
  dialog->open();
}

void AlignDesk::keep(const std::filesystem::path& file) {
  try {
    const auto pose = std::filesystem::path(file).replace_extension(".txt");
    writeRegisteredPath(file, alignment_.path(),
                        registeredAt(*alignment_.target(), alignment_.path(), alignment_.pose()));
    writeFileAtomically(pose, poseText(alignment_.pose(), "mesh_from_scan"));
    emit said({tr("The path on the mesh is in %1, its pose in %2")
                   .arg(QString::fromStdString(file.string()),
                        QString::fromStdString(pose.filename().string()))});
  } catch (const Error& error) {
    showProblem(&window_, tr("The path cannot be kept"), QString::fromStdString(error.what()),
                tr("Make room, or choose another folder."));
  }
}

} // namespace patina
