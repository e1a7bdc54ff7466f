#include "app/gui/control/view_controller.h"

#include <utility>

#include <QFileDialog>

#include "app/gui/loading/load_dialogs.h"
#include "visualization/view/camera.h"

namespace patina {

ViewController::ViewController(const Parts& parts, QObject* parent) : QObject(parent), at_(parts) {
  connect(&at_.display, &DisplayPanel::layerToggled, this,
          [this](Layer layer, bool on) { view().show(layer, on); });
  view().show(Layer::scale, at_.display.shown(Layer::scale));
  connect(&at_.display, &DisplayPanel::sliceMoved, this,
          [this](const SlicePlace& place) { view().setSlice(place); });
  connect(&at_.display, &DisplayPanel::isoMoved, this, [this](double iso) { view().setIso(iso); });
  connect(&at_.display.clip(), &QCheckBox::toggled, this, &ViewController::clip);
  connect(&at_.display, &DisplayPanel::clipTurned, this, &ViewController::turnClip);
  connect(&at_.view, &SceneWidget::clipMoved, this, &ViewController::setClip);
  connect(&at_.paint, &PaintDisplay::showAsked, this,
          [this](std::optional<PaintQuantity> quantity) {
            for (std::size_t i = 0; i < kPaintQuantities; ++i)
              view().show(static_cast<Layer>(static_cast<std::size_t>(Layer::color) + i),
                          quantity && static_cast<std::size_t>(*quantity) == i);
          });
  connect(&at_.paint, &PaintDisplay::lockAsked, this,
          [this](PaintQuantity quantity, std::optional<ValueRange> range) {
            view().lockPaintRange(quantity, range);
          });
}

// Through the middle, across the axis that is most towards the viewer.
void ViewController::clip(bool on) {
  if (!on) return setClip(std::nullopt);
  clip_ = ClipPlane{view().extent().center(), Vec3::UnitZ()};
  int axis = 0;
  viewDirection(*view().renderer().GetActiveCamera()).cwiseAbs().maxCoeff(&axis);
  turnClip(static_cast<ClipTurn>(axis));
}

void ViewController::turnClip(ClipTurn turn) {
  ClipPlane plane = *clip_;
  const Vec3 back = -viewDirection(*view().renderer().GetActiveCamera());
  switch (turn) {
  case ClipTurn::x:
  case ClipTurn::y:
  case ClipTurn::z: {
    const int axis = static_cast<int>(turn);
    plane.normal = back[axis] < 0 ? Vec3(-Vec3::Unit(axis)) : Vec3::Unit(axis);
    break;
  }
  case ClipTurn::viewer:
    plane.normal = back;
    break;
  case ClipTurn::flip:
    plane.normal = -plane.normal;
  }
  setClip(plane);
}

void ViewController::setClip(const std::optional<ClipPlane>& plane) {
  clip_ = plane;
  at_.view.setClip(plane);
}

void ViewController::clear() {
  showMesh(nullptr);
  content_ = Content::nothing;
}

void ViewController::showPreview(std::shared_ptr<const TriangleMesh> mesh, const QString& name) {
  at_.mesh.showMesh(*mesh, name);
  showMesh(std::move(mesh));
  view().setView(ViewPreset::iso);
  content_ = Content::preview;
}

void ViewController::showMesh(std::shared_ptr<const TriangleMesh> mesh) {
  at_.view.setField(nullptr);
  at_.display.setField(nullptr);
  view().setField(nullptr);
  showStability(nullptr);
  showPaint({});
  view().setMesh(std::move(mesh));
}

void ViewController::showScene(const SceneChange& change) {
  const CompiledScene& scene = *change.scene;
  const bool edited = change.step == SceneChange::Step::edited;
  if (!edited) showStability(nullptr);
  if (change.surface) {
    view().setMesh(scene.mesh);
    view().setField(scene.built.field);
    at_.view.setField(scene.built.field);
    at_.mesh.showScene(scene);
    at_.display.setField(scene.built.field.get());
  }
  showPaint(scene.scene);
  if (change.values) {
    view().setTipRadius(scene.scene.haptics.tip_radius.value_or(0));
    const auto band = touchBand(scene.scene.haptics);
    view().setBand(band);
    at_.display.setBand(band.has_value());
  }
  // The camera of another scene, or of a preview, says nothing of this one.
  if (!edited) view().setView(ViewPreset::iso);
  if (!edited && clip_) clip(true); // nor does its clip plane
  content_ = Content::scene;
}

void ViewController::showPaint(const Scene& scene) {
  view().setPaint(scene);
  std::vector<PaintQuantity> available;
  for (std::size_t i = 0; i < kPaintQuantities; ++i)
    if (view().hasPaint(static_cast<PaintQuantity>(i)))
      available.push_back(static_cast<PaintQuantity>(i));
  has_paint_ = !available.empty();
  at_.paint.setAvailable(available);
}

void ViewController::showStability(const std::shared_ptr<const SurfaceStability>& stability) {
  view().setStability(stability ? stability->surface.get() : nullptr,
                      stability ? shownRatios(stability->map) : std::vector<float>{});
}

void ViewController::setCameraHand(std::unique_ptr<CameraHand> hand) {
  hand_ = std::move(hand);
  hand_problem_.clear();
}

void ViewController::refresh() {
  if (hand_) {
    if (hand_->move(*view().renderer().GetActiveCamera())) at_.view.frames().cameraMoved();
    if (const std::string problem = hand_->problem(); problem != hand_problem_) {
      hand_problem_ = problem;
      if (!problem.empty()) emit said({QString::fromStdString(problem), true});
    }
  }
  at_.view.frames().refresh();
  if (const auto shown = at_.paint.shown(); shown && *shown != PaintQuantity::color)
    at_.paint.setRange(view().paintRange(*shown));
}

void ViewController::exportPicture() {
  const QString path =
      QFileDialog::getSaveFileName(at_.view.window(), tr("Export the picture"),
                                   QStringLiteral("patina.png"), tr("PNG pictures (*.png)"));
  if (path.isEmpty() || at_.view.grabFramebuffer().save(path, "PNG")) return;
  showProblem(at_.view.window(), tr("The picture cannot be saved"), path,
              tr("Choose a folder that you may write to, and a name that ends in .png."));
}

} // namespace patina
