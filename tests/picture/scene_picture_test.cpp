#include <array>
#include <cmath>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include <vtkCamera.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRendererCollection.h>

#include "core/error.h"
#include "field/store/surface_field.h"
#include "geometry/mesh/shapes.h"
#include "picture/picture_support.h"
#include "visualization/values/camera.h"
#include "visualization/view/picture.h"
#include "visualization/view/png.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr double kMajor = 0.035, kMinor = 0.015;

double torusDistance(const Vec3& p) {
  return std::hypot(std::hypot(p[0], p[1]) - kMajor, p[2]) - kMinor;
}

std::shared_ptr<const SurfaceField> torusField() {
  FieldSpec spec;
  spec.resolution = 120;
  spec.band = 8;
  const Box3 box(Vec3(-kMajor - kMinor, -kMajor - kMinor, -kMinor),
                 Vec3(kMajor + kMinor, kMajor + kMinor, kMinor));
  return std::make_shared<SurfaceField>(
      sampleFunction(torusDistance, gridAround(box, spec), spec.band));
}

class ScenePicture : public ::testing::Test {
 protected:
  void SetUp() override {
    PATINA_NEEDS_DISPLAY();
    view_.setMesh(std::make_shared<TriangleMesh>(torus(kMajor, kMinor, 160, 80)));
    view_.setField(torusField());
  }
  Pixels drawn(const std::string& name, const std::set<Layer>& layers,
               ViewPreset preset = ViewPreset::iso, const PictureSize& size = {960, 720}) {
    view_.showOnly(layers);
    view_.setView(preset);
    const char* keep = std::getenv("PATINA_KEEP_PICTURES");
    const fs::path folder = keep != nullptr ? fs::path(keep) : fs::temp_directory_path();
    const fs::path path = folder / (name + "-" + std::to_string(getpid()) + ".png");
    renderToPng(view_, size, path);
    Pixels pixels(path);
    if (keep == nullptr)
      fs::remove(path);
    else
      fs::rename(path, folder / (name + ".png"));
    return pixels;
  }
  ToolSample pressed() const {
    ToolSample sample;
    sample.contact = true;
    sample.vcp = sample.surface = Vec3(0, -kMajor, kMinor);
    sample.tip = Vec3(0, -kMajor, kMinor - 0.003);
    sample.normal = Vec3::UnitZ();
    sample.force = Vec3(0, 0, 1.5);
    sample.depth = 0.003;
    return sample;
  }
  SceneView view_;
};

TEST_F(ScenePicture, TorusFromAboveFillsItsRingAndLeavesItsHole) {
  const Pixels pixels = drawn("above", {Layer::mesh}, ViewPreset::plus_z);
  EXPECT_EQ(pixels.width(), 960);
  // The ring's area over the picture's, from the fit: the outer diameter takes 1/1.08 of the
  // height.
  const double scale = 1 / 1.08 / (2 * (kMajor + kMinor));
  const double ring = 4 * M_PI * kMajor * kMinor * scale * scale * 0.75 / 0.86;
  EXPECT_NEAR(pixels.share(isSurface), ring, 0.15 * ring);
  EXPECT_EQ(pixels.share(isSurface, 0.47, 0.53, 0.47, 0.53), 0);
}

TEST_F(ScenePicture, HiddenLayersDrawNothing) {
  const Pixels pixels = drawn("nothing", {Layer::extent});
  EXPECT_EQ(pixels.share(isSurface), 0);
}

TEST_F(ScenePicture, SliceShowsBothSignsAndCutsTheSurfaceOpen) {
  view_.setSlices({});
  const Pixels pixels = drawn("slice", {Layer::mesh, Layer::slice, Layer::extent});
  EXPECT_GT(pixels.share(isWarm), 0.02);
  EXPECT_GT(pixels.share(isCool), 0.02);
  EXPECT_GT(pixels.share(isSurface), 0.04); // the half behind the plane
  // The scalar bar stands at the right edge: both ends of the map, and dark text.
  EXPECT_GT(pixels.share(isWarm, 0.88, 1, 0.2, 0.8), 0.01);
  EXPECT_GT(pixels.share(isCool, 0.88, 1, 0.2, 0.8), 0.01);
  EXPECT_GT(pixels.share([](const Vec3& c) { return c.maxCoeff() < 110; }, 0.88, 1, 0.2, 0.8),
            0.003);
}

