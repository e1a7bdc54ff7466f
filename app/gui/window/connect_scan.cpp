// Connects the desks Scan, Align and Texture with the window and each other.
#include "app/gui/aligning/align_desk.h"
#include "app/gui/aligning/fit_words.h"
#include "app/gui/scanning/scan_desk.h"
#include "app/gui/texturing/aligned_scan.h"
#include "app/gui/texturing/texture_desk.h"
#include "app/gui/window/main_window.h"
#include "app/gui/window/status_line.h"
#include "core/error.h"

namespace patina {
namespace {
constexpr double kFirstPress = 1; // Force [N] at which a scanned texture has its full height.
}

void MainWindow::connectScan() {
  const auto connectDesk = [this](auto* desk) {
    using AnyDesk = std::remove_pointer_t<decltype(desk)>;
    connect(desk, &AnyDesk::changed, this, &MainWindow::refresh);
    connect(desk, &AnyDesk::notified, this, &MainWindow::say);
    connect(parts_.load_bar, &LoadBar::cancelled, desk, &AnyDesk::cancel);
    connect(&timer_, &QTimer::timeout, desk, &AnyDesk::refresh);
  };
  connectDesk(parts_.scan);
  connectDesk(parts_.texture);
  connectDesk(parts_.align);
  connect(parts_.scan, &ScanDesk::openRequested, &documents_,
          [this](const QString& folder) { documents_.open({.path = folder.toStdString()}); });
  connect(parts_.scan, &ScanDesk::opened, &desks_, [this] { desks_.choose(Desk::scan); });
  connect(parts_.texture, &TextureDesk::scanRequested, parts_.scan,
          [this](const QString& folder) { parts_.scan->open(folder.toStdString()); });
  connect(parts_.texture, &TextureDesk::openRequested, &documents_, [this](const QString& folder) {
    if (documents_.isInteractive() && !saving_.confirmEdits()) return;
    documents_.open(
        {.path = folder.toStdString(), .unsaved_name = tr("Scanned toy"), .then = [this] {
           if (desks_.desk() != Desk::feel) return; // The user has chosen another one.
           parts_.tools->choose({InteractionMode::press, {}});
           paint_.setForce(kFirstPress);
         }});
  });
  parts_.texture->library().setSources(edits_.thread(), [this] {
    const auto& found = parts_.align->alignment().found();
    if (const QString doubt = found ? warningText(*found) : QString(); !doubt.isEmpty())
      say({tr("%1. The texture is as uncertain as the pose").arg(doubt), true});
    return makeAlignedScan(parts_.scan->scan(), *parts_.align, edits_.scene()->scene);
  });
  connect(parts_.guide, &GuideStrip::chosen, &desks_, &DeskController::choose);
  connect(parts_.scan, &ScanDesk::pathMade, parts_.align,
          [this](const QString& name, const std::vector<PathSample>& path) {
            const ScanFiles* files = parts_.scan->scan().files();
            const bool has_rig = files != nullptr && files->rig;
            parts_.align->takePath(name, {path, {}, has_rig ? files->rig->tip_radius : 0},
                                   documents_.isInteractive());
            const auto mesh =
                files != nullptr ? files->folder / "mesh.obj" : std::filesystem::path();
            parts_.align->centralViews()->offerMesh(
                std::filesystem::exists(mesh) ? mesh : std::filesystem::path());
          });
  // Runs the remaining steps one after another.
  const auto goes_on = std::make_shared<bool>(false);
  connect(parts_.scan, &ScanDesk::textureRequested, parts_.align, [this, goes_on] {
    if (!parts_.align->alignment().isReady()) {
      say({tr("Open the scanned mesh first: the path must be aligned with it"),
           true,
           {},
           {tr("Open…"), [this] { documents_.openDialog(false); }}});
      return;
    }
    try { // Reports missing data before the fit.
      (void)makeAlignedScan(parts_.scan->scan(), *parts_.align, edits_.scene()->scene);
    } catch (const Error& error) {
      say({QString::fromStdString(error.what()), true});
      return;
    }
    *goes_on = true;
    parts_.align->registerFromHere();
  });
  connect(parts_.align, &AlignDesk::fitted, parts_.texture, [this, goes_on](bool is_certain) {
    if (!std::exchange(*goes_on, false)) return;
    if (is_certain) return parts_.texture->library().createFromScan();
    const auto& found = parts_.align->alignment().found();
    if (const QString doubt = found ? warningText(*found) : QString(); !doubt.isEmpty())
      say({tr("%1. No texture was made").arg(doubt), true});
  });
  connect(parts_.align->centralViews(), &AlignCentralViews::meshRequested, &documents_,
          [this](const QString& file) { documents_.openRequested({.path = file.toStdString()}); });
  connect(parts_.align, &AlignDesk::underPointer, parts_.status, &StatusLine::showPicked);
  parts_.scan->scans().setEdits(edits_.thread());
  saving_.setUnsavedGuard({[align = parts_.align] { return align->isSaved(); },
                           [align = parts_.align] { return align->confirmPlacement(); }});
  connect(&parts_.align->files(), &AlignFiles::storeRequested, &parts_.scan->scans(),
          &SceneScans::change);
}

} // namespace patina
