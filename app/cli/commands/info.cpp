#include <algorithm>
#include <optional>
#include <set>

#include "app/cli/commands/commands.h"
#include "app/cli/framework/report.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/output/reports.h"
#include "app/cli/output/stability_report.h"
#include "authoring/relief/relief_limits.h"
#include "core/error.h"
#include "core/numbers.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/sides/open_parts.h"
#include "session/compile/compile_scene.h"
#include "session/compile/compile_warnings.h"
#include "session/open/stage_cost.h"
#include "session/store/attach_scan.h"
#include "visualization/files/field_io.h"

namespace patina::cli {
namespace {

// Paint part of `patina info`; empty without paint.

void add(std::vector<LayerBytes>& layers, const std::string& name, std::size_t bytes) {
  if (bytes == 0) return;
  const auto same = std::find_if(layers.begin(), layers.end(),
                                 [&](const LayerBytes& layer) { return layer.name == name; });
  if (same == layers.end())
    layers.push_back({name, bytes});
  else
    same->bytes += bytes;
}

void addPainted(std::vector<LayerBytes>& layers, const ObjectPaint& paint) {
  if (paint.color) add(layers, "color", paint.color->bytes());
  if (paint.relief) add(layers, "relief", paint.relief->bytes());
  if (paint.layout.uvs && paint.layout.generated)
    add(layers, "chart atlas", paint.layout.uvs->size() * sizeof((*paint.layout.uvs)[0]));
  if (!paint.material) return;
  for (const MaterialChannel channel : kAllMaterialChannels) {
    std::size_t blocks = 0;
    for (const auto& [index, block] : paint.material->blocks())
      blocks += block.layer[static_cast<std::size_t>(channel)] != nullptr;
    add(layers, std::string(name(channel)), blocks * sizeof(MaterialLayer));
  }
}

// Worst object: the one that exceeds its limit most, otherwise the highest.
struct Worst {
  ReliefLimit limit;
  std::string object;
};

double excess(const ReliefLimit& limit) {
  return limit.admissible ? limit.highest / *limit.admissible : 0;
}

std::optional<Worst> worstRelief(const CompiledScene& compiled) {
  std::optional<Worst> worst;
  for (std::size_t i = 0; i < compiled.paint.relief.size(); ++i) {
    if (!compiled.paint.relief[i].felt) continue;
    const SceneObject& object = compiled.scene.objects[i];
    const ReliefLimit limit =
        reliefLimit(*compiled.objects[i]->mesh, object.paint->layout,
                    *compiled.paint.relief[i].felt, compiled.scene.relief.height,
                    compiled.scene.device_model, compiled.scene.haptics.force_limit);
    const bool worse = !worst || std::pair(excess(limit), limit.highest) >
                                     std::pair(excess(worst->limit), worst->limit.highest);
    if (limit.highest > 0 && worse) worst = Worst{limit, object.name};
  }
  return worst;
}

// Bytes of each kind of paint and of its haptic data.
std::vector<LayerBytes> paintLayers(const CompiledScene& compiled) {
  std::vector<LayerBytes> layers;
  for (const SceneObject& object : compiled.scene.objects)
    if (object.paint) addPainted(layers, *object.paint);
  const HapticPaint& felt = compiled.paint;
  for (const HapticObject& object : felt.objects) {
    if (object.material) add(layers, "felt material", object.material->bytes());
    if (object.relief) add(layers, "felt relief", bytes(*object.relief->faces));
  }
  for (const HapticRelief& relief : felt.relief) {
    if (relief.grey.grey) add(layers, "grey of colour", relief.grey.grey->bytes());
    if (relief.felt != relief.source) add(layers, "smoothed relief", relief.felt->bytes());
    if (relief.smoother) add(layers, "relief smoothing", relief.smoother->bytes());
    if (relief.curvature_map) add(layers, "relief curvature", relief.curvature_map->bytes());
  }
  if (felt.bake) {
    add(layers, "relief bake", felt.bake->bytes());
    const auto own = [](const SurfaceField& field) { return field.bytes(); };
    if (felt.field != compiled.built.field) add(layers, "baked field", own(*felt.field));
  }
  return layers;
}

// Height of the relief and its limit on the scene's device (F7); nullopt without relief.
const Keys& reliefKeys() {
  static const Keys keys = {{"object", "", "object", "", Shown::never},
                            {"highest", "m", "relief", "at most"},
                            {"wavelength", "m", "wavelength", "", Shown::never},
                            {"admissible", "m", "admissible", "with a device", Shown::never},
                            {"exceeded", "", "exceeded", "", Shown::never}};
  return keys;
}

std::optional<Report> reliefReport(const CompiledScene& compiled) {
  const std::optional<Worst> worst = worstRelief(compiled);
  if (!worst) return std::nullopt;
  const ReliefLimit& limit = worst->limit;
  const bool exceeded = excess(limit) > 1;
  std::string text = formatLength(limit.highest) + " at most, as curved as a wave of " +
                     formatLength(limit.wavelength);
  if (limit.admissible)
    text += "; at " + formatNumber(compiled.scene.haptics.force_limit) +
            " N, the force limit, the device bears " + formatLength(*limit.admissible) +
            (exceeded ? ": it will buzz, smooth it" : "");
  Report report(reliefKeys());
  report.set("object", worst->object).set("highest", limit.highest, text);
  report.set("wavelength", limit.wavelength);
  if (limit.admissible) report.set("admissible", *limit.admissible).set("exceeded", exceeded);
  return report;
}

struct InfoOptions {
  std::filesystem::path input;
  bool no_field = false;
  SceneOptions scene;
};

const Keys kDefectKeys = {{"non_finite", "", "non-finite triangles"},
                          {"degenerate", "", "triangles without area"},
                          {"duplicate", "", "duplicate triangles"},
                          {"boundary_edges", "", "boundary edges"},
                          {"non_manifold_edges", "", "non-manifold edges"},
                          {"misoriented_edges", "", "misoriented edges"}};
const Keys kSideKeys = {{"sides", "", "", "closed, one-sided or two-sided"}, {"triangles", "", ""}};
const Keys kPartKeys = {{"triangles", "", ""},
                        {"boundary_edges", "", ""},
                        {"sides", "", "", "closed, one-sided or two-sided"},
                        {"by", "", "", "program, or user where surface.sides was set"}};
const Keys kHoleKeys = {{"area", "m^2", "", "of a surface that spans it"},
                        {"centre", "m", "", "of that surface"},
                        {"edges", "", ""}};
const Keys kObjectKeys = {{"name", "", ""}, {"triangles", "", ""}};
const Keys kLayerKeys = {{"name", "", ""},
                         {"why", "", "", "of the one that keeps several objects apart"},
                         {"bytes", "B", ""}};
const Keys kStageKeys = {{"name", "", ""}, {"why", "", ""}, {"bytes", "B", ""}, {"ns", "ns", ""}};
const Keys kHistoryKeys = {{"undo", "", ""}, {"redo", "", ""}};
const Keys kInfoKeys = {
    {"file", "", "file"},
    {"kind", "", "kind", "workspace, field or mesh"},
    {"scans", "", "the scans of a workspace", "", Shown::never, scanKeys()},
    {"values", "", "the values of a workspace", "by their keys", Shown::never},
    {"history", "", "history", "edits of a workspace", Shown::always, kHistoryKeys},
    {"objects", "", "objects", "", Shown::never, kObjectKeys},
    {"triangles", "", "triangles"},
    {"vertices", "", "vertices"},
    {"bounds", "m", "size", "lowest and highest corner"},
    {"watertight", "", "watertight"},
    {"components", "", "components"},
    {"defects", "", "defects", "", Shown::always, kDefectKeys},
    {"widest_crack", "m", "widest crack", "between corners and edges that count as joined",
     Shown::if_any},
    {"components_sides", "", "sides", "", Shown::if_any, kSideKeys},
    {"parts", "", "decided", "of a mesh with a rim, its parts, the largest first", Shown::always,
     kPartKeys},
    {"holes", "", "holes", "that are closed over, the largest first", Shown::if_any, kHoleKeys},
    {"inner_triangles", "", "left out", "triangles that are there twice inside a body",
     Shown::if_any},
    {"field", "", "as patina field"},
    {"layers", "", "layer", "", Shown::always, kLayerKeys},
    {"bytes", "B", "in all", "of the layers together: what is held of the scene", Shown::if_any},
    {"stages", "", "stage", "", Shown::always, kStageKeys},
    {"relief", "", "of a scene with relief", "", Shown::always, reliefKeys()},
    {"stability", "", "as patina render", "only with a device"}};

void describeDefects(const MeshReport& mesh, Report& report) {
  const std::pair<const char*, std::size_t> counts[] = {
      {"non_finite", mesh.non_finite},
      {"degenerate", mesh.degenerate},
      {"duplicate", mesh.duplicate},
      {"boundary_edges", mesh.boundary_edges},
      {"non_manifold_edges", mesh.non_manifold_edges},
      {"misoriented_edges", mesh.misoriented_edges}};
  Json json = Json::object();
  std::vector<std::string> found;
  for (std::size_t i = 0; i < std::size(counts); ++i) {
    const auto& [name, count] = counts[i];
    json.set(name, count);
    if (count) found.push_back(formatCount(count) + " " + kDefectKeys[i].caption);
  }
  report.set("defects", json, found.empty() ? "none" : joined(found));
}

constexpr std::size_t kMaxListed = 100; // max listed parts and holes

void describeParts(std::vector<PartSides> parts, Report& report) {
  std::stable_sort(parts.begin(), parts.end(), [](const PartSides& a, const PartSides& b) {
    return a.triangles > b.triangles;
  });
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(parts.size(), kMaxListed); ++i)
    list.push(Json::object()
                  .set("triangles", parts[i].triangles)
                  .set("boundary_edges", parts[i].rim_edges)
                  .set("sides", sideName(parts[i].sides))
                  .set("by", parts[i].asked ? "user" : "program"));
  report.set("parts", list, describeParts(parts));
}

void describeHoles(const std::vector<Hole>& holes, Report& report) {
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(holes.size(), kMaxListed); ++i)
    list.push(Json::object()
                  .set("area", holes[i].area)
                  .set("centre", vectorJson(holes[i].centre))
                  .set("edges", holes[i].edges));
  report.set("holes", list,
             holes.empty() ? ""
                           : formatCount(holes.size()) + " closed over, the largest " +
                                 describeHole(holes.front()));
}