TEST_F(ScenePicture, ScaleBarIsARoundLengthAtAnyZoomAndClosesWithTheScene) {
  // The longest dark run in the rows of the bar, right of the axes [pixels].
  const auto run = [](const Pixels& pixels) {
    int longest = 0;
    for (int y = 6; y < 18; ++y)
      for (int x = int(0.13 * pixels.width()), now = 0; x < pixels.width(); ++x) {
        now = pixels.at(x, y).maxCoeff() < 150 ? now + 1 : 0;
        longest = std::max(longest, now);
      }
    return longest;
  };
  std::vector<double> lengths;
  for (const double size : {0.2, 1.0, 37.0}) {
    TriangleMesh mesh = torus(kMajor, kMinor, 60, 30);
    for (Vec3& p : mesh.positions) p *= size;
    view_.setField(nullptr);
    view_.setMesh(std::make_shared<TriangleMesh>(mesh));
    const int bar = run(drawn("scale", {Layer::scale}, ViewPreset::plus_z));
    vtkCamera& camera = *view_.renderer().GetActiveCamera();
    const double pixel =
        2 * camera.GetDistance() * std::tan(camera.GetViewAngle() * M_PI / 360) / 720;
    ASSERT_GT(bar, 40) << size;
    const double length = bar * pixel, power = std::pow(10, std::floor(std::log10(0.9 * length)));
    const double round = length < 1.5 * power ? power
                         : length < 3 * power ? 2 * power
                         : length < 7 * power ? 5 * power
                                              : 10 * power;
    EXPECT_NEAR(length, round, 3 * pixel) << size;
    lengths.push_back(round);
    EXPECT_LT(run(drawn("no_scale", {Layer::extent}, ViewPreset::plus_z)), 5);
  }
  EXPECT_LT(lengths[0], lengths[1]);
  EXPECT_LT(lengths[1], lengths[2]);
  view_.setMesh(nullptr);
  EXPECT_LT(run(drawn("nothing_open", {Layer::scale}, ViewPreset::plus_z)), 5);
}

TEST_F(ScenePicture, BandIsAShellInItsOwnColourWithALegend) { // K12, K13
  EXPECT_EQ(drawn("no_band", {Layer::mesh, Layer::band}).share(isGold), 0);
  view_.setBand(TouchBand{TouchBand::Kind::offset, 0.003});
  const Pixels offset = drawn("offset_band", {Layer::mesh, Layer::band});
  EXPECT_GT(offset.share(isGold), 0.2);
  EXPECT_EQ(offset.share(isMagenta), 0);
  const auto dark = [](const Vec3& c) { return c.maxCoeff() < 175 && c[0] > c[2] + 60; };
  EXPECT_GT(offset.share(dark, 0.01, 0.2, 0.9, 1), 0.004); // the words
  view_.setBand(TouchBand{TouchBand::Kind::magnet, 0.003});
  const Pixels magnet = drawn("magnet_band", {Layer::mesh, Layer::band});
  EXPECT_GT(magnet.share(isMagenta), 0.03); // over the sage object it is grey
  EXPECT_EQ(magnet.share(isGold), 0);
}

TEST_F(ScenePicture, SliceShowsTheBandAsTintAndLine) {
  view_.setBand(TouchBand{TouchBand::Kind::magnet, 0.003});
  view_.setSlices({});
  const auto seen = [this](const char* name, const std::set<Layer>& layers) {
    return drawn(name, layers, ViewPreset::minus_y).share(isMagenta);
  };
  EXPECT_EQ(seen("slice_without_band", {Layer::slice}), 0);
  // The tinted ring's area: both discs of the cut torus, grown by 3 mm.
  const double scale = 1 / 1.08 / (2 * (kMajor + kMinor + 0.003));
  const double rings = 2 * M_PI * (0.018 * 0.018 - 0.015 * 0.015) * scale * scale;
  EXPECT_GT(seen("slice_band", {Layer::slice, Layer::band}), 0.3 * rings);
}

TEST_F(ScenePicture, BandBeyondTheFieldIsWordsOnly) {
  view_.setBand(TouchBand{TouchBand::Kind::offset, 0.03});
  const Pixels pixels = drawn("band_too_wide", {Layer::mesh, Layer::band});
  EXPECT_EQ(pixels.share(isGold, 0.14, 1, 0, 0.9), 0);
  const auto dark = [](const Vec3& c) { return c.maxCoeff() < 175 && c[0] > c[2] + 60; };
  EXPECT_GT(pixels.share(dark, 0.01, 0.6, 0.9, 1), 0.004);
}

TEST_F(ScenePicture, ToolForceAndLabelAreDrawnOverTheSurface) {
  view_.setTipRadius(0.002);
  view_.setTool(pressed());
  const Pixels pixels = drawn("tool", {Layer::mesh, Layer::tip});
  EXPECT_GT(pixels.share(isTool), 0.0002);
  EXPECT_GT(pixels.share(isForce), 0.002);
  EXPECT_GT(pixels.share(isSurface), 0.2);
}

