#include "app/gui/window/tour.h"

#include <cmath>
#include <functional>

#include <QImage>

#include "app/gui/control/desk_controller.h"
#include "app/gui/window/tour_hand.h"
#include "app/gui/window/wait.h"
#include "core/error.h"
#include "core/numbers.h"
#include "visualization/export/export_files.h"
#include "visualization/view/camera.h"

namespace patina {
namespace {

void openAndWait(MainWindow& window, const LoadRequest& request) {
  QString problem;
  bool ready = false;
  DocumentController& documents = window.controllers().documents;
  const auto failed = QObject::connect(&documents, &DocumentController::failed,
                                       [&](const QString& message) { problem = message; });
  const auto done = QObject::connect(&window, &MainWindow::sceneReady, [&] { ready = true; });
  SceneLoader& loader = find<SceneLoader>(window);
  const auto unit = QObject::connect(&loader, &SceneLoader::needsUnit, [&] {
    problem = QStringLiteral("its size in millimetres is odd: say --unit fit, m, cm, mm or in");
  });
  const auto iso = QObject::connect(&loader, &SceneLoader::needsIso, [&] {
    problem = QStringLiteral("a volume needs the value of its surface: say --iso VALUE");
  });
  LoadRequest only_read = request; // what the tour shows is nobody's edit
  only_read.own = false;
  documents.open(only_read);
  const bool in_time = waitUntil([&] { return ready || !problem.isEmpty(); }, 10 * 60 * 1000);
  for (const auto& connection : {failed, done, unit, iso}) QObject::disconnect(connection);
  if (!problem.isEmpty()) throw Error(problem.toStdString());
  if (!in_time) throw Error("the scene was not ready after ten minutes");
}

bool isBlank(const QImage& image) {
  const QRgb first = image.pixel(image.width() / 2, image.height() / 2);
  for (int y = 0; y < image.height(); y += 3)
    for (int x = 0; x < image.width(); x += 3)
      if (image.pixel(x, y) != first) return false;
  return true;
}

void grab(MainWindow& window, const std::filesystem::path& path) {
  wait(120);
  waitUntil([&] { return find<SceneWidget>(window).frames().settled(); }, 5000);
  if (isBlank(find<SceneWidget>(window).grabFramebuffer()))
    throw Error("nothing was drawn: OpenGL gave an empty picture");
  if (!window.grab().toImage().save(QString::fromStdString(path.string()), "PNG", 0))
    throw FileError(path.string(), 0, "cannot be written");
}

// Nearer to where the tool is.
void lookCloser(MainWindow& window, double factor) {
  vtkCamera& camera = *find<SceneWidget>(window).view().renderer().GetActiveCamera();
  const Vec3 shift = window.controllers().feel.sample().vcp - Vec3(camera.GetFocalPoint());
  const Vec3 eye = Vec3(camera.GetPosition()) + shift;
  camera.SetPosition(eye[0], eye[1], eye[2]);
  const Vec3& at = window.controllers().feel.sample().vcp;
  camera.SetFocalPoint(at[0], at[1], at[2]);
  zoom(camera, factor);
}

void show(MainWindow& window, std::set<Layer> layers) {
  for (const Layer layer : allLayers())
    find<DisplayPanel>(window).setShown(layer, layers.count(layer) != 0);
}

void checkFelt(const std::vector<ToolSample>& samples) {
  std::size_t touching = 0;
  double highest = 0;
  for (const ToolSample& sample : samples) {
    if (sample.contact) ++touching;
    highest = std::max(highest, sample.force.norm());
  }
  if (samples.empty()) throw Error("the servo gave no sample");
  if (touching == 0 || highest <= 0)
    throw Error("the tip touched nothing in " + formatCount(samples.size()) + " ticks");
}

void edit(MainWindow& window, const std::function<void(HapticProperties&)>& change) {
  HapticsPanel& panel = find<HapticsPanel>(window);
  HapticProperties haptics = panel.values();
  change(haptics);
  panel.setValues(haptics);
  emit panel.edited(haptics);
  wait(250);
}

// As a person types it, in the row's own unit.
void setRow(MainWindow& window, const char* name, double value) {
  find<ValueRow>(window, name).findChild<QDoubleSpinBox*>()->setValue(value);
}

// The tip on the offset surface, and the magnetic band cut by the slice.
void showBands(MainWindow& window, const std::filesystem::path& folder) {
  const double edge = 3 * window.controllers().edits.scene()->built.field->grid.voxel;
  edit(window, [&](HapticProperties& haptics) {
    haptics.magnet.reset();
    haptics.offset = edge;
  });
  const Vec2 place = placeToTouch(window);
  press(window, place, -0.35 * edge, 1200);
  lookCloser(window, 2);
  grab(window, folder / "offset.png");
  play(window, {find<SceneWidget>(window).restingPlace()});
  wait(400);
  edit(window, [&](HapticProperties& haptics) {
    haptics.offset.reset();
    haptics.magnet = Magnet{edge, 300, true};
  });
  show(window, {Layer::mesh, Layer::slice, Layer::band});
  find<SceneWidget>(window).view().setView(ViewPreset::iso);
  grab(window, folder / "magnet.png");
  edit(window, [](HapticProperties& haptics) { haptics.magnet.reset(); });
}

// A surface near the limit of a device, so that its form decides where it would buzz.
void showStability(MainWindow& window, const std::filesystem::path& folder) {
  DevicePanel& panel = find<DevicePanel>(window);
  DeviceChoice choice = panel.values();
  if (!choice.model) choice.model = DeviceModel{0.1, 0.5, 0.05, 30e-6, 1000, 0};
  panel.setValues(choice);
  emit panel.edited();
  edit(window, [](HapticProperties& haptics) { haptics.stiffness = 1500; });
  window.controllers().desks.choose(Desk::analyse);
  show(window, {Layer::mesh, Layer::tip, Layer::stability});
  if (!waitUntil([&] { return !window.controllers().feel.stability().busy(); }, 120000))
    throw Error("the stability map was not ready after two minutes");
  grab(window, folder / "stability.png");
  show(window, {Layer::mesh, Layer::band, Layer::tip});
}

// The same file once more, beside what is open.
void showObjects(MainWindow& window, const LoadRequest& request,
                 const std::filesystem::path& folder) {
  window.controllers().desks.open(Panel::objects);
  const double wide = 0.8 * find<SceneWidget>(window).view().extent().sizes()[0];
  LoadRequest more = request;
  more.adds = true;
  openAndWait(window, more);
  QListWidget& list = find<QListWidget>(window, "objects");
  list.setCurrentRow(list.count() - 1);
  find<QDoubleSpinBox>(window, "place_x").setValue(1000 * wide);
  bool moved = false;
  const auto done = QObject::connect(&window, &MainWindow::sceneReady, [&] { moved = true; });
  const bool in_time = waitUntil([&] { return moved; }, 10 * 60 * 1000);
  QObject::disconnect(done);
  if (!in_time) throw Error("the second object was not there after ten minutes");
  find<SceneWidget>(window).view().setView(ViewPreset::iso);
  play(window, {find<SceneWidget>(window).restingPlace()});
  wait(400);
  grab(window, folder / "objects.png");
}

// Stripes of stiffness, a raised ring and a spot of colour, as a person lays them on.
void showPainting(MainWindow& window, const std::filesystem::path& folder) {
  EditController& edits = window.controllers().edits;
  const std::size_t before = edits.status().done;
  const double extent = bounds(*edits.scene()->mesh).sizes().maxCoeff();
  find<SceneWidget>(window).view().setView(ViewPreset::iso);
  const Vec2 middle = placeToTouch(window);
  const auto choose = [&](Tool tool, double value, double falloff, double share) {
    find<ToolBar>(window).choose({Handling::paint, tool});
    if (tool != Tool::color) setRow(window, "brush_value", value);
    setRow(window, "brush_falloff", falloff);
    setRow(window, "brush_radius", 1000 * share * extent);
    wait(200);
  };
  const auto line = [&](const Vec2& from, const Vec2& to) {
    paintAlong(
        window, [&](double t) { return Vec2(from + t * (to - from)); }, 900);
  };
  choose(Tool::color, 0, 4, 0.02);
  line(middle + Vec2(-0.05, 0.02), middle + Vec2(0.06, 0.03));
  choose(Tool::relief, 6 * extent, 2, 0.012);
  const auto ring = [&](double t) {
    return Vec2(middle + 0.03 * Vec2(std::cos(2 * M_PI * t), std::sin(2 * M_PI * t)));
  };
  paintAlong(window, ring, 1500);
  grab(window, folder / "relief.png");
  choose(Tool::material(MaterialChannel::stiffness), 1100, 4, 0.03);
  const Vec2 from = middle + Vec2(-0.05, 0.0), to = middle + Vec2(0.06, 0.01);
  paintAlong(
      window, [&](double t) { return Vec2(from + t * (to - from)); }, 900,
      [&] { grab(window, folder / "paint.png"); }); // tool, force and brush together
  find<ToolBar>(window).choose({Handling::feel, {}});
  edits.thread().goTo(before);
  if (!waitUntil([&] { return edits.status().done == before; }, 20000))
    throw Error("what the tour painted was not undone");
}

} // namespace

void runTour(MainWindow& window, const LoadRequest& request, const std::filesystem::path& folder) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) throw FileError(folder.string(), 0, "cannot be made: " + code.message());
  openAndWait(window, request);
  window.controllers().desks.open(Panel::forces);
  wait(300);
  FeelController& feel = window.controllers().feel;
  feel.startLog();
  const double depth = 3.5 * window.controllers().edits.scene()->built.field->grid.voxel;
  const Vec2 start = placeToTouch(window);
  const Vec2 end = start + Vec2(-0.06, 0.03);
  press(window, start, depth, 1200);
  slide(window, start, end, depth, 2400);
  grab(window, folder / "window.png");

  lookCloser(window, 3.2);
  // The person gives the surface friction and strokes on: one row more, one stage more.
  const HapticProperties opened = find<HapticsPanel>(window).values();
  edit(window, [](HapticProperties& haptics) {
    if (!haptics.friction) haptics.friction = Friction{0.5, 0.3, 0, {}};
  });
  slide(window, Vec2::Zero(), Vec2(0.14, -0.06), depth, 2400);
  grab(window, folder / "feel.png");

  show(window, {Layer::mesh, Layer::tip, Layer::wireframe, Layer::nodes});
  lookCloser(window, 1.8);
  grab(window, folder / "nodes.png");

  play(window, {find<SceneWidget>(window).restingPlace()});
  wait(300);
  window.controllers().desks.choose(Desk::analyse);
  show(window, {Layer::mesh, Layer::slice, Layer::iso, Layer::extent});
  setRow(window, "iso_value", 1500 * window.controllers().edits.scene()->built.field->grid.voxel);
  find<SceneWidget>(window).view().setView(ViewPreset::iso);
  grab(window, folder / "slice.png");
  show(window, {Layer::mesh, Layer::band, Layer::tip});
  window.controllers().desks.choose(Desk::feel);

  const std::vector<ToolSample> samples = feel.log().samples();
  feel.log().clear();
  checkFelt(samples);
  edit(window, [&](HapticProperties& haptics) { haptics = opened; });
  wait(600);
  showPainting(window, folder);
  showBands(window, folder);
  showStability(window, folder);
  showObjects(window, request, folder);
  writeToolSamplesCsv(folder / "feel.csv", samples);
}

} // namespace patina
