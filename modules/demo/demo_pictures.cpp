#include "demo/demo_pictures.h"

#include <cmath>

#include "acquisition/files/frame_files.h"
#include "visualization/plots/plot.h"
#include "visualization/view/picture.h"

namespace patina {
namespace {

constexpr double kMilli = 1e3, kMicro = 1e6;

PlotSeries lineOf(const std::string& name) {
  PlotSeries series;
  series.name = name;
  series.points = false;
  return series;
}

void drawPaths(const Demo& demo, const std::filesystem::path& file) {
  ScanPicture picture;
  picture.setMesh(std::make_shared<const TriangleMesh>(demo.object.mesh));
  picture.setPath(demoPaths(demo));
  picture.setView(ViewPreset::minus_y);
  renderToPng(picture, {1280, 860}, file);
}

void drawHeights(const DemoTexture& texture, const std::string& name,
                 const std::filesystem::path& file) {
  Plot plot{name + ": heights over the mesh", "way [mm]", "height [um]", false, false, {}};
  PlotSeries measured = lineOf("measured"), kept = lineOf("harmonics");
  const FittedTexture& fitted = texture.scanned.fitted;
  double last = -1;
  for (const ScanHeight& height : texture.scanned.heights) {
    if (height.point.arc_length < last + 0.1e-3) continue;
    last = height.point.arc_length;
    measured.x.push_back(kMilli * last);
    measured.y.push_back(kMicro * height.point.height);
    kept.x.push_back(kMilli * last);
    kept.y.push_back(kMicro * patina::height(fitted.texture, last));
  }
  plot.series = {measured, kept};
  writePlot(plot, file);
}

void drawSpectra(const Demo& demo, const std::filesystem::path& file) {
  Plot plot{"Harmonics", "wavelength [mm]", "amplitude [um]", true, true, {}};
  for (const DemoTexture& texture : demo.textures) {
    const FourierTexture& fitted = texture.scanned.fitted.texture;
    PlotSeries series;
    series.name = fitted.name;
    for (std::size_t j = 0; j < fitted.series.a.size(); ++j) {
      const double amplitude = std::hypot(fitted.series.a[j], fitted.series.b[j]);
      if (!(amplitude > 0)) continue;
      series.x.push_back(kMilli * period(fitted) / static_cast<double>(j + 1));
      series.y.push_back(kMicro * amplitude);
    }
    plot.series.push_back(series);
  }
  writePlot(plot, file);
}

void drawFelt(const DemoTexture& texture, const std::string& name,
              const std::filesystem::path& file) {
  Plot plot{name + ": force outwards", "way [mm]", "force [N]", false, false, {}};
  PlotSeries felt = lineOf("felt"), truth = lineOf("true surface");
  for (const ForcePoint& point : texture.felt) {
    felt.x.push_back(kMilli * point.along);
    felt.y.push_back(point.felt.dot(point.outward));
    truth.x.push_back(kMilli * point.along);
    truth.y.push_back(point.truth.dot(point.outward));
  }
  plot.series = {truth, felt};
  writePlot(plot, file);
}

} // namespace

DrawnPath demoPaths(const Demo& demo) {
  DrawnPath path;
  const bool registered = !demo.registered.registration.residuals.empty();
  path.title = registered ? "distance [mm]" : "force [N]";
  const Pose object_from_camera =
      registered ? demo.registered.registration.mesh_from_path : demo.camera_from_object.inverse();
  std::size_t i = 0;
  for (std::size_t s = 0; s < demo.scans.size(); ++s) {
    bool begins = true;
    for (const PathSample& sample : demo.scans[s].filtered.path) {
      const double value =
          registered ? 1e3 * demo.registered.registration.residuals[i].distance : sample.force;
      path.samples.push_back({sample.t + 1e3 * static_cast<double>(s),
                              object_from_camera * sample.position, value, false, begins});
      begins = false;
      ++i;
    }
  }
  return path;
}

std::vector<std::string> drawDemo(const Demo& demo) {
  std::vector<std::string> names;
  const auto file = [&](const std::string& name) {
    names.push_back(name);
    return demo.folder / name;
  };
  char frame[40];
  std::snprintf(frame, sizeof frame, "frames/%06zu.png", 3 * demo.scans[0].frames / 4);
  const std::filesystem::path seen = demo.folder / ("scan-" + demo.scans[0].name) / frame;
  std::filesystem::copy_file(seen, file("frame.png"),
                             std::filesystem::copy_options::overwrite_existing);
  drawPaths(demo, file("paths.png"));
  for (std::size_t i = 0; i < demo.textures.size(); ++i)
    drawHeights(demo.textures[i], demo.object.materials[i].name,
                file("heights-" + demo.object.materials[i].name + ".png"));
  drawSpectra(demo, file("spectra.png"));
  SceneView view;
  view.setMesh(demo.compiled->mesh);
  view.setPaint(demo.compiled->scene);
  view.showOnly({Layer::mesh, Layer::color});
  view.setView(ViewPreset::minus_y);
  renderToPng(view, {1280, 860}, file("painted.png"));
  for (std::size_t i = 0; i < demo.textures.size(); ++i)
    drawFelt(demo.textures[i], demo.object.materials[i].name,
             file("felt-" + demo.object.materials[i].name + ".png"));
  return names;
}

} // namespace patina
