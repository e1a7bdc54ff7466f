#include "app/gui/control/view_controller.h"

#include <algorithm>
#include <utility>

#include <QApplication>
#include <QClipboard>
#include <QFileInfo>
#include <QImage>

#include "app/gui/loading/load_dialogs.h"
#include "app/gui/panels/field_plots.h"
#include "app/gui/panels/figure_dialog.h"
#include "app/gui/panels/video_export.h"
#include "app/gui/toolkit/card.h"
#include "core/error.h"
#include "field/sampling/line_profile.h"
#include "haptics/spacemouse/spacemouse.h"
#include "usb/usb_bus.h"
#include "visualization/export/export_files.h"
#include "visualization/layers/slice_layer.h"
#include "visualization/values/camera.h"
#include "visualization/view/figure_file.h"
#include "visualization/view/figure_picture.h"

namespace patina {
namespace {

// Speed at full deflection of the cap [picture heights/s, rad/s].
const SpaceMouseSpec kPace{.speed = 0.8, .turn_speed = 1.5};

} // namespace

CameraHand::CameraHand() : CameraHand(usbOpener("3Dconnexion SpaceMouse")) {}

CameraHand::CameraHand(std::function<std::unique_ptr<UsbTransport>()> open) {
  const LinkedSpec spec{.notes = notes_};
  device_ = makeLinkedDevice(makeSpaceMouseLink(std::move(open), kPace, spec.clock), spec);
}

bool CameraHand::move(vtkCamera& camera) {
  const DeviceState state = device_->exchange(Vec3::Zero(), 0);
  if (effectiveStatus(state) != DeviceStatus::ok) {
    last_.reset();
    return false;
  }
  const DeviceState before = last_.value_or(state);
  last_ = state;
  const Vec3 shift = state.position - before.position;
  const Eigen::AngleAxisd turn(state.orientation * before.orientation.conjugate());
  if (shift == Vec3::Zero() && turn.angle() == 0) return false;
  moveInObjectMode(camera, shift, turn.angle() * turn.axis());
  return true;
}

std::string CameraHand::problem() const {
  return notes_->status == DeviceStatus::reconnecting ? notes_->cause() : "";
}

ViewController::ViewController(const Parts& parts, QObject* parent) : QObject(parent), at_(parts) {
  connect(&at_.display, &DisplayPanel::shownChanged, this, &ViewController::show);
  connect(&at_.display, &DisplayPanel::selectionChanged, this, [this] {
    showSlices();
    offerColors();
  });
  connect(&at_.view, &SceneWidget::clicked, this, &ViewController::select);
  view().show(Layer::scale, at_.display.isShown("scale"));
  connectSlice();
  connect(&at_.display, &DisplayPanel::isoMoved, this, [this](double iso) {
    iso_ = iso;
    view().setIso(iso);
  });
  connect(&at_.display, &DisplayPanel::clipTurned, this, &ViewController::turnClip);
  connect(&at_.view, &SceneWidget::clipMoved, this, &ViewController::setClip);
  connect(&at_.paint, &PaintDisplay::showRequested, this,
          [this](std::optional<PaintQuantity> quantity) {
            for (std::size_t i = 0; i < kPaintQuantities; ++i)
              view().show(static_cast<Layer>(static_cast<std::size_t>(Layer::color) + i),
                          quantity && static_cast<std::size_t>(*quantity) == i);
            offerColors();
          });
  connect(&at_.colors, &ColorPanel::edited, this,
          [this](const std::string& thing, const ColorScale& scale) {
            scales_[thing] = scale;
            view().setColors(scales_); // Drawn before the edit is done.
            edit([thing, scale](Scene& scene) {
              scene.colors.erase(thing);
              if (scale != ColorScale{}) scene.colors[thing] = scale;
            });
          });
}

void ViewController::edit(const std::function<void(Scene&)>& change) {
  ++edits_pending_;
  emit editRequested(change);
}

void ViewController::show(const std::string& thing, bool on) {
  if (thing == "clip") return clip(on);
  if (thing == "paint") return at_.paint.setOn(on);
  view().show(*parseLayers(thing).begin(), on);
}

void ViewController::select(const QPoint& pixel) {
  if (!at_.view.isNavigating()) return;
  const auto front = at_.view.frontAt(pixel);
  if (!front) return;
  const bool colored = front->layer == Layer::mesh && at_.display.isShown("stability");
  const bool painted = front->layer == Layer::mesh && at_.paint.shown();
  const std::string number = front->slice > 0 ? std::to_string(front->slice + 1) : "";
  at_.display.select(colored   ? "stability"
                     : painted ? "paint"
                               : std::string(name(front->layer)) + number);
}

void ViewController::showSlices() {
  view().setSlices(at_.display.slices(), at_.display.slice());
  at_.view.frames().cameraMoved(); // Drawn as soon as a camera motion.
}

void ViewController::connectSlice() {
  connect(&at_.display, &DisplayPanel::slicesChanged, this, [this] {
    showSlices();
    edit([slices = at_.display.slices()](Scene& scene) { scene.slices = slices; });
  });
  connect(&at_.display, &DisplayPanel::sliceHandled, &at_.view, &SceneWidget::setSliceHandle);
  connect(&at_.display, &DisplayPanel::sliceFacing, this, [this] {
    at_.display.moveSlice({-viewDirection(*view().renderer().GetActiveCamera()), {}});
  });
  connect(&at_.view, &SceneWidget::sliceMoved, this, [this](const ClipPlane& plane) {
    at_.display.moveSlice({plane.normal, plane.normal.dot(plane.origin)});
  });
  connect(&at_.display.lineProfile(), &QToolButton::toggled, &at_.view, [this](bool on) {
    at_.view.setDrawsLine(on);
    if (!on) view().setLine(std::nullopt);
  });
  connect(&at_.view, &SceneWidget::lineDrawn, this, &ViewController::showProfile);
  connect(&at_.display, &DisplayPanel::histogramRequested, this, &ViewController::showHistogram);
}

void ViewController::showProfile(const Vec3& from, const Vec3& to, bool complete) {
  view().setLine(std::pair(from, to));
  at_.view.frames().cameraMoved();
  if (!complete || !scene_) return;
  const auto profile = profileAlong(FieldSampler(*shownField(), Sampler::high), from, to, 401);
  showPlot(*at_.view.window(), profilePlot(profile));
}

void ViewController::showHistogram() {
  if (!scene_) return;
  const SurfaceField& field = *shownField();
  const auto slice = at_.display.slices()[at_.display.slice()].value_or(SlicePosition{});
  showPlot(*at_.view.window(), histogramPlot(planeOf(field, slice), field.grid.voxel));
}

// Puts the plane through the centre, normal to the axis that is most along the sight.
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
  scene_ = nullptr;
  at_.display.lineProfile().setChecked(false);
  showStability(nullptr);
  showPaint({});
  view().setMesh(std::move(mesh));
}

