#include <optional>
#include <set>

#include "app/cli/commands/commands.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/output/paint_report.h"
#include "app/cli/output/reports.h"
#include "app/cli/output/stability_report.h"
#include "core/error.h"
#include "core/numbers.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/open_parts.h"
#include "session/build/compile_warnings.h"
#include "session/build/stage_cost.h"
#include "session/store/attach_scan.h"
#include "visualization/export/field_io.h"

namespace patina::cli {

namespace {

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

constexpr std::size_t kMostListed = 100; // parts and holes

void describeParts(std::vector<PartSides> parts, Report& report) {
  std::stable_sort(parts.begin(), parts.end(), [](const PartSides& a, const PartSides& b) {
    return a.triangles > b.triangles;
  });
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(parts.size(), kMostListed); ++i)
    list.push(Json::object()
                  .set("triangles", parts[i].triangles)
                  .set("boundary_edges", parts[i].rim_edges)
                  .set("sides", sideName(parts[i].sides))
                  .set("by", parts[i].asked ? "user" : "program"));
  report.set("parts", list, describeParts(parts));
}

void describeHoles(const std::vector<Hole>& holes, Report& report) {
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(holes.size(), kMostListed); ++i)
    list.push(Json::object()
                  .set("area", holes[i].area)
                  .set("centre", vectorJson(holes[i].centre))
                  .set("edges", holes[i].edges));
  report.set("holes", list,
             holes.empty() ? ""
                           : formatCount(holes.size()) + " closed over, the largest " +
                                 describeHole(holes.front()));
}

// `built`: what a field of the mesh says of its sides.
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

// As a field of the scene would find it.
FieldReport sidesWithoutField(const Scene& scene) {
  Box3 box;
  for (const SceneObject& object : scene.objects) box.extend(fieldBounds(worldMesh(object)));
  const double voxel = scene.field.voxel.value_or(
      box.isEmpty()
          ? 0
          : box.sizes().maxCoeff() / std::max(1.0, scene.field.resolution - 2 * scene.field.band));
  FieldReport found;
  for (const SceneObject& object : scene.objects) {
    const TriangleMesh mesh = worldMesh(object);
    const OpenParts open = openParts(mesh, scene.field.sides, voxel);
    found.inner_triangles += open.inner_triangles;
    found.open_triangles += open.triangles;
    found.parts.insert(found.parts.end(), open.decided.begin(), open.decided.end());
    found.holes.insert(found.holes.end(), open.holes.begin(), open.holes.end());
  }
  return found;
}

void describeMesh(const Scene& scene, Report& report, Console& console) {
  const TriangleMesh mesh = worldMesh(scene);
  const FieldReport found = sidesWithoutField(scene);
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

// Of the meshes as they were read, where they are not the one in the world's frame.
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
  // What several objects hold so that one may be moved without the others being built again.
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
  // Without a device nothing is known that could be unstable.
  if (!compiled.scene.device_model) return;
  if (const auto stability = surfaceStability(compiled, progress))
    report.set("stability", stabilityReport(*stability, compiled.scene));
}

// What the file holds, and no stages: they would be those of another field, built anew from its
// surface.
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
          "Size, defects, whether the mesh is watertight and what of it is open and felt from one "
          "side or two; the bytes of each layer of its field and of all that is held; the stages "
          "of the servo that are on, why, and what each costs in bytes and ns (measured here, on "
          "short strokes over the mesh). Of a field (.vti) written by patina: the file's own grid "
          "and layers, and its surface as the mesh; stages stay empty. Where the scene has a "
          "device (device.* values), the smallest K*(x)/K of the surface and where. Of a painted "
          "scene also the bytes of its paint, how high its relief is and what height the device "
          "bears, and the edits that can be undone.",
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
