#include "app/gui/aligning/align_files.h"

#include <algorithm>

#include <QMessageBox>

#include "acquisition/files/registered_file.h"
#include "acquisition/files/scan_tables.h"
#include "acquisition/registration/first_guess.h"
#include "app/gui/loading/load_dialogs.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/words.h"
#include "core/error.h"
#include "core/file.h"
#include "geometry/io/pose_file.h"

namespace patina {
namespace {

bool samePlaces(const std::vector<PathSample>& a, const std::vector<PathSample>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const PathSample& one, const PathSample& other) {
                      return one.t == other.t && one.position == other.position;
                    });
}

} // namespace

AlignedPath alignedPathOf(const SceneScan& scan) {
  const std::string where = "scan '" + scan.name + "': ";
  AlignedPath aligned{parsePath(*scan.text("path.csv"), where + "path.csv"), {}};
  if (const std::string* pose = scan.text("registered.txt"))
    aligned.mesh_from_path = parsePose(*pose, where + "registered.txt");
  if (const std::string* rig = scan.text("rig.json"))
    aligned.tip_radius = parseRig(*rig, where + "rig.json").tip_radius;
  return aligned;
}

SceneScan alignedScan(const std::string& name, const Alignment& alignment) {
  SceneScan scan;
  scan.name = scanNameOf(name);
  const auto put = [&](const char* file, std::string text) {
    scan.files[file] = std::make_shared<const std::string>(std::move(text));
  };
  put("path.csv", pathText(alignment.path()));
  put("registered.csv", registeredText(alignment.path(), alignment.registration()));
  put("registered.txt", poseText(alignment.pose(), "mesh_from_scan"));
  return scan;
}

SceneScan withAlignment(const SceneScan* known, const SceneScan& aligned) {
  if (known == nullptr) return aligned;
  if (known->text("path.csv")) {
    const std::vector<PathSample> path = alignedPathOf(aligned).path,
                                  own = alignedPathOf(*known).path;
    // The stored path may be the part in contact or the whole one; only contact is aligned.
    if (!samePlaces(path, own) && !samePlaces(path, inContact(own)))
      throw Error("scan '" + known->name +
                  "' of the workspace has another path than the one shown here: put that scan into "
                  "the workspace first, or choose its own path from the list");
  }
  SceneScan scan = *known;
  for (const auto& [file, text] : aligned.files)
    if (file != "path.csv" || !known->text(file)) scan.files[file] = text;
  return scan;
}

AlignFiles::AlignFiles(QWidget& window, const Alignment& alignment, AlignPanel& panel)
    : window_(window), alignment_(alignment), panel_(panel) {
  connect(&panel_, &AlignPanel::openRequested, this, &AlignFiles::openDialog);
  connect(&panel_, &AlignPanel::keepRequested, this, [this] { keepDialog()->open(); });
  connect(&panel_, &AlignPanel::scanChosen, this, &AlignFiles::openScan);
}

void AlignFiles::open(const QString& name, const std::function<AlignedPath()>& read) {
  AlignedPath found;
  try {
    found = read();
  } catch (const Error& error) {
    return showProblem(&window_, tr("The path cannot be read"), shownText(error.what()),
                       tr("What was open before stays open."));
  }
  emit opened(name, found);
}

void AlignFiles::openPath(const std::filesystem::path& file) {
  std::vector<std::string> warnings;
  open(shownText(file.filename().string()), [&] {
    return AlignedPath{readPath(file, &warnings), {}};
  });
  for (const std::string& line : warnings) emit notified({shownText(line), true});
}

QStringList AlignFiles::scansWithPath() const {
  QStringList names;
  if (scene_)
    for (const SceneScan& scan : scene_->scans)
      if (scan.text("path.csv")) names.push_back(shownText(scan.name));
  return names;
}

void AlignFiles::openScan(const QString& name) {
  const SceneScan* scan = scene_ ? findScan(*scene_, name.toStdString()) : nullptr;
  if (scan != nullptr) open(name, [&] { return alignedPathOf(*scan); });
}

void AlignFiles::store(const QString& name) {
  if (!scene_ || !alignment_.isReady()) return;
  const SceneScan aligned = alignedScan(name.toStdString(), alignment_);
  emit storeRequested(
      aligned.name, [aligned](const SceneScan* now) { return withAlignment(now, aligned); },
      [this, pose = alignment_.pose()] { emit saved(pose); });
}

void AlignFiles::openDialog() {
  askForPath(&window_, tr("Open a scan's path"), QFileDialog::ExistingFile,
             tr("Paths (*.csv);;All files (*)"),
             [this](const QString& file) { openPath(file.toStdString()); });
}

QFileDialog* AlignFiles::keepDialog() {
  return saveDialog(&window_, tr("Keep the path on the mesh"), tr("Paths (*.csv)"),
                    QStringLiteral("registered.csv"),
                    [this](const QString& file) { save(file.toStdString()); });
}

bool AlignFiles::confirmDiscard(const QString& what) {
  const int answer =
      askToSave(&window_, "unkept_placement", tr("The placement is not saved"), what,
                tr("Save writes the aligned path and its pose to files. Put into workspace, on the "
                   "desk Align, stores them with the scan."));
  if (answer != QMessageBox::Save) return answer == QMessageBox::Discard;
  bool is_saved = false;
  const auto connection = connect(this, &AlignFiles::saved, this, [&] { is_saved = true; });
  keepDialog()->exec();
  disconnect(connection);
  return is_saved || confirmDiscard(what);
}

void AlignFiles::save(const std::filesystem::path& file) {
  try {
    const auto pose = std::filesystem::path(file).replace_extension(".txt");
    writeRegisteredPath(file, alignment_.path(), alignment_.registration());
    writeFileAtomically(pose, poseText(alignment_.pose(), "mesh_from_scan"));
    emit saved(alignment_.pose());
    emit notified({tr("The path on the mesh is in %1, its pose in %2")
                       .arg(shownText(file.string()), shownText(pose.filename().string()))});
  } catch (const Error& error) {
    showProblem(&window_, tr("The path cannot be saved"), shownText(error.what()),
                tr("Free some disk space, or choose another folder."));
  }
}

} // namespace patina