// `built`: the sides that a field of the mesh finds.
void describeMesh(const TriangleMesh& mesh, const MeshReport& counts, const FieldReport& built,
                  const Scene& scene, Report& report) {
  const Box3 box = bounds(mesh);
  const Vec3 size = box.isEmpty() ? Vec3::Zero() : Vec3(box.sizes());
  report.set("triangles", counts.triangles).set("vertices", counts.vertices);
  report.set(
      "bounds",
      box.isEmpty() ? Json() : Json(Json::Array{vectorJson(box.min()), vectorJson(box.max())}),
      formatLength(size.x()) + " x " + formatLength(size.y()) + " x " + formatLength(size.z()));
  report.set("watertight", counts.watertight).set("components", counts.components);
  describeDefects(counts, report);
  report.set("widest_crack", counts.widest_crack);
  const auto sides = sideCounts(counts.triangles - counts.non_finite - counts.degenerate,
                                built.open_triangles, scene.field.sides);
  Json list = Json::array();
  for (const SideCount& side : sides)
    list.push(Json::object().set("sides", side.sides).set("triangles", side.triangles));
  const bool plates = built.open_triangles > 0 && !haveTwoSides(scene.field.sides);
  report.set("components_sides", list,
             describeSides(sides) + (plates ? ": the front of a plate as thick as the band" : ""));
  describeParts(built.parts, report);
  describeHoles(built.holes, report);
}

