#include <algorithm>
#include <cstdio>

#include "app/cli/commands/commands.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/output/reports.h"
#include "app/cli/output/stability_report.h"
#include "core/error.h"
#include "core/numbers.h"
#include "geometry/tree/triangle_tree.h"
#include "haptics/servo/feel.h"
#include "session/build/session.h"
#include "visualization/layers/stability_layer.h"
#include "visualization/view/display.h"
#include "visualization/view/picture.h"

namespace patina::cli {

namespace {

struct RenderOptions {
  std::filesystem::path input, output;
  std::set<Layer> layers = {Layer::mesh, Layer::color};
  ViewPreset view = ViewPreset::iso;
  PictureSize size;
  std::optional<Vec3> tip;
  std::optional<ValueRange> range;
  SceneOptions scene;
};

const Keys kRenderKeys = {
    {"picture", "", "picture"},
    {"layers", "", "layers"},
    {"width", "", "width", "", Shown::never},
    {"height", "", "height", "", Shown::never},
    {"view", "", "view", "", Shown::never},
    {"stability", "", "K*/K where it is shown", "", Shown::always, stabilityKeys()},
    {"range", "", "range", "ends of the scale of what was painted"}};

PictureSize parseSize(const std::string& text) {
  PictureSize size;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%6dx%6d%c", &size.width, &size.height, &rest) != 2 ||
      size.width < 16 || size.height < 16 || size.width > 16384 || size.height > 16384)
    throw Error("'" + text + "' is not WIDTHxHEIGHT with sides of 16 to 16384 pixels");
  return size;
}

template <typename Values> std::vector<std::string> wordsFor(const Values& values) {
  return namesIn(values, [](const auto& value) { return std::string(name(value)); });
}

// LOW,HIGH in SI, or with a unit where they are lengths.
ValueRange parseRange(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) throw Error("'" + text + "' is not LOW,HIGH");
  const ValueRange range{parseLength(text.substr(0, comma)), parseLength(text.substr(comma + 1))};
  if (!(range.low < range.high)) throw Error("'" + text + "': LOW must be less than HIGH");
  return range;
}

// The paint that is read against a scale, at most one; it must be there.
std::optional<PaintQuantity> readPaint(const std::set<Layer>& layers, const Scene& scene) {
  std::optional<PaintQuantity> found;
  bool colored = false;
  for (const Layer layer : layers) {
    const auto quantity = paintOf(layer);
    if (!quantity) continue;
    if (quantity == PaintQuantity::color) {
      colored = true;
      continue;
    }
    if (found)
      throw Error("--show: of the layers " + std::string(name(layerOf(*found))) + " and " +
                  std::string(name(layer)) + " the surface can have the colours of one");
    found = quantity;
  }
  if (found && colored)
    throw Error("--show: of the layers color and " + std::string(name(layerOf(*found))) +
                " the surface can have the colours of one");
  if (found && !hasPaint(scene, *found))
    throw Error("--show: the layer " + std::string(name(layerOf(*found))) +
                " needs a workspace where it was painted");
  return found;
}

// The tool as the servo leaves it when it comes to `tip` from outside.
ToolSample toolAt(const CompiledScene& compiled, const Vec3& tip, Progress& progress) {
  const TriangleMesh felt = feltTriangles(compiled, progress).mesh;
  const ClosestPoint nearest = TriangleTree(felt).closestPoint(tip);
  const Box3 box = bounds(felt);
  const bool inside = FieldSampler(*compiled.built.field, compiled.scene.sampler).at(tip).phi < 0;
  Vec3 outward = inside ? Vec3(nearest.point - tip) : Vec3(tip - nearest.point);
  if (outward.norm() > 0)
    outward.normalize();
  else
    outward = faceNormal(felt, static_cast<std::size_t>(nearest.surface.face));
  const Vec3 start = nearest.point + 0.02 * box.sizes().maxCoeff() * outward;
  constexpr int kTicks = 200;
  std::vector<TimedTip> path;
  for (int i = 0; i <= kTicks; ++i)
    path.push_back({0.001 * i, start + (tip - start) * (static_cast<double>(i) / kTicks)});
  return feel(*compiled.snapshot, path, progress).back();
}