void ViewController::showScene(const SceneChange& change) {
  const CompiledScene& scene = *change.scene;
  const bool edited = change.step == SceneChange::Step::edited;
  if (!edited) showStability(nullptr);
  const bool new_field = change.surface || !scene_ || shownField() != scene.paint.field;
  scene_ = change.scene;
  const double size_before = view().extent().diagonal().norm();
  if (change.surface) {
    view().setMesh(scene.mesh);
    at_.display.lineProfile().setChecked(false);
    at_.view.setField(scene.built.field); // Brushes act on the surface without relief.
    at_.mesh.showScene(scene);
  }
  if (new_field) {
    view().setField(shownField());
    at_.display.setField(shownField().get());
  }
  showPaint(scene.scene);
  if (!edited) edits_pending_ = 0;
  takeLooks();
  if (change.values) {
    view().setTipRadius(scene.scene.haptics.tip_radius.value_or(0));
    const auto band = touchBand(scene.scene.haptics);
    view().setBand(band);
    at_.display.setBand(band.has_value());
  }
  // A new scene needs a new camera and clip plane, another unit a new distance.
  const double growth = view().extent().diagonal().norm() / size_before;
  if (!edited) view().setView(ViewPreset::iso);
  if (edited && (growth > 3 || growth < 0.3)) view().fit();
  if (!edited && clip_) clip(true);
  content_ = Content::scene;
  offerColors();
}

