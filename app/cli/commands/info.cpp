#include <optional>

#include "app/cli/commands/commands.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/output/paint_report.h"
#include "app/cli/output/reports.h"
#include "app/cli/output/stability_report.h"
#include "core/numbers.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/open_parts.h"
#include "session/build/stage_cost.h"
#include "visualization/export/field_io.h"

namespace patina::cli {

namespace {

struct InfoOptions {
  std::filesystem::path input;
  bool no_field = false;
  SceneOptions scene;
};

Json defectsJson(const MeshReport& report) {
  Json json = Json::object();
  json.set("non_finite", report.non_finite);
  json.set("degenerate", report.degenerate);
  json.set("duplicate", report.duplicate);
  json.set("boundary_edges", report.boundary_edges);
  json.set("non_manifold_edges", report.non_manifold_edges);
  json.set("misoriented_edges", report.misoriented_edges);
  return json;
}

std::string defectsText(const MeshReport& report) {
  const std::pair<std::size_t, const char*> kinds[] = {
      {report.non_finite, "non-finite triangles"},
      {report.degenerate, "triangles without area"},
      {report.duplicate, "duplicate triangles"},
      {report.boundary_edges, "boundary edges"},
      {report.non_manifold_edges, "non-manifold edges"},
      {report.misoriented_edges, "misoriented edges"}};
  std::string text;
  for (const auto& [count, what] : kinds)
    if (count) text += (text.empty() ? "" : ", ") + formatCount(count) + " " + what;
  return text.empty() ? "none" : text;
}

void describeMesh(const TriangleMesh& mesh, const MeshReport& report, Json& json, TextRows& rows) {
  const Box3 box = bounds(mesh);
  json.set("triangles", report.triangles);
  json.set("vertices", report.vertices);
  json.set("bounds", box.isEmpty()
                         ? Json()
                         : Json(Json::Array{vectorJson(box.min()), vectorJson(box.max())}));
  json.set("watertight", report.watertight);
  json.set("components", report.components);
  json.set("defects", defectsJson(report));
  rows.emplace_back("triangles", formatCount(report.triangles));
  rows.emplace_back("vertices", formatCount(report.vertices));
  const Vec3 size = box.isEmpty() ? Vec3::Zero() : Vec3(box.sizes());
  rows.emplace_back("size", formatLength(size.x()) + " x " + formatLength(size.y()) + " x " +
                                formatLength(size.z()));
  rows.emplace_back("watertight", report.watertight ? "yes" : "no");
  rows.emplace_back("components", formatCount(report.components));
  rows.emplace_back("defects", defectsText(report));
}

void describeSides(std::size_t open_triangles, const Scene& scene, const MeshReport& report,
                   Json& json, TextRows& rows) {
  const auto counts = sideCounts(report.triangles - report.non_finite - report.degenerate,
                                 open_triangles, scene.field.sides);
  Json list = Json::array();
  for (const SideCount& count : counts) {
    Json entry = Json::object();
    entry.set("sides", count.sides);
    entry.set("triangles", count.triangles);
    list.push(entry);
  }
  json.set("components_sides", list);
  if (counts.empty()) return;
  const bool plates = open_triangles > 0 && scene.field.sides == OpenSides::one;
  rows.emplace_back("sides",
                    text(counts) + (plates ? ": the front of a plate as thick as the band" : ""));
}

void describeObjects(const Scene& scene, Json& json, TextRows& rows) {
  Json objects = Json::array();
  for (const SceneObject& object : scene.objects) {
    const std::size_t triangles = object.mesh->triangles.size();
    Json entry = Json::object();
    entry.set("name", object.name);
    entry.set("triangles", triangles);
    objects.push(entry);
    if (scene.objects.size() > 1)
      rows.emplace_back("object " + object.name, formatCount(triangles) + " triangles");
  }
  json.set("objects", objects);
}

// What several objects hold so that one may be moved without the others being built again.
std::optional<Json> mergeLayer(const CompiledScene& compiled, TextRows& rows) {
  const std::size_t bytes = mergeBytes(compiled);
  if (bytes == 0) return std::nullopt;
  const std::string why = std::to_string(compiled.objects.size()) + " objects" +
                          (compiled.scene.redistance ? ", merge.redistance = on" : "");
  Json entry = Json::object();
  entry.set("name", "merge");
  entry.set("why", why);
  entry.set("bytes", bytes);
  rows.emplace_back("layer merge", why + "; " + formatBytes(static_cast<double>(bytes)));
  return entry;
}

void describeLayers(const SurfaceField& field, std::size_t mesh_bytes,
                    const CompiledScene* compiled, Json& json, TextRows& rows) {
  Json layers = Json::array();
  std::vector<LayerBytes> all = field.layerBytes();
  if (mesh_bytes) all.insert(all.begin(), {"mesh", mesh_bytes});
  if (compiled)
    for (LayerBytes& layer : paintLayers(*compiled)) all.push_back(std::move(layer));
  for (const LayerBytes& layer : all) {
    Json entry = Json::object();
    entry.set("name", layer.name);
    entry.set("bytes", layer.bytes);
    layers.push(entry);
    rows.emplace_back("layer " + layer.name, formatBytes(static_cast<double>(layer.bytes)));
  }
  if (compiled)
    if (auto merge = mergeLayer(*compiled, rows)) layers.push(*merge);
  json.set("layers", layers);
}

void describeStages(const CompiledScene& compiled, Json& json, TextRows& rows) {
  const std::vector<double> ns = stageNs(compiled);
  Json stages = Json::array();
  for (std::size_t i = 0; i < compiled.snapshot->why.size(); ++i) {
    const StageInfo& stage = compiled.snapshot->why[i];
    Json entry = Json::object();
    entry.set("name", stage.name);
    entry.set("why", stage.why);
    entry.set("bytes", stage.bytes);
    entry.set("ns", ns[i]);
    stages.push(entry);
    rows.emplace_back("stage " + stage.name,
                      stage.why + "; " + formatBytes(static_cast<double>(stage.bytes)) + ", " +
                          (ns[i] < 1 ? "below 1" : rounded(ns[i])) + " ns");
  }
  json.set("stages", stages);
}

// Without a device nothing is known that could be unstable.
void describeStability(const CompiledScene& compiled, Json& json, TextRows& rows,
                       Progress& progress) {
  if (!compiled.scene.device_model) return;
  const auto stability = surfaceStability(compiled, progress);
  if (!stability) return;
  json.set("stability", stabilityJson(*stability, compiled.scene));
  rows.push_back(stabilityRows(*stability, compiled.scene).front());
}

std::size_t bytesOf(const TriangleMesh& mesh) {
  return mesh.positions.size() * sizeof(Vec3) + mesh.triangles.size() * sizeof(Triangle) +
         mesh.corner_uvs.size() * sizeof(mesh.corner_uvs[0]);
}

void describeField(const SurfaceField& field, const FieldReport& report, Json& json,
                   TextRows& rows) {
  json.set("field", fieldJson(field, report));
  const TextRows more = fieldRows(field, report);
  rows.insert(rows.end(), more.begin(), more.end());
}

void describeHistory(const StoredHistory& history, Json& json, TextRows& rows) {
  if (history.undoable + history.redoable == 0) return;
  Json entry = Json::object();
  entry.set("undo", history.undoable);
  entry.set("redo", history.redoable);
  json.set("history", std::move(entry));
  rows.emplace_back("history", formatCount(history.undoable) + " to undo, " +
                                   formatCount(history.redoable) + " to redo");
}

int runInfo(const InfoOptions& options, Console& console) {
  OpenedScene opened = openedWith(options.input, options.scene, console);
  Scene& scene = opened.scene;
  const bool is_folder = std::filesystem::is_directory(inputPath(options.input));
  const bool is_field = !is_folder && isFieldFile(options.input);
  const char* kind = is_folder ? "workspace" : is_field ? "field" : "mesh";
  Json json = Json::object();
  TextRows rows = {{"file", options.input.string()}, {"kind", kind}};
  json.set("file", options.input.string());
  json.set("kind", kind);
  if (is_folder) {
    for (const auto& [key, value] : values(scene)) rows.emplace_back(key, withUnit(key, value));
    json.set("values", valuesJson(scene));
    describeHistory(*opened.history, json, rows);
  }
  describeObjects(scene, json, rows);
  if (options.no_field || scene.objects.empty()) {
    const TriangleMesh mesh = worldMesh(scene);
    const MeshReport report = inspect(mesh);
    describeMesh(mesh, report, json, rows);
    describeSides(openParts(mesh).triangles, scene, report, json, rows);
    json.set("layers", Json::array());
    json.set("stages", Json::array());
  } else if (is_field) {
    // What the file holds, and no stages: they would be those of another field, built anew from
    // its surface.
    for (const auto& [key, value] : options.scene.settings)
      console.warn(options.input.string() + ": --" + key + " has no effect on a field");
    const TriangleMesh mesh = worldMesh(scene);
    const MeshReport mesh_report = inspect(mesh);
    describeMesh(mesh, mesh_report, json, rows);
    describeSides(openParts(mesh).triangles, scene, mesh_report, json, rows);
    const SurfaceField field = readField(options.input);
    FieldReport report;
    report.blocks = field.blockCount();
    report.bytes = field.bytes();
    report.dense_bytes = field.grid.nodeCount() * (sizeof(float) + sizeof(std::int32_t));
    describeField(field, report, json, rows);
    describeLayers(field, 0, nullptr, json, rows);
    json.set("stages", Json::array());
  } else {
    const auto compiled = compileFor(std::move(scene), console);
    describeMesh(*compiled->mesh, compiled->mesh_report, json, rows);
    describeSides(compiled->built.report.open_triangles, compiled->scene, compiled->mesh_report,
                  json, rows);
    describeField(*compiled->built.field, compiled->built.report, json, rows);
    describeLayers(*compiled->built.field, bytesOf(*compiled->mesh), compiled.get(), json, rows);
    describeStages(*compiled, json, rows);
    describeRelief(*compiled, json, rows);
    describeStability(*compiled, json, rows, console.progress());
  }
  console.report(json, aligned(rows));
  return kDone;
}

} // namespace

Command infoCommand() {
  auto options = std::make_shared<InfoOptions>();
  Command command;
  command.name = "info";
  command.summary = "what a mesh, field or workspace is and what it costs to feel";
  command.description =
      "Size, defects, whether the mesh is watertight and what of it is open and felt from one side "
      "or two; the bytes of each layer of its field; the "
      "stages of the servo that are on, why, and what each costs in bytes and ns (measured here, "
      "on "
      "short strokes over the mesh). Of a field (.vti) written by patina: the file's own grid and "
      "layers, and its surface as the mesh; stages stay empty. Where the scene has a device "
      "(device.* values), the smallest K*(x)/K of the surface and where. Of a painted scene also "
      "the "
      "bytes of its paint, how high its relief is and what height the device bears, and the edits "
      "that can be undone.\n"
      "JSON: kind, triangles, vertices, bounds [m], watertight, components, components_sides "
      "(sides: "
      "closed, one-sided or two-sided; triangles), defects (non_finite, degenerate, duplicate, "
      "boundary_edges, non_manifold_edges, misoriented_edges), objects (name, triangles), layers "
      "(name, bytes; why, of the one that keeps several objects apart), stages "
      "(name, why, bytes, ns), field (as patina field), stability (as patina "
      "render; only with a device); of a painted scene more layers, relief (object, highest, "
      "wavelength [m]; admissible [m], exceeded: with a device), history (undo, redo).";
  command.examples = {"patina info bunny.ply", "patina info workspace --json",
                      "patina info huge.stl --unit m --no-field"};
  command.input("FILE", "Mesh (.obj .ply .stl), workspace or volume (.vti).", options->input);
  command.flag("--no-field", "Only the mesh: layers and stages stay empty.", options->no_field);
  addFieldOptions(command, options->scene);
  addOpenOptions(command, options->scene.open);
  command.run = [options](Console& console) { return runInfo(*options, console); };
  return command;
}

} // namespace patina::cli