int runRender(const RenderOptions& options, Console& console) {
  if (options.output.extension() != ".png")
    throw Error("--output: a picture is a .png file, not '" + options.output.string() + "'");
  requireWritable(options.output, {options.input}, FileKind::png);
  if (!options.tip &&
      (options.layers.contains(Layer::tip) || options.layers.contains(Layer::nodes)))
    throw Error("--show: the layers tip and nodes need --tip X,Y,Z");
  Scene scene = openWith(options.input, options.scene, console);
  if (scene.objects.empty())
    throw FileError(options.input.string(), 0, "the scene has no object: nothing to draw");
  const auto band = touchBand(scene.haptics);
  if (options.layers.contains(Layer::band) && !band)
    throw Error("--show: the layer band needs a scene with an offset or a magnet");
  const auto quantity = readPaint(options.layers, scene);
  if (options.range && !quantity)
    throw Error("--range: no layer of those shown has a range: show relief, stiffness ...");
  requireDisplay();
  const bool only_mesh = std::all_of(options.layers.begin(), options.layers.end(), [](Layer layer) {
    return layer == Layer::mesh || layer == Layer::wireframe || layer == Layer::scale ||
           paintOf(layer);
  });
  SceneView view;
  if (quantity) view.lockPaintRange(*quantity, options.range);
  const std::vector<std::string> layers = wordsFor(options.layers);
  Report report(kRenderKeys);
  report.set("picture", options.output.string());
  report.set("layers", jsonOf(layers), joined(layers, " "));
  if (only_mesh) {
    view.setMesh(std::make_shared<const TriangleMesh>(worldMesh(scene)));
    view.setPaint(scene);
  } else {
    const auto compiled = compileFor(std::move(scene), console);
    view.setBand(band);
    view.setMesh(compiled->mesh);
    view.setPaint(compiled->scene);
    view.setField(compiled->built.field);
    if (const auto radius = compiled->scene.haptics.tip_radius) {
      view.setTipRadius(*radius);
      view.setIso(*radius);
    }
    if (options.layers.contains(Layer::stability)) {
      const SurfaceStability stability = requiredStability(*compiled, console.progress());
      view.setStability(stability.surface.get(), shownRatios(stability.map));
      report.set("stability", stabilityReport(stability, compiled->scene));
      report.tell("colours", "K*/K from " + rounded(kLeastRatioShown) + " to " +
                                 rounded(kMostRatioShown) + ", clipped beyond");
    }
    if (options.tip) view.setTool(toolAt(*compiled, *options.tip, console.progress()));
  }
  console.progress().throwIfCancelled();
  view.showOnly(options.layers);
  view.setView(options.view);
  renderToPng(view, options.size, options.output);

  report.set("width", options.size.width).set("height", options.size.height);
  report.set("view", std::string(name(options.view)));
  if (quantity) {
    const ValueRange range = view.paintRange(*quantity);
    report.set("range", Json(Json::Array{range.low, range.high}),
               arrayName(*quantity) + " from " + formatNumber(range.low) + " to " +
                   formatNumber(range.high));
  }
  return console.report(report);
}

} // namespace

Command renderCommand() {
  auto options = std::make_shared<RenderOptions>();
  const PictureSize& size = options->size;
  Command command{
      .name = "render",
      .summary = "a picture of a mesh or workspace and its field",
      .description =
          "Layers: " + joined(wordsFor(allLayers()), " ") +
          ". Views: " + joined(wordsFor(allViews()), " ") +
          "; +x is seen from the +x side. The layers tip and nodes show what the servo makes of "
          "the tool at --tip, come to from outside; the layer band is where an offset or a magnet "
          "acts; the layer stability colours the surface by K*(x)/K for the scene's device "
          "(device.* values; without, a device of 0.1 kg and 0.5 N s/m at 1 kHz is assumed): below "
          "1 the loop would buzz when pressed with 1 N, violet where the tip slips off, dark where "
          "the force jumps, grey where nothing is touched; colours end at 0.25 and 4. The layer "
          "scale is a bar of a round length, of what is as far away as the middle. The layers "
          "from color on show what was painted in a workspace: color with "
          "relief shaded as relief, the others against a scale, one at a time, material also on "
          "the slice; objects without it stay as they are.\n"
          "Needs a display; on a machine without one: xvfb-run -a patina render ...",
      .examples = {"patina render bunny.ply -o bunny.png --show mesh,slice --view +y",
                   "patina render bunny.ply -o touch.png --show mesh,tip --tip 0,0,49mm",
                   "patina render workspace -o stiffness.png --show stiffness --range 0,2000"},
      .keys = kRenderKeys,
      .arguments = {sceneInput(options->input),
                    outputTo(options->output, "PICTURE.png", "The picture."),
                    {"--show", "LAYERS", "", "mesh,color", "Layers, with commas between.",
                     parsedInto(options->layers, parseLayers)},
                    {"--view", "NAME", "", "iso", "Where the camera stands.",
                     parsedInto(options->view, parseView)},
                    {"--size", "WxH", "",
                     std::to_string(size.width) + "x" + std::to_string(size.height), "Pixels.",
                     parsedInto(options->size, parseSize)},
                    {"--tip", "X,Y,Z", "m", "", "Place of the tip; units as 1mm,0,2mm.",
                     parsedInto(options->tip, parsePoint)},
                    {"--range", "LOW,HIGH", "", "what is there",
                     "Ends of the scale of what was painted, SI or as 0,0.5mm.",
                     parsedInto(options->range, parseRange)}},
      .run = [options](Console& console) { return runRender(*options, console); }};
  addHapticOptions(command, options->scene);
  addSampledFieldOptions(command, options->scene);
  return command;
}

} // namespace patina::cli
