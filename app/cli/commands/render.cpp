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
#include "session/open/session.h"
#include "visualization/export/export_files.h"
#include "visualization/layers/stability_layer.h"
#include "visualization/plots/video.h"
#include "visualization/view/display.h"
#include "visualization/view/figure_file.h"

namespace patina::cli {

namespace {

struct RenderOptions {
  std::filesystem::path input, output, replay;
  std::set<Layer> layers = {Layer::mesh, Layer::color};
  ViewPreset view = ViewPreset::iso;
  Figure figure;
  FigureWidth width;
  bool sized = false; // --width was given
  std::vector<SlicePosition> slices;
  std::optional<Vec3> tip;
  std::optional<ValueRange> range;
  ColorScales colors;
  SceneOptions scene;
};

const Keys kRenderKeys = {
    {"picture", "", "picture"},
    {"layers", "", "layers"},
    {"width", "", "width", "", Shown::never},
    {"height", "", "height", "", Shown::never},
    {"dpi", "1/inch", "resolution", "pixels per inch, with --width or --dpi", Shown::if_any},
    {"background", "", "background", "", Shown::never},
    {"frames", "", "frames", "of a video", Shown::if_any},
    {"view", "", "view", "", Shown::never},
    {"stability", "", "K*/K where it is shown", "", Shown::always, stabilityKeys()},
    {"slice_range", "m", "slice", "ends of the scale of the slice's distances"},
    {"range", "", "range", "ends of the scale of what was painted"}};

void parseSize(const std::string& text, Figure& figure) {
  char rest = 0;
  int &wide = figure.width, &high = figure.height;
  if (std::sscanf(text.c_str(), "%6dx%6d%c", &wide, &high, &rest) != 2 || wide < 16 || high < 16 ||
      wide > 16384 || high > 16384)
    throw Error("'" + text + "' is not WIDTHxHEIGHT with sides of 16 to 16384 pixels");
}

// The ratio of width to height is that of --size.
Figure figureOf(const RenderOptions& options) {
  Figure figure = options.figure;
  FigureWidth width = options.width;
  if (!options.sized) width.pixels = figure.width;
  setSize(figure, width, static_cast<double>(figure.width) / figure.height, width.pixels);
  return figure;
}

template <typename Values> std::vector<std::string> wordsFor(const Values& values) {
  return namesIn(values, [](const auto& value) { return std::string(name(value)); });
}

// Parses LOW,HIGH in SI, or with a unit for lengths.
ValueRange parseRange(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) throw Error("'" + text + "' is not LOW,HIGH");
  const ValueRange range{parseLength(text.substr(0, comma)), parseLength(text.substr(comma + 1))};
  if (!(range.low < range.high)) throw Error("'" + text + "': LOW must be less than HIGH");
  return range;
}

// Returns the layer's paint that has a colour scale, at most one; throws Error if it is not there.
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

// Returns the tool after the servo moved it to `tip` from outside.
ToolSample toolAt(const CompiledScene& compiled, const Vec3& tip, Progress& progress) {
  const TriangleMesh felt = hapticTriangles(compiled, progress).mesh;
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
  const bool is_video = !options.replay.empty();
  if (!is_video && !canSaveFigure(options.output))
    throw Error("--output: a picture is a .png, .tif, .svg or .pdf file, not '" +
                options.output.string() + "'");
  if (is_video && options.output.extension() != ".ogv")
    throw Error("--output: a video is an .ogv file, not '" + options.output.string() + "'");
  requireWritable(options.output, {options.input, options.replay}, kindOfName(options.output));
  const Figure figure = is_video ? withEvenSides(figureOf(options)) : figureOf(options);
  if (is_video && figure.background == FigureBackground::transparent)
    throw Error("--background: a video is not transparent");
  if (is_video && !options.layers.contains(Layer::tip))
    throw Error("--replay: the tool is not shown: add the layer tip to --show");
  std::vector<ToolSample> samples;
  if (is_video) samples = readToolSamplesCsv(options.replay);
  if (is_video && samples.empty())
    throw FileError(options.replay.string(), 0, "the recording has no row: nothing to replay");
  if (!options.tip && !is_video &&
      (options.layers.contains(Layer::tip) || options.layers.contains(Layer::nodes)))
    throw Error("--show: the layers tip and nodes need --tip X,Y,Z");
  if (!options.slices.empty() && !options.layers.contains(Layer::slice))
    throw Error("--slice: the layer slice is not shown: add it to --show");
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
  Slices slices = options.slices.empty() ? scene.slices : Slices();
  std::copy(options.slices.begin(), options.slices.end(), slices.begin());
  ColorScales colors = scene.colors;
  for (const auto& [thing, scale] : options.colors) colors[thing] = scale;
  if (options.range) { // takes the place of the workspace's rule
    ColorScale& scale = colors[std::string(name(layerOf(*quantity)))];
    scale.range = options.range;
    scale.percentile.reset();
    scale.symmetric = false;
  }
  view.setColors(colors);
  const std::vector<std::string> layers = wordsFor(options.layers);
  Report report(kRenderKeys);
  report.set("picture", options.output.string());
  report.set("layers", jsonOf(layers), joined(layers, " "));
  if (only_mesh) {
    view.setMesh(std::make_shared<const TriangleMesh>(worldMesh(scene)));
    view.setPaint(scene);
    view.setAnnotations(pinAnnotations(scene.pins));
  } else {
    const auto compiled = compileFor(std::move(scene), console);
    view.setAnnotations(pinAnnotations(compiled->scene.pins));
    view.setBand(band);
    view.setMesh(compiled->mesh);
    view.setPaint(compiled->scene);
    view.setField(compiled->paint.field); // with baked relief
    if (const auto radius = compiled->scene.haptics.tip_radius) {
      view.setTipRadius(*radius);
      view.setIso(*radius);
    }
    if (options.layers.contains(Layer::stability)) {
      const SurfaceStability stability = requiredStability(*compiled, console.progress());
      view.setStability(stability.surface.get(), displayRatios(stability.map));
      report.set("stability", stabilityReport(stability, compiled->scene));
      report.tell("colours", "K*/K from " + rounded(kMinRatioShown) + " to " +
                                 rounded(kMaxRatioShown) + ", clipped beyond");
    }
    if (options.tip) view.setTool(toolAt(*compiled, *options.tip, console.progress()));
  }
  console.progress().throwIfCancelled();
  view.setSlices(slices);
  view.showOnly(options.layers);
  view.setView(options.view);
  if (is_video) {
    view.setTool(samples.front());
    VideoWriter video(view, std::move(samples), figure, options.output);
    while (video.writeNext()) {
      console.progress().report(static_cast<double>(video.written()) / video.frames(), "frames");
      console.progress().throwIfCancelled();
    }
    report.set("frames", video.frames());
  } else {
    saveFigure(view, figure, options.output);
  }

  report.set("width", figure.width).set("height", figure.height);
  if (figure.dpi) report.set("dpi", *figure.dpi);
  report.set("background", std::string(name(figure.background)));
  report.set("view", std::string(name(options.view)));
  if (const auto range = view.shownRange("slice"))
    report.set("slice_range", Json(Json::Array{range->low, range->high}),
               formatLength(range->low) + " to " + formatLength(range->high));
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
  const Figure& figure = options->figure;
  Command command{
      .name = "render",
      .summary = "a picture of a mesh or workspace and its field",
      .description =
          "Layers: " + joined(wordsFor(allLayers()), " ") +
          ". Views: " + joined(wordsFor(allViews()), " ") +
          "; +x is seen from the +x side. The layers tip and nodes show the contact of the tool at "
          "--tip, approached from outside; the layer band is where an offset or a magnet acts; the "
          "layer stability colours the surface by K*(x)/K for the scene's device (device.* values; "
          "without, a device of 0.1 kg and 0.5 N s/m at 1 kHz is assumed): below 1 the loop is "
          "unstable when pressed with 1 N, violet where the tip slips off, dark where the force "
          "jumps, grey where nothing can be touched; colours end at 0.25 and 4. The layer scale is "
          "a bar of a round length, valid at the distance of the picture's centre. The layers from "
          "color on show the paint of a workspace: color with relief shaded as relief, the others "
          "against a scale, one at a time, material also on the slice; objects without it stay as "
          "they are.\n"
          "A figure for a paper: --width 85mm --dpi 300 --background transparent makes 1004 "
          "pixels, "
          "writes the resolution into the file and gives texts about 6 pt; --scale 2 doubles "
          "pixels "
          "and resolution, and leaves the looks. In .svg and .pdf, texts and the scale bar are "
          "vectors over a picture of the rest. Parts of --without: " +
          joined(wordsFor(allFigureParts()), " ") +
          ".\n"
          "A scale of --colors is a map (standard, viridis, cividis, magma, turbo, "
          "cool-warm, greys) and any of reversed, log, symmetric, bands=N, range=LOW:HIGH, "
          "percentile=P, opacity=O and digits=N, with commas between; iso and mesh have only an "
          "opacity.\n"
          "Needs a display; on a machine without one: xvfb-run -a patina render ...",
      .examples = {"patina render bunny.ply -o bunny.png --show mesh,slice --view +y",
                   "patina render bunny.ply -o cut.png --show slice --slice x --slice 0,1,1:9mm",
                   "patina render bunny.ply -o touch.png --show mesh,tip --tip 0,0,49mm",
                   "patina render bunny.ply -o fig.tif --width 85mm --background transparent",
                   "patina render bunny.ply -o cut.png --show slice --colors slice=viridis,bands=8",
                   "patina render workspace -o stiffness.png --show stiffness --range 0,2000"},
      .keys = kRenderKeys,
      .arguments = {sceneInput(options->input),
                    outputTo(options->output, "PICTURE.png", "The picture; .tif .svg .pdf too."),
                    {"--show", "LAYERS", "", "mesh,color", "Layers, with commas between.",
                     parsedInto(options->layers, parseLayers)},
                    {"--view", "NAME", "", "iso", "Where the camera stands.",
                     parsedInto(options->view, parseView)},
                    {"--size", "WxH", "",
                     std::to_string(figure.width) + "x" + std::to_string(figure.height), "Pixels.",
                     [options](const std::string& text) { parseSize(text, options->figure); }},
                    {"--width", "WIDTH", "", "that of --size",
                     "Width in pixels or as 85mm; the height is in proportion to --size.",
                     [options](const std::string& text) {
                       const FigureWidth width = parseFigureWidth(text);
                       options->width.pixels = width.pixels;
                       options->width.length = width.length;
                       options->sized = true;
                     }},
                    {"--dpi", "N", "1/inch", "300", "Resolution of a width on paper.",
                     numberInto(10, 4800, options->width.dpi)},
                    {"--scale", "N", "", "1", "Pixels per pixel of that size, 1 to 4.",
                     numberInto(1, 4, options->width.scale)},
                    {"--background", "NAME", "", "as-seen",
                     "Behind everything: " + joined(wordsFor(allFigureBackgrounds()), " ") + ".",
                     parsedInto(options->figure.background, parseFigureBackground)},
                    {"--without", "PARTS", "", "", "Parts to leave out, with commas between.",
                     parsedInto(options->figure.without, parseFigureParts)},
                    {"--slice", "DIRECTION:POSITION", "", "as in the workspace, or y",
                     "Where the layer slice is: as x:12.5mm, or at an angle as 0,1,1:12.5mm; the "
                     "position is along the direction, from the origin; without, the middle. Up to "
                     "three slices.",
                     [options](const std::string& text) {
                       if (options->slices.size() == kMaxSlices)
                         throw Error("at most three slices are drawn at once");
                       options->slices.push_back(parseSlice(text));
                     },
                     Times::any},
                    {"--tip", "X,Y,Z", "m", "", "Place of the tip; units as 1mm,0,2mm.",
                     parsedInto(options->tip, parsePoint)},
                    {"--replay", "RECORDING.csv", "", "",
                     "Makes a video of 25 frames a second of a recording of the window or a table "
                     "of patina feel, the force over time beside it, with --show mesh,tip and -o "
                     "VIDEO.ogv.",
                     into(options->replay)},
                    {"--range", "LOW,HIGH", "", "what is there",
                     "Ends of the scale of what was painted, SI or as 0,0.5mm.",
                     parsedInto(options->range, parseRange)},
                    {"--colors", "THING=SCALE", "", "as in the workspace",
                     "Colours of a thing (" + joined(coloredThings(), " ") +
                         "), as in slice=viridis,range=-2:2mm.",
                     [options](const std::string& text) {
                       parseColorScaleOf(text, options->colors);
                     },
                     Times::any}},
      .run = [options](Console& console) { return runRender(*options, console); }};
  addHapticOptions(command, options->scene);
  addSampledFieldOptions(command, options->scene);
  return command;
}

} // namespace patina::cli