// A scene that comes while they are edited has older colours and slices.
void ViewController::takeLooks() {
  if (edits_pending_ > 0 || !scene_) return;
  if (scene_->scene.slices != at_.display.slices()) {
    at_.display.setSlices(scene_->scene.slices);
    showSlices();
  }
  if (scene_->scene.colors == scales_) return;
  scales_ = scene_->scene.colors;
  view().setColors(scales_);
  at_.colors.setScales(scales_);
}

void ViewController::editDone() {
  edits_pending_ = std::max(0, edits_pending_ - 1);
  takeLooks();
}

void ViewController::offerColors() {
  std::string thing = aligning_ ? "error" : at_.display.selected();
  const auto paint = at_.paint.shown();
  if (thing == "paint" && paint) thing = name(layerOf(*paint));
  if (thing.starts_with("slice")) thing = "slice"; // All slices have one scale.
  at_.colors.setThing(content_ == Content::scene ? thing : "");
  emit coloredChanged();
}

void ViewController::showPaint(const Scene& scene) {
  view().setPaint(scene);
  std::vector<PaintQuantity> available;
  for (std::size_t i = 0; i < kPaintQuantities; ++i)
    if (view().hasPaint(static_cast<PaintQuantity>(i)))
      available.push_back(static_cast<PaintQuantity>(i));
  at_.paint.setAvailable(available);
  at_.display.setPaint(!available.empty());
}

void ViewController::showStability(const std::shared_ptr<const SurfaceStability>& stability) {
  stability_ = stability;
  view().setStability(stability ? stability->surface.get() : nullptr,
                      stability ? displayRatios(stability->map) : std::vector<float>{});
}

void ViewController::refresh() {
  if (hand_) {
    if (hand_->move(*view().renderer().GetActiveCamera())) at_.view.frames().cameraMoved();
    if (const std::string problem = hand_->problem(); problem != hand_problem_) {
      hand_problem_ = problem;
      if (!problem.empty()) emit notified({QString::fromStdString(problem), true});
    }
  }
  at_.view.frames().refresh();
  if (!aligning_) at_.colors.setRange(view().shownRange(at_.colors.thing()));
}

void ViewController::exportPicture() {
  vtkRenderWindow& window = *at_.view.renderWindow();
  auto* dialog = new FigureDialog({{window.GetSize()[0], window.GetSize()[1]}, window.GetDPI()},
                                  at_.view.window());
  connect(dialog, &FigureDialog::saveRequested, this, &ViewController::saveFigure);
  connect(dialog, &FigureDialog::copyRequested, this, &ViewController::copyFigure);
  dialog->open();
}

void ViewController::drawOutside(const std::function<void()>& draw) {
  at_.view.makeCurrent(); // The view's bodies are freed in its context.
  try {
    draw();
  } catch (const Error& error) {
    showProblem(at_.view.window(), tr("The picture cannot be saved"),
                QString::fromUtf8(error.what()),
                tr("Choose a folder with write permission, and a name that ends in .png, .tif, "
                   ".svg or .pdf."));
  }
  at_.view.doneCurrent(); // VTK has made others current.
  at_.view.frames().cameraMoved();
}

