#include "app/gui/texturing/texture_library.h"

#include <QFileDialog>

#include "app/gui/loading/load_dialogs.h"
#include "app/gui/texturing/texture_edits.h"
#include "core/error.h"
#include "workspace/texture_file.h"

namespace patina {
namespace {

QFileDialog* textureDialog(QWidget& window, const QString& title) {
  auto* dialog = new QFileDialog(&window, title, {}, TextureLibrary::tr("Textures (*.json)"));
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  return dialog;
}

} // namespace

TextureLibrary::TextureLibrary(QWidget& window) : QObject(&window), window_(window), job_(this) {
  connect(card_, &TextureCard::readAsked, this, [this] { readDialog(false); });
  connect(card_, &TextureCard::swapAsked, this, [this] { readDialog(true); });
  connect(card_, &TextureCard::keepAsked, this, &TextureLibrary::keepDialog);
  connect(card_, &TextureCard::removeAsked, this, &TextureLibrary::takeOff);
  connect(card_, &TextureCard::scanAsked, this, &TextureLibrary::takeFromScan);
  connect(card_, &TextureCard::drawToggled, this, [this](bool on) {
    view();
    pen_->setOn(on);
    card_->setDrawing(on);
    emit changed();
  });
  connect(card_, &TextureCard::chosenChanged, this, [this] {
    const TextureRow* row = card_->chosen();
    unmarked_ = true;
    emit chosen(row ? row->texture : nullptr);
  });
  connect(&job_, &Background::progressed, this, [this](double fraction, const QString&) {
    if (!work_) return;
    work_->fraction = fraction;
    emit changed();
  });
}

ScanView* TextureLibrary::view() {
  if (view_ != nullptr) return view_;
  view_ = new ScanView;
  view_->setObjectName(QStringLiteral("lay_view"));
  view_->setToolTip(
      tr("The scene, and in orange the faces that have the chosen texture; those of others are "
         "paler"));
  pen_ = new PathPen(*view_);
  connect(pen_, &PathPen::drawn, this, &TextureLibrary::lay);
  connect(pen_, &PathPen::left, this, [this] {
    pen_->setOn(false);
    card_->setDrawing(false);
  });
  showScene();
  return view_;
}

void TextureLibrary::setSources(EditThread& edits, std::function<PlacedScan()> placed) {
  edits_ = &edits;
  placed_ = std::move(placed);
}

void TextureLibrary::setScene(std::shared_ptr<const CompiledScene> scene) {
  scene_ = std::move(scene);
  stale_ = true;
  list();
}

void TextureLibrary::list() {
  card_->show(scene_ ? texturesOf(scene_->scene, read_) : read_);
}

void TextureLibrary::showScene() {
  if (view_ == nullptr || scene_ == nullptr) return;
  stale_ = false;
  pen_->setScene(scene_->scene);
  markFaces();
  if (scene_->mesh == shown_) return;
  shown_ = scene_->mesh;
  view_->picture().setMesh(shown_);
  view_->lookAtAll(Vec3::UnitZ());
}

void TextureLibrary::markFaces() {
  unmarked_ = false;
  const TextureRow* row = card_->chosen();
  const auto [meant, rest] =
      texturedParts(scene_->scene, row ? std::optional(row->number) : std::nullopt);
  view_->picture().setHighlight(meant, rest);
}

void TextureLibrary::refresh() {
  if (view_ == nullptr || !view_->isVisible()) return;
  if (stale_) showScene();
  if (unmarked_ && scene_) markFaces();
  view_->refresh();
}

std::shared_ptr<const FeltTexture> TextureLibrary::readOrTell(const std::filesystem::path& file) {
  try {
    FourierTexture texture = readTexture(file);
    if (texture.name.empty()) texture.name = file.stem().string();
    return feltTexture(std::move(texture));
  } catch (const Error& error) {
    showProblem(&window_, tr("The texture cannot be read"), QString::fromStdString(error.what()),
                tr("What was there before is as it was."));
    return nullptr;
  }
}

void TextureLibrary::read(const std::filesystem::path& file) {
  const auto texture = readOrTell(file);
  if (!texture) return;
  const std::int32_t number = freeNumber(scene_ ? texturesOf(scene_->scene, read_) : read_);
  read_.push_back({number, texture, 0});
  list();
  card_->choose(number);
}

void TextureLibrary::readDialog(bool swaps) {
  auto* dialog =
      textureDialog(window_, swaps ? tr("Swap for another texture") : tr("Read a texture"));
  dialog->setFileMode(QFileDialog::ExistingFile);
  connect(dialog, &QFileDialog::fileSelected, this, [this, swaps](const QString& file) {
    swaps ? swap(file.toStdString()) : read(file.toStdString());
  });
  dialog->open();
}

void TextureLibrary::keepDialog() {
  const TextureRow* row = card_->chosen();
  if (row == nullptr || row->texture == nullptr) return;
  auto* dialog = textureDialog(window_, tr("Keep the texture"));
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->setDefaultSuffix(QStringLiteral("json"));
  dialog->selectFile(QStringLiteral("texture.json"));
  connect(dialog, &QFileDialog::fileSelected, this,
          [this, texture = row->texture](const QString& file) {
            try {
              writeTexture(file.toStdString(), texture->value);
              emit said({tr("The texture is in %1").arg(file)});
            } catch (const Error& error) {
              showProblem(&window_, tr("The texture cannot be kept"),
                          QString::fromStdString(error.what()),
                          tr("Make room, or choose another folder."));
            }
          });
  dialog->open();
}

void TextureLibrary::apply(const std::string& what, std::function<Scene(const Scene&)> edit) {
  if (edits_ == nullptr || scene_ == nullptr) return;
  edits_->edit(what, std::move(edit), [this](const std::string& problem) {
    card_->setHint(QString::fromStdString(problem));
  });
}

void TextureLibrary::lay(int object, const std::vector<Vec3>& points) {
  const TextureRow* row = card_->chosen();
  if (row == nullptr || row->texture == nullptr) return;
  card_->setDrawing(true); // its hint, in the place of a problem's words
  apply("lay " + row->texture->value.name,
        [row = *row, object, rings = card_->rings(), points](const Scene& scene) {
          const Progress quiet;
          return withLaid(scene, static_cast<std::size_t>(object), {PathOnMesh{points, {}}}, row,
                          rings, quiet);
        });
}

void TextureLibrary::swap(const std::filesystem::path& file) {
  const TextureRow* row = card_->chosen();
  const auto texture = readOrTell(file);
  if (row == nullptr || !texture) return;
  apply("swap for " + texture->value.name, [number = row->number, texture](const Scene& scene) {
    return withSwapped(scene, number, texture);
  });
}

void TextureLibrary::takeOff() {
  const TextureRow* row = card_->chosen();
  if (row == nullptr) return;
  if (row->texture) { // it stays in the list
    std::erase_if(read_, [&](const TextureRow& old) { return old.number == row->number; });
    read_.push_back({row->number, row->texture, 0});
  }
  apply("take off a texture",
        [number = row->number](const Scene& scene) { return withoutTexture(scene, number); });
}

void TextureLibrary::takeFromScan() {
  if (work_ || !placed_ || scene_ == nullptr) return;
  PlacedScan scan;
  try {
    scan = placed_();
  } catch (const Error& error) {
    card_->setHint(QString::fromStdString(error.what()));
    emit said({QString::fromStdString(error.what()), true});
    return;
  }
  const QString title = tr("A texture of the scan %1").arg(QString::fromStdString(scan.name));
  work_ = Work{title, title};
  emit changed();
  const std::int32_t number = freeNumber(texturesOf(scene_->scene, read_));
  job_.start([this, scan, number, rings = card_->rings(),
              mesh = scene_->scene.objects[0].mesh](Progress&, const Background::Deliver& deliver) {
    try {
      const SurfaceTarget target(cleaned(*mesh).mesh, 0, true);
      ScannedTexture found =
          fitScanTexture(target, scan.filtered, scan.poses, scan.rig, scan.path, scan.registration);
      found.fitted.texture.name = scan.name;
      const auto felt = feltTexture(std::move(found.fitted.texture));
      // A texture without a compliance is as stiff as the scene; the hint says so.
      const QString hint =
          felt->value.compliance
              ? QString()
              : tr("The texture has no stiffness of its own: its scan was placed by "
                   "hand. Fit the path on the desk Align to estimate it.");
      deliver(true, [this, felt, number, rings, hint, strokes = found.strokes] {
        work_.reset();
        card_->setHint(hint);
        apply("lay " + felt->value.name, [felt, number, rings, strokes](const Scene& scene) {
          const Progress quiet;
          return withLaid(scene, 0, strokes, {number, felt, 0}, rings, quiet);
        });
        emit changed();
      });
    } catch (const std::exception& error) {
      deliver(true, [this, problem = QString::fromStdString(error.what())] {
        work_.reset();
        card_->setHint(problem);
        emit said({problem, true});
        emit changed();
      });
    }
  });
}

void TextureLibrary::cancel() {
  if (!work_) return;
  job_.silence();
  work_.reset();
  emit changed();
}

} // namespace patina