TEST_F(ScenePicture, FitsAForceArrowBeyondTheObject) {
  ToolSample sample = pressed();
  sample.force = Vec3(0, 0, 3.2);
  view_.setTool(sample);
  const Pixels pixels = drawn("long_arrow", {Layer::mesh, Layer::tip}, ViewPreset::plus_z);
  const Pixels side = drawn("long_arrow_side", {Layer::mesh, Layer::tip}, ViewPreset::minus_y);
  EXPECT_GT(side.share(isForce), 0.003);
  EXPECT_EQ(side.share(isForce, 0, 1, 0.99, 1), 0);
  EXPECT_GT(pixels.share(isSurface), 0.2); // seen from its end it takes no room
}

// The picture is not fitted to the arrow, and the tip may be anywhere.
TEST_F(ScenePicture, LargeForceStaysInThePictureAndItsNumberOffTheCube) {
  view_.showCube(true);
  view_.showOnly({Layer::mesh, Layer::tip});
  view_.setView(ViewPreset::minus_y);
  const vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(8);
  window->SetSize(960, 720);
  view_.attachTo(*window);
  view_.prepare();
  view_.fit();
  const std::array<std::array<double, 4>, 4> edges{
      {{0, 1, 0.995, 1}, {0, 1, 0, 0.005}, {0, 0.004, 0, 1}, {0.996, 1, 0, 1}}};
  const fs::path path =
      fs::temp_directory_path() / ("large_force-" + std::to_string(getpid()) + ".png");
  for (const double across : {-1.0, 0.0, 1.0})
    for (const double up : {-1.0, 1.0}) {
      ToolSample sample = pressed();
      sample.force = Vec3(8 * across, 0, 8 * up);
      sample.vcp = sample.surface = sample.tip =
          Vec3(across * (kMajor + 0.5 * kMinor), -kMinor, up * kMinor);
      view_.setTool(sample);
      view_.prepare();
      window->Render();
      writeWindowPng(*window, path);
      const Pixels pixels(path);
      if (const char* keep = std::getenv("PATINA_KEEP_PICTURES"))
        fs::copy_file(path,
                      fs::path(keep) / ("large_force" + std::to_string(across).substr(0, 2) +
                                        std::to_string(up).substr(0, 2) + ".png"),
                      fs::copy_options::overwrite_existing);
      EXPECT_GT(pixels.share(isForce, 0, 1, 0, 1), 0.0008) << across << " " << up;
      for (const auto& [left, right, low, high] : edges)
        EXPECT_EQ(pixels.share(isForce, left, right, low, high), 0) << across << " " << up;
      EXPECT_LT(pixels.share(isForce, 0, 0.12, 0, 0.16), 1e-4) << across << " " << up;
    }
  fs::remove(path);
  while (vtkRenderer* renderer = window->GetRenderers()->GetFirstRenderer())
    window->RemoveRenderer(renderer);
}

TEST_F(ScenePicture, NoForceArrowWithoutContact) {
  ToolSample sample;
  sample.tip = sample.vcp = Vec3(0, -kMajor, 0.03);
  view_.setTool(sample);
  const Pixels pixels = drawn("free", {Layer::mesh, Layer::tip});
  EXPECT_GT(pixels.share(isTool), 0.0001);
  EXPECT_EQ(pixels.share(isForce), 0);
}

TEST_F(ScenePicture, NodesNearTheTipShowBothSidesOfTheSurface) {
  view_.setTool(pressed());
  const Pixels pixels = drawn("nodes", {Layer::mesh, Layer::nodes, Layer::wireframe});
  EXPECT_GT(pixels.share(isWarm), 0.0005);
  EXPECT_GT(pixels.share(isCool), 0.0002);
}

TEST_F(ScenePicture, IsoSurfaceAtZeroReplacesTheMesh) {
  view_.setIso(0);
  const Pixels pixels = drawn("iso_0", {Layer::mesh, Layer::iso});
  EXPECT_GT(pixels.share(isCool), 0.2);
  EXPECT_LT(pixels.share(isSurface), 0.002) << "two coincident surfaces flicker";
}