// Returns the object's own mesh where its pose moves nothing, so that it is held once.
std::shared_ptr<const TriangleMesh> sharedWorldMesh(const SceneObject& object) {
  if (object.world_from_object.matrix().isIdentity(0.0)) return object.mesh;
  return std::make_shared<const TriangleMesh>(worldMesh(object));
}

// Finds the sides without building the field.
FieldReport sidesWithoutField(const Scene& scene) {
  Box3 box;
  for (const SceneObject& object : scene.objects) box.extend(fieldBounds(*sharedWorldMesh(object)));
  const double voxel = scene.field.voxel.value_or(
      box.isEmpty()
          ? 0
          : box.sizes().maxCoeff() / std::max(1.0, scene.field.resolution - 2 * scene.field.band));
  FieldReport found;
  for (const SceneObject& object : scene.objects) {
    const OpenParts open = openParts(*sharedWorldMesh(object), scene.field.sides, voxel);
    found.inner_triangles += open.inner_triangles;
    found.open_triangles += open.triangles;
    found.parts.insert(found.parts.end(), open.decided.begin(), open.decided.end());
    found.holes.insert(found.holes.end(), open.holes.begin(), open.holes.end());
  }
  return found;
}

void describeMesh(const Scene& scene, Report& report, Console& console) {
  const FieldReport found = sidesWithoutField(scene);
  const auto shared = scene.objects.size() == 1
                          ? sharedWorldMesh(scene.objects.front())
                          : std::make_shared<const TriangleMesh>(worldMesh(scene));
  const TriangleMesh& mesh = *shared;
  describeMesh(mesh, inspect(mesh), found, scene, report);
  report.set("inner_triangles", found.inner_triangles);
  for (const std::string& line : surfaceWarnings(found, scene.field.sides, mesh))
    console.warn(line);
}

