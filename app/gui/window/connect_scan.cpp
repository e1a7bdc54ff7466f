// What the desks for scans, placement and textures ask of the window and of each other.
#ifdef PATINA_HAS_ACQUISITION
#include "app/gui/aligning/align_desk.h"
#include "app/gui/aligning/fit_words.h"
#include "app/gui/scanning/scan_desk.h"
#include "app/gui/texturing/texture_desk.h"
#include "app/gui/window/main_window.h"
#include "core/error.h"

namespace patina {
namespace {
constexpr double kFirstPress = 1; // [N], at which a scanned texture is felt whole
}

void MainWindow::connectScan() {
  connect(parts_.scan, &ScanDesk::openAsked, &documents_, [this](const QString& folder) {
    LoadRequest request;
    request.path = folder.toStdString();
    documents_.open(request);
  });
  connect(parts_.scan, &ScanDesk::opened, &desks_, [this] { desks_.choose(Desk::scan); });
  connect(parts_.scan, &ScanDesk::changed, this, &MainWindow::refresh);
  connect(parts_.scan, &ScanDesk::said, this, &MainWindow::say);
  connect(parts_.load_bar, &LoadBar::cancelled, parts_.scan, &ScanDesk::cancel);
  connect(&timer_, &QTimer::timeout, parts_.scan, &ScanDesk::refresh);
  connect(parts_.texture, &TextureDesk::scanAsked, parts_.scan,
          [this](const QString& folder) { parts_.scan->open(folder.toStdString()); });
  connect(parts_.texture, &TextureDesk::openAsked, &documents_, [this](const QString& folder) {
    LoadRequest request;
    request.path = folder.toStdString();
    request.unsaved_name = tr("Scanned toy");
    request.then = [this] {
      if (desks_.desk() != Desk::feel) return; // one that was chosen meanwhile stays
      parts_.tools->choose({Handling::press, {}});
      paint_.setForce(kFirstPress);
    };
    if (documents_.asks() && !saving_.settleEdits()) return;
    documents_.open(request);
  });
  connect(parts_.texture, &TextureDesk::changed, this, &MainWindow::refresh);
  connect(parts_.texture, &TextureDesk::said, this, &MainWindow::say);
  connect(parts_.load_bar, &LoadBar::cancelled, parts_.texture, &TextureDesk::cancel);
  connect(&timer_, &QTimer::timeout, parts_.texture, &TextureDesk::refresh);
  parts_.texture->library().setSources(edits_.thread(), [this] {
    const auto& found = parts_.align->alignment().found();
    if (const QString doubt = found ? doubtWords(*found) : QString(); !doubt.isEmpty())
      say({tr("%1. The texture that is made of it is as unsure").arg(doubt), true});
    return placedScan(parts_.scan->scan(), *parts_.align, edits_.scene()->scene);
  });
  connect(parts_.guide, &GuideStrip::chosen, &desks_, &DeskController::choose);
  connect(parts_.scan, &ScanDesk::pathMade, parts_.align,
          [this](const QString& name, const std::vector<PathSample>& path) {
            parts_.align->takePath(name, {path, {}}, documents_.asks());
            const ScanFiles* files = parts_.scan->scan().files();
            const auto mesh =
                files != nullptr ? files->folder / "mesh.obj" : std::filesystem::path();
            parts_.align->cells()->offerMesh(
                std::filesystem::exists(mesh) ? mesh : std::filesystem::path());
          });
  // The steps that are left, one after the other.
  const auto goes_on = std::make_shared<bool>(false);
  connect(parts_.scan, &ScanDesk::textureAsked, parts_.align, [this, goes_on] {
    if (!parts_.align->alignment().isReady()) {
      say({tr("Open the mesh that was scanned first, so that the path can lie on it"), true});
      return;
    }
    try { // what is missing is told before a fit
      (void)placedScan(parts_.scan->scan(), *parts_.align, edits_.scene()->scene);
    } catch (const Error& error) {
      say({QString::fromStdString(error.what()), true});
      return;
    }
    *goes_on = true;
    parts_.align->registerFromHere();
  });
  connect(parts_.align, &AlignDesk::fitted, parts_.texture, [this, goes_on](bool is_certain) {
    if (!std::exchange(*goes_on, false)) return;
    if (is_certain) return parts_.texture->library().takeFromScan();
    const auto& found = parts_.align->alignment().found();
    if (const QString doubt = found ? doubtWords(*found) : QString(); !doubt.isEmpty())
      say({tr("%1. No texture was made of it").arg(doubt), true});
  });
  connect(parts_.align->cells(), &AlignCells::meshAsked, &documents_, [this](const QString& file) {
    LoadRequest request;
    request.path = file.toStdString();
    documents_.openAsked(request);
  });
  parts_.scan->scans().setEdits(edits_.thread());
  saving_.setBeside({[align = parts_.align] { return align->isKept(); },
                     [align = parts_.align] { return align->settlePlacement(); }});
  connect(&parts_.align->files(), &AlignFiles::storeAsked, &parts_.scan->scans(),
          &SceneScans::change);
  connect(parts_.align, &AlignDesk::changed, this, &MainWindow::refresh);
  connect(parts_.align, &AlignDesk::said, this, &MainWindow::say);
  connect(parts_.load_bar, &LoadBar::cancelled, parts_.align, &AlignDesk::cancel);
  connect(&timer_, &QTimer::timeout, parts_.align, &AlignDesk::refresh);
}

} // namespace patina
#endif