TEST_F(ScenePicture, AxesLettersAreWholeInASmallPicture) {
  const Pixels pixels = drawn("small", {Layer::mesh}, ViewPreset::iso, {680, 440});
  const auto blue = [](const Vec3& c) { return c[2] > c[0] + 60 && c[2] > c[1] + 30; };
  int y = pixels.height() / 2, across = 0;
  for (; y > 0 && across == 0; --y)
    for (int x = 0; x < pixels.width() / 5; ++x) across += blue(pixels.at(x, y)) ? 1 : 0;
  EXPECT_GE(across, 5) << "the upper bar of the Z, not its middle";
}

TEST_F(ScenePicture, IsoSurfaceAloneLooksLikeTheShape) {
  view_.setIso(0.001);
  const Pixels pixels = drawn("iso", {Layer::iso});
  EXPECT_GT(pixels.share(isCool), 0.2);
}

TEST_F(ScenePicture, UnmovedTipRestsOnTheSurface) {
  const Pixels pixels = drawn("resting", {Layer::mesh, Layer::tip}, ViewPreset::plus_y);
  EXPECT_GT(pixels.share(isTool, 0.4, 0.6, 0.4, 0.6), 0.001);
}

TEST(Picture, GivesAdviceWithoutADisplay) {
  const char* display = std::getenv("DISPLAY");
  const std::string kept = display != nullptr ? display : "";
  setenv("DISPLAY", "", 1);
  SceneView view;
  try {
    renderToPng(view, {64, 64}, fs::temp_directory_path() / "never.png");
    ADD_FAILURE() << "drawn on no display";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("xvfb-run"), std::string::npos);
  }
  if (display != nullptr)
    setenv("DISPLAY", kept.c_str(), 1);
  else
    unsetenv("DISPLAY");
}

TEST(Picture, RefusesInvalidSizes) {
  SceneView view;
  EXPECT_THROW(renderToPng(view, {0, 100}, "x.png"), Error);
  EXPECT_THROW(renderToPng(view, {100, 100000}, "x.png"), Error);
}

TEST_F(ScenePicture, NamesWhatIsInFrontOnARay) {
  drawn("front", {Layer::mesh});
  const Ray down{Vec3(kMajor, 0, 1), -Vec3::UnitZ()};
  const auto front = view_.frontAlong(down);
  ASSERT_TRUE(front);
  EXPECT_EQ(front->layer, Layer::mesh);
  EXPECT_NEAR(front->point.z(), kMinor, 1e-5);
  EXPECT_FALSE(view_.frontAlong({Vec3(0, 0, 1), -Vec3::UnitZ()})) << "through the hole";

  view_.setIso(0.003);
  drawn("front", {Layer::mesh, Layer::iso});
  const auto shell = view_.frontAlong(down);
  ASSERT_TRUE(shell);
  EXPECT_EQ(shell->layer, Layer::iso);
  EXPECT_NEAR(shell->point.z(), kMinor + 0.003, 1e-5);

  view_.setSlices(
      {SlicePosition{Vec3::UnitZ(), 0.0}}); // z = 0, seen from above: the upper half is hidden
  drawn("front", {Layer::mesh, Layer::slice}, ViewPreset::plus_z);
  const double near_surface = kMajor + kMinor - 0.002;
  const auto cut = view_.frontAlong({Vec3(near_surface, 0, 1), -Vec3::UnitZ()});
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->layer, Layer::slice);
  EXPECT_NEAR(cut->point.z(), 0, 1e-9);
  const auto floor = view_.frontAlong(down); // the band does not reach the middle
  ASSERT_TRUE(floor);
  EXPECT_EQ(floor->layer, Layer::mesh);
  EXPECT_NEAR(floor->point.z(), -kMinor, 1e-4) << "the inner side of the lower half";
}

TEST_F(ScenePicture, FindsTheVisibleVertexNearARay) {
  view_.setMesh(std::make_shared<TriangleMesh>(torus(kMajor, kMinor, 16, 8)));
  drawn("vertex", {Layer::mesh});
  const Ray down{Vec3(kMajor + 0.001, 0.0005, 1), -Vec3::UnitZ()};
  const auto vertex = view_.vertexNear(down, {down.origin + Vec3(0.002, 0, 0), down.direction});
  ASSERT_TRUE(vertex);
  EXPECT_LT((*vertex - Vec3(kMajor, 0, kMinor)).norm(), 1e-9) << "not the one below it";
  EXPECT_FALSE(view_.vertexNear(down, {down.origin + Vec3(0.0005, 0, 0), down.direction}));
}

