#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include "field/store/surface_field.h"
#include "geometry/mesh/shapes.h"
#include "picture/picture_support.h"
#include "visualization/view/picture.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

Pixels drawnLayers(SceneView& view, const std::string& name, const std::set<Layer>& layers) {
  view.showOnly(layers);
  view.setView(ViewPreset::minus_y); // +x to the right
  const char* keep = std::getenv("PATINA_KEEP_PICTURES");
  const fs::path folder = keep != nullptr ? fs::path(keep) : fs::temp_directory_path();
  const fs::path path = folder / (name + "-" + std::to_string(getpid()) + ".png");
  renderToPng(view, {960, 720}, path);
  Pixels pixels(path);
  if (keep == nullptr) fs::remove(path);
  return pixels;
}

// Buzzes on the left, stable on the right, unknown in between.
TEST(StabilityPicture, ColoursTheSurfaceByItsVerticesAndShowsTheScale) {
  PATINA_NEEDS_DISPLAY();
  SceneView view;
  const auto mesh = std::make_shared<const TriangleMesh>(icosphere(0.03, 20));
  std::vector<float> ratio;
  for (const Vec3& p : mesh->positions)
    ratio.push_back(std::abs(p.x()) < 4e-3 ? NAN : p.x() < 0 ? 0.3F : 3.5F);
  view.setMesh(mesh);
  const auto unknown = [](const Vec3& c) {
    return c.maxCoeff() < 130 && c.maxCoeff() - c.minCoeff() < 30;
  };
  EXPECT_EQ(drawnLayers(view, "stability-none", {Layer::mesh, Layer::stability}).share(isWarm), 0);

  view.setStability(mesh.get(), ratio);
  const Pixels pixels = drawnLayers(view, "stability", {Layer::mesh, Layer::stability});
  EXPECT_GT(pixels.share(isWarm, 0.14, 0.42), 0.2);
  EXPECT_EQ(pixels.share(isWarm, 0.46, 0.85), 0);
  EXPECT_GT(pixels.share(isCool, 0.46, 0.85), 0.2);
  EXPECT_GT(pixels.share(unknown, 0.385, 0.415, 0.3, 0.7), 0.8);
  EXPECT_EQ(pixels.share(isSurface), 0); // in the mesh's place
  // The scale, and room for it.
  EXPECT_GT(pixels.share(isWarm, 0.88, 1, 0.2, 0.8), 0.01);
  EXPECT_GT(pixels.share(isCool, 0.88, 1, 0.2, 0.8), 0.01);
  EXPECT_LT(pixels.share(isCool, 0.855, 0.88), 0.001);

  view.setStability(nullptr, {});
  EXPECT_GT(drawnLayers(view, "stability-gone", {Layer::mesh, Layer::stability}).share(isSurface),
            0.1);
}

// A shell over the colours would shift them away from the scale.
TEST(StabilityPicture, IsTheSameUnderABandThatTintsOnlyTheSlice) {
  PATINA_NEEDS_DISPLAY();
  SceneView view;
  const auto mesh = std::make_shared<const TriangleMesh>(icosphere(0.03, 20));
  view.setMesh(mesh);
  FieldSpec spec;
  spec.resolution = 60;
  spec.band = 8;
  const FieldGrid grid = gridAround(Box3(Vec3::Constant(-0.03), Vec3::Constant(0.03)), spec);
  view.setField(std::make_shared<SurfaceField>(
      sampleFunction([](const Vec3& p) { return p.norm() - 0.03; }, grid, spec.band)));
  view.setStability(mesh.get(), std::vector<float>(mesh->positions.size(), 3.5F));
  const Pixels plain = drawnLayers(view, "stability-plain", {Layer::stability});
  view.setBand(TouchBand{TouchBand::Kind::offset, 2e-3});
  const Pixels banded = drawnLayers(view, "stability-band", {Layer::stability, Layer::band});
  for (int y = 0; y < plain.height(); ++y)
    for (int x = 0; x < plain.width(); ++x) ASSERT_EQ(banded.at(x, y), plain.at(x, y));

  const std::set<Layer> cut{Layer::stability, Layer::band, Layer::slice};
  EXPECT_GT(drawnLayers(view, "stability-slice", cut).share(isGold, 0.2, 0.8, 0.1, 0.9), 0.002);
  view.setStability(nullptr, {});
  EXPECT_GT(drawnLayers(view, "stability-off", {Layer::mesh, Layer::band}).share(isGold), 0.1);
}

} // namespace
} // namespace patina
