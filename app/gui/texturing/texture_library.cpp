#include "app/gui/texturing/texture_library.h"

#include <algorithm>
#include <cmath>

#include <QKeyEvent>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "app/gui/loading/load_dialogs.h"
#include "app/gui/toolkit/form.h"
#include "app/gui/toolkit/words.h"
#include "core/error.h"
#include "core/numbers.h"
#include "geometry/mesh/mesh_report.h"
#include "workspace/texture_file.h"

namespace patina {
namespace {

QString wordsOf(const TextureRow& row) {
  if (row.texture == nullptr) return TextureCard::tr("%1 · not known: rigid").arg(row.number);
  const FourierTexture& texture = row.texture->value;
  const QString name = texture.name.empty() ? TextureCard::tr("texture") : shownText(texture.name);
  return row.faces > 0 ? TextureCard::tr("%1 · %2, on %3 faces")
                             .arg(row.number)
                             .arg(name, shownText(formatCount(row.faces)))
                       : TextureCard::tr("%1 · %2, unused").arg(row.number).arg(name);
}

QString toolTipOf(const TextureRow& row) {
  if (row.texture == nullptr)
    return TextureCard::tr(
        "Faces refer to this texture, but it is not loaded: choose its file by Swap");
  const FourierTexture& texture = row.texture->value;
  return TextureCard::tr("%1 harmonics over %2, rms height %3")
      .arg(harmonics(texture))
      .arg(inWords(period(texture)), inWords(rmsHeight(texture)));
}

} // namespace

TextureCard::TextureCard(QWidget* parent) : QGroupBox(tr("Textures"), parent) {
  auto* column = layoutIn<QVBoxLayout>(this);
  list_ =
      named(new QListWidget, "textures", tr("Textures of the scene, and those read from files"));
  list_->setFixedHeight(96);
  column->addWidget(list_);
  addButton(column, "texture_read", tr("Read texture…"),
            tr("A texture.json, as `patina fit-texture` and Keep write it"), this,
            &TextureCard::readRequested);
  addButton(column, "texture_scan", tr("From the scan"),
            tr("Makes a texture from the height profile of the open scan, and maps it where "
               "it was scanned. The desk Align must have aligned its path"),
            this, &TextureCard::scanRequested);
  keep_ = addButton(column, "texture_keep", tr("Keep…"),
                    tr("Saves it as texture.json, for another mesh"), this,
                    &TextureCard::keepRequested);
  draw_ =
      addButton(column, "texture_draw", tr("Lay along a path"),
                tr("Draw on the mesh with the left button: the selected texture is mapped along "
                   "the path. Shift turns the picture, Esc ends drawing"));
  draw_->setCheckable(true);
  hint_ = addNote(column, "texture_hint");
  auto* form = new Form(this);
  form->addRow(RowSpec("texture_rings", tr("Faces beside the path"), tr("rings"), {0, 12, 1, 0},
                       tr("Number of rings of neighbouring faces that get the texture, too")),
               rings_, [this](double rings) { rings_ = static_cast<int>(rings); });
  column->addWidget(form);
  swap_ = addButton(column, "texture_swap", tr("Swap…"),
                    tr("Replaces the selected texture by one from a file, on all of its faces"),
                    this, &TextureCard::swapRequested);
  remove_ =
      addButton(column, "texture_remove", tr("Take off"), tr("Removes the texture from its faces"),
                this, &TextureCard::removeRequested);
  connect(list_, &QListWidget::currentRowChanged, this, [this] {
    offer();
    emit chosenChanged();
  });
  connect(draw_, &QPushButton::toggled, this, &TextureCard::drawToggled);
  offer();
}

void TextureCard::show(const std::vector<TextureRow>& rows) {
  const TextureRow* before = chosen();
  const std::int32_t number = before ? before->number : -1;
  {
    const QSignalBlocker quiet(list_);
    rows_ = rows;
    list_->clear();
    for (const TextureRow& row : rows_) {
      auto* item = new QListWidgetItem(wordsOf(row), list_);
      item->setToolTip(toolTipOf(row));
    }
  }
  if (!rows_.empty()) list_->setCurrentRow(0);
  choose(number);
  offer();
  emit chosenChanged();
}

void TextureCard::choose(std::int32_t number) {
  for (std::size_t i = 0; i < rows_.size(); ++i)
    if (rows_[i].number == number) list_->setCurrentRow(static_cast<int>(i));
}

const TextureRow* TextureCard::chosen() const {
  const int row = list_->currentRow();
  return row >= 0 && static_cast<std::size_t>(row) < rows_.size()
             ? &rows_[static_cast<std::size_t>(row)]
             : nullptr;
}

void TextureCard::offer() {
  const TextureRow* row = chosen();
  list_->setVisible(!rows_.empty());
  for (QPushButton* button : {draw_, keep_})
    button->setVisible(row != nullptr && row->texture != nullptr);
  for (QPushButton* button : {swap_, remove_}) button->setVisible(row != nullptr && row->faces > 0);
}

void TextureCard::setDrawing(bool on) {
  const QSignalBlocker quiet(draw_);
  draw_->setChecked(on);
  setHint(on ? tr("Draw on the mesh with the left button; Esc ends it.") : QString());
}

void PathPen::setScene(const Scene& scene) {
  std::vector<Ground> grounds;
  for (const SceneObject& object : scene.objects) {
    grounds.push_back({object.mesh, object.world_from_object, nullptr});
    for (Ground& old : grounds_)
      if (old.mesh == object.mesh && old.tree) grounds.back().tree = std::move(old.tree);
  }
  grounds_ = std::move(grounds);
}

void PathPen::setOn(bool on) {
  on_ = on;
  down_ = false;
  points_.clear();
  showPath();
  view_.setCursor(on ? Qt::CrossCursor : Qt::OpenHandCursor);
  if (on) view_.setFocus();
}

// Adds a point on the nearest object, or on the object where the path began.
void PathPen::touch(const QPoint& pixel) {
  const Ray sight = view_.sightAt(pixel);
  double nearest = INFINITY;
  std::optional<Vec3> found;
  int on = object_;
  for (std::size_t i = 0; i < grounds_.size(); ++i) {
    if (object_ >= 0 && static_cast<std::size_t>(object_) != i) continue;
    Ground& ground = grounds_[i];
    if (!ground.tree) {
      const TriangleMesh clean = cleaned(*ground.mesh).mesh;
      if (clean.triangles.empty()) continue;
      ground.tree = std::make_unique<TriangleTree>(clean);
    }
    const Pose object_from_world = ground.world_from_object.inverse();
    const Vec3 from = object_from_world * sight.origin;
    const Vec3 along = object_from_world.linear() * sight.direction;
    const auto hit = ground.tree->firstHit(from, along, nearest);
    if (!hit) continue;
    nearest = hit->t;
    found = from + hit->t * along;
    on = static_cast<int>(i);
  }
  if (!found) return;
  object_ = on;
  if (points_.empty() || (points_.back() - *found).norm() > 0) points_.push_back(*found);
  showPath();
}

void PathPen::showPath() {
  DrawnPath path;
  if (object_ >= 0 && static_cast<std::size_t>(object_) < grounds_.size())
    for (const Vec3& point : points_)
      path.samples.push_back({0,
                              grounds_[static_cast<std::size_t>(object_)].world_from_object * point,
                              NAN, false, false});
  view_.picture().setPath(path);
  view_.refresh();
}

bool PathPen::eventFilter(QObject*, QEvent* event) {
  if (!on_) return false;
  if (event->type() == QEvent::KeyPress &&
      static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape) {
    emit left();
    return true;
  }
  if (event->type() != QEvent::MouseButtonPress && event->type() != QEvent::MouseMove &&
      event->type() != QEvent::MouseButtonRelease && event->type() != QEvent::MouseButtonDblClick)
    return false;
  const auto& mouse = *static_cast<QMouseEvent*>(event);
  if (event->type() == QEvent::MouseMove) {
    if (down_) touch(mouse.pos());
    return down_;
  }
  if (mouse.button() != Qt::LeftButton || mouse.modifiers().testFlag(Qt::ShiftModifier))
    return false;
  if (event->type() == QEvent::MouseButtonRelease) {
    if (!std::exchange(down_, false)) return false;
    if (points_.size() > 1) emit drawn(object_, points_);
    points_.clear();
    showPath();
    return true;
  }
  down_ = true;
  object_ = -1;
  points_.clear();
  touch(mouse.pos());
  return true;
}

TextureLibrary::TextureLibrary(QWidget& window) : QObject(&window), window_(window), job_(this) {
  connect(card_, &TextureCard::readRequested, this, [this] { readDialog(false); });
  connect(card_, &TextureCard::swapRequested, this, [this] { readDialog(true); });
  connect(card_, &TextureCard::keepRequested, this, &TextureLibrary::keepDialog);
  connect(card_, &TextureCard::removeRequested, this, &TextureLibrary::removeTexture);
  connect(card_, &TextureCard::scanRequested, this, &TextureLibrary::createFromScan);
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
  view_ = named(new ScanView, "lay_view",
                tr("The scene. Orange: faces with the selected texture; paler: faces with others"));
  pen_ = new PathPen(*view_);
  connect(pen_, &PathPen::drawn, this, &TextureLibrary::mapAlong);
  connect(pen_, &PathPen::left, this, [this] {
    pen_->setOn(false);
    card_->setDrawing(false);
  });
  showScene();
  return view_;
}

void TextureLibrary::showScene() {
  if (view_ == nullptr || scene_ == nullptr) return;
  stale_ = false;
  pen_->setScene(scene_->scene);
  markFaces();
  if (scene_->mesh == shown_) return;
  shown_ = scene_->mesh;
  view_->picture().setMesh(shown_);
  view_->resetCamera(Vec3::UnitZ());
}

void TextureLibrary::markFaces() {
  unmarked_ = false;
  const TextureRow* row = card_->chosen();
  const auto [selected, others] =
      texturedParts(scene_->scene, row ? std::optional(row->number) : std::nullopt);
  view_->picture().setHighlight(selected, others);
}

void TextureLibrary::refresh() {
  if (view_ == nullptr || !view_->isVisible()) return;
  if (stale_) showScene();
  if (unmarked_ && scene_) markFaces();
  view_->refresh();
}

std::shared_ptr<const HapticTexture>
TextureLibrary::readOrReport(const std::filesystem::path& file) {
  try {
    FourierTexture texture = readTexture(file);
    if (texture.name.empty()) texture.name = file.stem().string();
    return hapticTexture(std::move(texture));
  } catch (const Error& error) {
    showProblem(&window_, tr("The texture cannot be read"), shownText(error.what()),
                tr("The list is unchanged."));
    return nullptr;
  }
}

void TextureLibrary::read(const std::filesystem::path& file) {
  const auto texture = readOrReport(file);
  if (!texture) return;
  const std::int32_t number = freeNumber(scene_ ? texturesOf(scene_->scene, read_) : read_);
  read_.push_back({number, texture, 0});
  list();
  card_->choose(number);
}

void TextureLibrary::readDialog(bool swaps) {
  askForPath(&window_, swaps ? tr("Swap for another texture") : tr("Read a texture"),
             QFileDialog::ExistingFile, tr("Textures (*.json)"),
             [this, swaps](const QString& file) {
               swaps ? swap(file.toStdString()) : read(file.toStdString());
             });
}

void TextureLibrary::keepDialog() {
  const TextureRow* row = card_->chosen();
  if (row == nullptr || row->texture == nullptr) return;
  const auto save = [this, texture = row->texture](const QString& file) {
    try {
      writeTexture(file.toStdString(), texture->value);
      emit notified({tr("The texture is in %1").arg(file)});
    } catch (const Error& error) {
      showProblem(&window_, tr("The texture cannot be saved"), shownText(error.what()),
                  tr("Free some disk space, or choose another folder."));
    }
  };
  saveDialog(&window_, tr("Keep the texture"), tr("Textures (*.json)"),
             QStringLiteral("texture.json"), save)
      ->open();
}

void TextureLibrary::apply(const std::string& what, std::function<Scene(const Scene&)> edit) {
  if (edits_ == nullptr || scene_ == nullptr) return;
  edits_->edit(what, std::move(edit), [this](const std::string& problem) {
    card_->setHint(withoutCommands(shownText(problem)));
  });
}

void TextureLibrary::mapAlong(int object, const std::vector<Vec3>& points) {
  const TextureRow* row = card_->chosen();
  if (row == nullptr || row->texture == nullptr) return;
  card_->setDrawing(true); // The hint replaces the error text.
  apply("lay " + row->texture->value.name,
        [row = *row, object, rings = card_->rings(), points](const Scene& scene) {
          const Progress quiet;
          return withLaid(scene, static_cast<std::size_t>(object), {PathOnMesh{points, {}}}, row,
                          rings, quiet);
        });
}

void TextureLibrary::swap(const std::filesystem::path& file) {
  const TextureRow* row = card_->chosen();
  const auto texture = readOrReport(file);
  if (row == nullptr || !texture) return;
  apply("swap for " + texture->value.name, [number = row->number, texture](const Scene& scene) {
    return withSwapped(scene, number, texture);
  });
}

void TextureLibrary::removeTexture() {
  const TextureRow* row = card_->chosen();
  if (row == nullptr) return;
  if (row->texture) { // It stays in the list.
    std::erase_if(read_, [&](const TextureRow& old) { return old.number == row->number; });
    read_.push_back({row->number, row->texture, 0});
  }
  apply("take off a texture",
        [number = row->number](const Scene& scene) { return withoutTexture(scene, number); });
}

void TextureLibrary::createFromScan() {
  if (work_ || !make_aligned_ || scene_ == nullptr) return;
  AlignedScan scan;
  try {
    scan = make_aligned_();
  } catch (const Error& error) {
    card_->setHint(withoutCommands(shownText(error.what())));
    emit notified({shownText(error.what()), true});
    return;
  }
  const QString title = tr("A texture of the scan %1").arg(shownText(scan.name));
  work_ = TaskProgress{title, title};
  emit changed();
  const std::int32_t number = freeNumber(texturesOf(scene_->scene, read_));
  job_.start([this, scan, number, rings = card_->rings(),
              mesh = scene_->scene.objects[0].mesh](Progress&, const Background::Post& post) {
    try {
      const SurfaceTarget target(cleaned(*mesh).mesh, scan.rig.tip_radius, true);
      ScannedTexture found =
          fitScanTexture(target, scan.filtered, scan.poses, scan.rig, scan.place);
      found.fitted.texture.name = scan.name;
      const auto felt = hapticTexture(std::move(found.fitted.texture));
      // A texture without compliance has the scene's stiffness; the hint reports it.
      const QString hint = felt->value.compliance
                               ? QString()
                               : tr("The texture has no compliance, because its scan was placed by "
                                    "hand. Fit the path on the desk Align to estimate it.");
      post(true, [this, felt, number, rings, hint, strokes = found.strokes] {
        work_.reset();
        card_->setHint(hint);
        apply("lay " + felt->value.name, [felt, number, rings, strokes](const Scene& scene) {
          const Progress quiet;
          return withLaid(scene, 0, strokes, {number, felt, 0}, rings, quiet);
        });
        emit changed();
      });
    } catch (const std::exception& error) {
      post(true, [this, problem = shownText(error.what())] {
        work_.reset();
        card_->setHint(withoutCommands(problem));
        emit notified({problem, true});
        emit changed();
      });
    }
  });
}

void TextureLibrary::cancel() {
  if (!work_) return;
  job_.discardResult();
  work_.reset();
  emit changed();
}

} // namespace patina