// The field's reach of 8 voxels is near 6.9 mm, of which 2 mm is the round step for four lines.
TEST_F(ScenePicture, SliceHasContourLinesAtRoundDistances) {
  view_.setSlices({SlicePosition{Vec3::UnitZ(), 0.0}});
  setParallel(*view_.renderer().GetActiveCamera(), true);
  const Pixels pixels = drawn("contours", {Layer::slice}, ViewPreset::plus_z, {1600, 1200});
  vtkCamera& camera = *view_.renderer().GetActiveCamera();
  const double per_metre = pixels.height() / 2 / camera.GetParallelScale();
  // Darkest within a pixel, all colours alike.
  const auto brightness = [&](double distance) {
    const double offset = kMajor + kMinor + distance - camera.GetFocalPoint()[0];
    const int x = static_cast<int>(std::lround(pixels.width() / 2 + per_metre * offset));
    double least = 255;
    for (int i = -1; i <= 1; ++i)
      least = std::min(least, pixels.at(x + i, pixels.height() / 2).mean());
    return least;
  };
  const auto dip = [&](double distance) { // against both sides, as colours have a slope
    constexpr double kBeside = 4e-4;
    return 2 * brightness(distance) /
           (brightness(distance - kBeside) + brightness(distance + kBeside));
  };
  constexpr double kStep = 2e-3;
  for (const int line : {-2, -1, 0, 1, 2}) EXPECT_LT(dip(line * kStep), 0.94) << line;
  for (const int line : {-2, -1, 0, 1}) EXPECT_GT(dip((line + 0.5) * kStep), 0.97) << line;
}

// Each pixel has the colour of the plane that its ray crosses first where a distance is shown.
TEST_F(ScenePicture, ThreeSlicesHideOneAnother) {
  const Slices planes = {SlicePosition{Vec3::UnitX(), 0.01}, SlicePosition{Vec3::UnitY(), -0.012},
                         SlicePosition{Vec3(0, 0.6, 0.8), 0.002}};
  std::vector<Pixels> alone;
  for (std::size_t i = 0; i < kMaxSlices; ++i) {
    view_.setSlices({planes[i]});
    alone.push_back(drawn("slice" + std::to_string(i), {Layer::slice}));
  }
  view_.setSlices(planes);
  const Pixels together = drawn("slices", {Layer::slice});
  vtkCamera& camera = *view_.renderer().GetActiveCamera();
  const double voxel = torusField()->grid.voxel;
  std::array<int, kMaxSlices> seen{};
  int differ = 0;
  for (int y = 5; y < together.height(); y += 11)
    for (int x = 5; x < together.width() * 8 / 10; x += 11) {
      const double high = together.height();
      const Ray ray = rayThrough(camera, (x + 0.5 - together.width() / 2.0) / high,
                                 (y + 0.5 - together.height() / 2.0) / high);
      std::optional<std::size_t> first;
      double depth = 1e9;
      bool unsure = false; // at an edge of what is shown
      for (std::size_t i = 0; i < kMaxSlices; ++i) {
        const double slant = ray.direction.dot(planes[i]->normal);
        const double t = (*planes[i]->position - ray.origin.dot(planes[i]->normal)) / slant;
        const double voxels = std::abs(torusDistance(ray.origin + t * ray.direction)) / voxel;
        unsure = unsure || std::abs(voxels - (i < 2 ? 6.25 : 4.8)) < 0.8;
        if (voxels > (i < 2 ? 6.25 : 4.8) || t > depth) continue;
        depth = t;
        first = i;
      }
      if (unsure) continue;
      const auto front = view_.frontAlong(ray);
      ASSERT_EQ(front && front->layer == Layer::slice, first.has_value()) << x << ", " << y;
      if (!first) continue;
      ASSERT_EQ(front->slice, *first) << x << ", " << y;
      EXPECT_NEAR((front->point - ray.origin).norm(), depth, 1e-9);
      ++seen[*first];
      differ += (together.at(x, y) - alone[*first].at(x, y)).cwiseAbs().maxCoeff() > 12;
    }
  for (const int count : seen) EXPECT_GT(count, 30);
  EXPECT_LT(differ, (seen[0] + seen[1] + seen[2]) / 50);
}

TEST_F(ScenePicture, ColoursTheSliceByItsScale) {
  const auto yellow = [](const Vec3& c) { return c[0] > 200 && c[1] > 190 && c[2] < 90; };
  EXPECT_EQ(drawn("scale_standard", {Layer::slice}).share(yellow), 0);
  view_.setColors({{"slice", parseColorScale("viridis,range=-1:1mm")}});
  EXPECT_GT(drawn("scale_viridis", {Layer::slice}).share(yellow), 0.02) << "beyond 1 mm outside";
  const auto range = view_.shownRange("slice");
  ASSERT_TRUE(range);
  EXPECT_NEAR(range->high, 1e-3, 1e-12);
}

} // namespace
} // namespace patina
