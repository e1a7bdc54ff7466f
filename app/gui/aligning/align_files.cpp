#include "app/gui/aligning/align_files.h"

#include <QMessageBox>

#include "acquisition/files/registered_file.h"
#include "acquisition/files/scan_files.h"
#include "app/gui/loading/load_dialogs.h"
#include "core/error.h"
#include "core/file.h"
#include "geometry/io/pose_file.h"

namespace patina {

AlignFiles::AlignFiles(QWidget& window, const Alignment& alignment, AlignPanel& panel)
    : window_(window), alignment_(alignment), panel_(panel) {
  connect(&panel_, &AlignPanel::openAsked, this, &AlignFiles::openDialog);
  connect(&panel_, &AlignPanel::keepAsked, this, [this] { keepDialog()->open(); });
  connect(&panel_, &AlignPanel::scanChosen, this, &AlignFiles::openScan);
}

void AlignFiles::open(const QString& name, const std::function<AlignedPath()>& read) {
  AlignedPath found;
  try {
    found = read();
  } catch (const Error& error) {
    return showProblem(&window_, tr("The path cannot be read"),
                       QString::fromStdString(error.what()),
                       tr("What was open before is as it was."));
  }
  emit opened(name, found);
}

void AlignFiles::openPath(const std::filesystem::path& file) {
  std::vector<std::string> warnings;
  open(QString::fromStdString(file.filename().string()), [&] {
    return AlignedPath{readPath(file, &warnings), {}};
  });
  for (const std::string& line : warnings) emit said({QString::fromStdString(line), true});
}

void AlignFiles::setScene(std::shared_ptr<const Scene> scene) {
  scene_ = std::move(scene);
  panel_.setScans(scansWithPath());
}

QStringList AlignFiles::scansWithPath() const {
  QStringList names;
  if (scene_)
    for (const SceneScan& scan : scene_->scans)
      if (scan.text("path.csv")) names.push_back(QString::fromStdString(scan.name));
  return names;
}

void AlignFiles::openScan(const QString& name) {
  const SceneScan* scan = scene_ ? findScan(*scene_, name.toStdString()) : nullptr;
  if (scan != nullptr) open(name, [&] { return alignedPathOf(*scan); });
}

void AlignFiles::openFirstScan() {
  if (const QStringList names = scansWithPath(); !names.isEmpty()) openScan(names.front());
}

void AlignFiles::store(const QString& name) {
  if (!scene_ || !alignment_.isReady()) return;
  const SceneScan aligned = alignedScan(name.toStdString(), alignment_);
  emit storeAsked(
      aligned.name, [aligned](const SceneScan* now) { return withAlignment(now, aligned); },
      [this, pose = alignment_.pose()] { emit kept(pose); });
}

void AlignFiles::openDialog() {
  auto* dialog =
      new QFileDialog(&window_, tr("Open a scan's path"), {}, tr("Paths (*.csv);;All files (*)"));
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::ExistingFile);
  // Queued: a question may follow, and the dialog is gone by then.
  connect(
      dialog, &QFileDialog::fileSelected, this,
      [this](const QString& file) { openPath(file.toStdString()); }, Qt::QueuedConnection);
  dialog->open();
}

QFileDialog* AlignFiles::keepDialog() {
  auto* dialog =
      new QFileDialog(&window_, tr("Keep the path on the mesh"), {}, tr("Paths (*.csv)"));
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->setDefaultSuffix(QStringLiteral("csv"));
  dialog->selectFile(QStringLiteral("registered.csv"));
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& file) { keep(file.toStdString()); });
  return dialog;
}

bool AlignFiles::askKept(const QString& what) {
  QMessageBox box(QMessageBox::Question, tr("The placement is not kept"), what,
                  QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, &window_);
  box.setObjectName(QStringLiteral("unkept_placement"));
  box.setInformativeText(tr("Save keeps the path where it lies, and its pose, as files. Put into "
                            "workspace, on the desk Align, keeps them with the scan."));
  const int answer = box.exec();
  if (answer != QMessageBox::Save) return answer == QMessageBox::Discard;
  bool is_kept = false;
  const auto hears = connect(this, &AlignFiles::kept, this, [&] { is_kept = true; });
  keepDialog()->exec();
  disconnect(hears);
  return is_kept || askKept(what);
}

void AlignFiles::keep(const std::filesystem::path& file) {
  try {
    const auto pose = std::filesystem::path(file).replace_extension(".txt");
    writeRegisteredPath(file, alignment_.path(), alignment_.registration());
    writeFileAtomically(pose, poseText(alignment_.pose(), "mesh_from_scan"));
    emit kept(alignment_.pose());
    emit said({tr("The path on the mesh is in %1, its pose in %2")
                   .arg(QString::fromStdString(file.string()),
                        QString::fromStdString(pose.filename().string()))});
  } catch (const Error& error) {
    showProblem(&window_, tr("The path cannot be kept"), QString::fromStdString(error.what()),
                tr("Make room, or choose another folder."));
  }
}

} // namespace patina