void ViewController::saveFigure(const Figure& figure) {
  auto* dialog = saveDialog(
      at_.view.window(), tr("Export the picture"),
      tr("PNG pictures (*.png);;TIFF pictures (*.tif *.tiff);;SVG drawings (*.svg);;PDF documents "
         "(*.pdf)"),
      QStringLiteral("patina.png"), [this, figure](const QString& path) {
        drawOutside([&] {
          patina::saveFigure(view(), figure, path.toStdString());
          emit notified({tr("Saved %1, %2").arg(path, sizeInWords(figure)), false, path});
        });
      });
  dialog->setObjectName(QStringLiteral("figure_file"));
  dialog->open();
}

void ViewController::copyFigure(const Figure& figure) {
  drawOutside([&] {
    const FigurePicture picture = drawFigure(view(), figure);
    QImage image =
        QImage(picture.rgba.data(), picture.width, picture.height, QImage::Format_RGBA8888).copy();
    const int per_metre = picture.dpi ? qRound(*picture.dpi / 0.0254) : 0;
    if (per_metre > 0) image.setDotsPerMeterX(per_metre);
    if (per_metre > 0) image.setDotsPerMeterY(per_metre);
    QApplication::clipboard()->setImage(image);
    emit notified({tr("Copied the picture, %1").arg(sizeInWords(figure))});
  });
}

std::unique_ptr<SceneView> ViewController::copyOfView() {
  auto copy = std::make_unique<SceneView>();
  const auto& haptics = scene_->scene.haptics;
  copy->setBackgroundStyle(view().backgroundStyle());
  copy->showCube(true);
  copy->setMesh(scene_->mesh);
  copy->setField(shownField());
  copy->setPaint(scene_->scene);
  copy->setAnnotations(pinAnnotations(scene_->scene.pins));
  if (stability_) copy->setStability(stability_->surface.get(), displayRatios(stability_->map));
  copy->setTipRadius(haptics.tip_radius.value_or(0));
  copy->setBand(touchBand(haptics));
  copy->setSlices(at_.display.slices());
  copy->setIso(iso_);
  copy->setClip(clip_);
  for (const Layer layer : allLayers()) copy->show(layer, view().shown(layer));
  copy->setColors(scales_);
  copy->renderer().GetActiveCamera()->DeepCopy(view().renderer().GetActiveCamera());
  return copy;
}

void ViewController::exportVideo() {
  askForPath(at_.view.window(), tr("Recording to replay"), QFileDialog::ExistingFile,
             tr("Recordings (*.csv)"), [this](const QString& recording) {
               auto* dialog = saveDialog(
                   at_.view.window(), tr("Export video"), tr("Videos (*.ogv)"),
                   QFileInfo(recording).completeBaseName() + QStringLiteral(".ogv"),
                   [this, recording](const QString& path) { writeVideo(recording, path); });
               dialog->open();
             });
}

void ViewController::writeVideo(const QString& recording, const QString& path) {
  const auto refuse = [this](const QString& cause) {
    showProblem(at_.view.window(), tr("The video cannot be written"), cause,
                tr("Choose a recording of this scene, and a folder with write permission."));
  };
  if (!scene_) return;
  try {
    Figure figure;
    const int* size = at_.view.renderWindow()->GetSize();
    figure.width = size[0] * 3 / 2; // The plot stands beside the whole picture.
    figure.height = size[1];
    figure.magnification = std::max(1., at_.view.renderWindow()->GetDPI() / 72.);
    figure.keeps_camera = true;
    auto* job = new VideoExport(copyOfView(), readToolSamplesCsv(recording.toStdString()), figure,
                                path, at_.view.window());
    connect(job, &VideoExport::failed, this, refuse);
    connect(job, &VideoExport::written, this, [this](const QString& file) {
      emit notified({tr("Saved %1").arg(file), false, file});
    });
  } catch (const Error& error) {
    refuse(QString::fromUtf8(error.what()));
  }
}

} // namespace patina