void describeObjects(const Scene& scene, Report& report) {
  Json objects = Json::array();
  for (const SceneObject& object : scene.objects) {
    const std::size_t triangles = object.mesh->triangles.size();
    objects.push(Json::object().set("name", object.name).set("triangles", triangles));
    if (scene.objects.size() > 1)
      report.tell("object " + object.name, formatCount(triangles) + " triangles");
  }
  report.set("objects", objects);
}

std::size_t bytesOf(const TriangleMesh& mesh) {
  return mesh.positions.size() * sizeof(Vec3) + mesh.triangles.size() * sizeof(Triangle) +
         mesh.corner_uvs.size() * sizeof(mesh.corner_uvs[0]);
}

// Memory of meshes in object frames that differ from the world-frame mesh.
std::size_t givenMeshBytes(const CompiledScene& compiled) {
  std::set<const TriangleMesh*> counted = {compiled.mesh.get()};
  std::size_t bytes = 0;
  for (const SceneObject& object : compiled.scene.objects)
    if (counted.insert(object.mesh.get()).second) bytes += bytesOf(*object.mesh);
  return bytes;
}

std::vector<LayerBytes> layersOf(const CompiledScene& compiled) {
  std::vector<LayerBytes> layers = {{"mesh", bytesOf(*compiled.mesh)}};
  if (const std::size_t bytes = givenMeshBytes(compiled)) layers.push_back({"mesh as read", bytes});
  for (LayerBytes& layer : compiled.built.field->layerBytes()) layers.push_back(std::move(layer));
  for (LayerBytes& layer : paintLayers(compiled)) layers.push_back(std::move(layer));
  // Data that let one object move without a rebuild of the others.
  if (const std::size_t bytes = mergeBytes(compiled)) layers.push_back({"merge", bytes});
  return layers;
}

void describeLayers(const std::vector<LayerBytes>& layers, const Scene& scene, Report& report) {
  std::vector<Report> list;
  std::size_t sum = 0;
  for (const LayerBytes& layer : layers) {
    Report& entry = list.emplace_back(kLayerKeys);
    entry.set("name", layer.name);
    if (layer.name == "merge")
      entry.set("why", std::to_string(scene.objects.size()) + " objects" +
                           (scene.redistance ? ", merge.redistance = on" : ""));
    entry.set("bytes", layer.bytes);
    sum += layer.bytes;
  }
  report.set("layers", list).set("bytes", sum);
}

void describeStages(const CompiledScene& compiled, Report& report) {
  const std::vector<double> ns = stageNs(compiled);
  std::vector<Report> stages;
  for (std::size_t i = 0; i < compiled.snapshot->why.size(); ++i) {
    const StageInfo& stage = compiled.snapshot->why[i];
    stages.push_back(Report(kStageKeys)
                         .set("name", stage.name)
                         .set("why", stage.why)
                         .set("bytes", stage.bytes)
                         .set("ns", ns[i], ns[i] < 1 ? "below 1 ns" : shown(ns[i], "ns")));
  }
  report.set("stages", stages);
}

