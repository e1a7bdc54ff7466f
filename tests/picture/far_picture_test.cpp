// Objects far from the origin, such as geo-referenced scans, are drawn like objects at the origin.
#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include "field/store/surface_field.h"
#include "geometry/atlas/texture_layout.h"
#include "picture/picture_support.h"
#include "support/painted_objects.h"
#include "visualization/layers/stability_layer.h"
#include "visualization/view/picture.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr double kCube = 0.05;

// A cube of 50 mm about `middle` with all layers of a view; the camera is set apart.
struct Shown {
  explicit Shown(const Vec3& middle) {
    TriangleMesh mesh = box(Vec3::Constant(kCube), 4);
    for (Vec3& p : mesh.positions) p += middle;
    FieldSpec spec;
    spec.resolution = 60;
    spec.band = 8;
    const Box3 around(middle - Vec3::Constant(kCube / 2), middle + Vec3::Constant(kCube / 2));
    const auto distance = [&](const Vec3& p) {
      const Vec3 q = (p - middle).cwiseAbs() - Vec3::Constant(kCube / 2);
      return q.cwiseMax(0).norm() + std::min(0.0, q.maxCoeff());
    };
    field = std::make_shared<SurfaceField>(
        sampleFunction(distance, gridAround(around, spec), spec.band));

    SceneObject object = objectOf(mesh);
    ObjectPaint paint;
    paint.layout = generateAtlas(mesh, 256);
    const Vec3 corner = middle + Vec3(0.5, -0.5, 0.5) * kCube;
    const auto spot = [corner](const Vec3& p) { return (p - corner).norm() < 0.02; };
    paint.color =
        imageOf(mesh, *paint.layout.uvs, 256, kColorChannels, [&](const Vec3& p, float* v) {
          if (spot(p)) ink(v, {0.9, 0.1, 0.1});
        });
    paint.relief = imageOf(mesh, *paint.layout.uvs, 256, 1, [&](const Vec3& p, float* v) {
      *v = static_cast<float>(std::cos(400 * (p - middle).sum()));
    });
    paint.material = materialOf(
        around, 0.001, MaterialChannel::stiffness,
        [&](const Vec3& p) { return 500 + 1e4 * (p - middle).x(); }, spot);
    setPaint(object, paint);
    scene.objects = {object};

    auto shared = std::make_shared<const TriangleMesh>(mesh);
    std::vector<float> ratio;
    for (const Vec3& p : mesh.positions)
      ratio.push_back(static_cast<float>(1 + 30 * (p - middle).x()));
    view.setMesh(shared);
    view.setField(field);
    view.setIso(0.002);
    view.setPaint(scene);
    view.setBand(TouchBand{TouchBand::Kind::offset, 0.003});
    view.setStability(&mesh, ratio);
    ToolSample sample;
    sample.contact = true;
    sample.vcp = sample.surface = middle + Vec3(0.01, -kCube / 2, 0.01);
    sample.tip = sample.vcp + Vec3(0, 0.002, 0);
    sample.normal = -Vec3::UnitY();
    sample.force = Vec3(0, -1.5, 0);
    sample.depth = 0.002;
    view.setTool(sample);
    brush.centre = middle + Vec3(0, -kCube / 2, 0.005);
    brush.normal = -Vec3::UnitY();
    brush.radius = 0.012;
    brush.half_radius = 0.006;
    mirror = {Vec3(middle + 0.04 * Vec3(0, -1, -1)), Vec3(middle + 0.04 * Vec3(0, 1, -1)),
              Vec3(middle + 0.04 * Vec3(0, 1, 1)), Vec3(middle + 0.04 * Vec3(0, -1, 1))};
    clip = {middle + Vec3(0, -0.01, 0), Vec3(0.3, -1, 0.2).normalized()};
  }

  Pixels drawn(const std::string& name, const std::set<Layer>& layers) {
    view.showOnly(layers);
    view.setView(ViewPreset::iso);
    const char* keep = std::getenv("PATINA_KEEP_PICTURES");
    const fs::path folder = keep != nullptr ? fs::path(keep) : fs::temp_directory_path();
    const fs::path path = folder / ("far_" + name + "-" + std::to_string(getpid()) + ".png");
    renderToPng(view, {480, 360}, path);
    Pixels pixels(path);
    if (keep == nullptr) fs::remove(path);
    return pixels;
  }

  std::shared_ptr<const SurfaceField> field;
  Scene scene;
  BrushCursorState brush;
  MirrorState mirror;
  ClipPlane clip;
  SceneView view;
};

double shareApart(const Pixels& a, const Pixels& b) {
  int apart = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x)
      apart += (a.at(x, y) - b.at(x, y)).cwiseAbs().maxCoeff() > 24;
  return static_cast<double>(apart) / (a.width() * a.height());
}

TEST(FarPicture, EqualsThePictureAtTheOrigin) {
  PATINA_NEEDS_DISPLAY();
  Shown near(Vec3::Zero());
  const std::pair<const char*, std::set<Layer>> cases[] = {
      {"mesh", {Layer::mesh, Layer::wireframe, Layer::extent}},
      {"tip", {Layer::mesh, Layer::tip, Layer::scale}},
      {"iso", {Layer::mesh, Layer::iso}},
      {"band", {Layer::mesh, Layer::band}},
      {"slice", {Layer::mesh, Layer::slice, Layer::band}},
      {"nodes", {Layer::mesh, Layer::nodes, Layer::tip}},
      {"stability", {Layer::stability}},
      {"color", {Layer::mesh, Layer::color}},
      {"relief", {Layer::mesh, Layer::relief}},
      {"material", {Layer::mesh, layerOf(quantityOf(MaterialChannel::stiffness))}}};
  Shown far(Vec3(4.5e6, 5.2e6, 300));
  const auto compare = [&](Shown& there, const std::string& name, const std::set<Layer>& layers) {
    EXPECT_LT(shareApart(there.drawn(name + "_far", layers), near.drawn(name, layers)), 0.003)
        << name;
  };
  for (const auto& [name, layers] : cases) compare(far, name, layers);
  Shown farther(Vec3(-1e7, 0, 1e5));
  compare(farther, "farther", {Layer::mesh, Layer::color, Layer::tip});
  for (Shown* shown : {&near, &far}) {
    shown->view.setClip(shown->clip);
    shown->view.setBrush(shown->brush);
    shown->view.setMirror(shown->mirror);
  }
  compare(far, "handles", {Layer::mesh, Layer::color});
}

} // namespace
} // namespace patina