void describeCompiled(const CompiledScene& compiled, Report& report, Progress& progress) {
  const FieldReport& built = compiled.built.report;
  describeMesh(*compiled.mesh, compiled.mesh_report, built, compiled.scene, report);
  report.set("field", fieldReport(*compiled.built.field, built));
  describeLayers(layersOf(compiled), compiled.scene, report);
  describeStages(compiled, report);
  if (const auto relief = reliefReport(compiled)) report.set("relief", *relief);
  // A stability limit needs a device.
  if (!compiled.scene.device_model) return;
  if (const auto stability = surfaceStability(compiled, progress))
    report.set("stability", stabilityReport(*stability, compiled.scene));
}

// Describes the file itself without stages, which would belong to a field rebuilt from its surface.
void describeFieldFile(const std::filesystem::path& path, const Scene& scene, Report& report,
                       Console& console) {
  describeMesh(scene, report, console);
  const SurfaceField field = readField(path);
  FieldReport built;
  built.blocks = field.blockCount();
  built.bytes = field.bytes();
  built.dense_bytes = field.grid.nodeCount() * (sizeof(float) + sizeof(std::int32_t));
  report.set("field", fieldReport(field, built));
  describeLayers(field.layerBytes(), scene, report);
  report.set("stages", std::vector<Report>());
}

int runInfo(const InfoOptions& options, Console& console) {
  OpenedScene opened = openedWith(options.input, options.scene, console);
  Scene& scene = opened.scene;
  const bool is_folder = std::filesystem::is_directory(inputPath(options.input));
  const bool is_field = !is_folder && isFieldFile(options.input);
  Report report(kInfoKeys);
  report.set("file", options.input.string());
  report.set("kind", is_folder ? "workspace" : is_field ? "field" : "mesh");
  if (is_folder) {
    tellValues(scene, report);
    tellScans(scene, report);
    for (const SceneScan& scan : scene.scans) try {
        requireFrames(scan);
      } catch (const FileError& error) {
        console.warn(error.what());
      }
    const StoredHistory& history = *opened.history;
    if (history.undoable + history.redoable > 0) {
      report.set("history",
                 Json::object().set("undo", history.undoable).set("redo", history.redoable),
                 historyText(history.undoable, history.redoable));
    }
  }
  describeObjects(scene, report);
  if (options.no_field || scene.objects.empty()) {
    describeMesh(scene, report, console);
    report.set("layers", std::vector<Report>()).set("stages", std::vector<Report>());
  } else if (is_field) {
    for (const auto& [key, value] : options.scene.settings)
      console.warn(options.input.string() + ": --" + key + " has no effect on a field");
    describeFieldFile(options.input, scene, report, console);
  } else {
    describeCompiled(*compileFor(std::move(scene), console), report, console.progress());
  }
  return console.report(report);
}

} // namespace

Command infoCommand() {
  auto options = std::make_shared<InfoOptions>();
  Command command{
      .name = "info",
      .summary = "what a mesh, field or workspace is and what it costs to feel",
      .description =
          "Reports size, defects, whether the mesh is watertight, and which open parts are touched "
          "from one side or both; the bytes of each layer of its field and of everything in "
          "memory; the active stages of the servo, the reason, and the bytes and ns of each "
          "(measured here, on short strokes over the mesh). Of a field (.vti) written by patina: "
          "the file's own grid and layers, and its surface as the mesh; stages stay empty. For a "
          "scene with a device (device.* values), the smallest K*(x)/K of the surface and its "
          "place. For a painted scene also the bytes of its paint, the height of its relief and "
          "the height that is stable on the device, and the edits that can be undone.",
      .examples = {"patina info bunny.ply", "patina info workspace --json",
                   "patina info huge.stl --unit m --no-field"},
      .keys = kInfoKeys,
      .arguments = {sceneInput(options->input, "FILE"),
                    {"--no-field", "", "", "", "Only the mesh: layers and stages stay empty.",
                     into(options->no_field)}},
      .run = [options](Console& console) { return runInfo(*options, console); }};
  addFieldOptions(command, options->scene);
  addOpenOptions(command, options->scene.open);
  return command;
}

} // namespace patina::cli
