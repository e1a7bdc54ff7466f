#include "app/cli/commands/commands.h"
#include "app/cli/input/paint_images.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/input/tip_path.h"
#include "app/cli/output/reports.h"
#include "app/cli/output/stability_report.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/staged_folder.h"
#include "field/sampling/field_sampler.h"
#include "field/surface/iso_surface.h"
#include "visualization/export/export_files.h"
#include "visualization/export/export_paint.h"
#include "visualization/export/field_io.h"

namespace patina::cli {

namespace {

struct ExportOptions {
  std::filesystem::path input, output, path;
  bool stability = false;
  SceneOptions scene;
};

const Keys kExportKeys = {{"folder", "", "folder", "", Shown::never},
                          {"files", "", "files", "in the folder", Shown::never},
                          {"stability", "", "as patina render"}};

// The field at the mesh's own vertices: how far the sampled surface is from the given one.
CsvTable vertexTable(const CompiledScene& compiled) {
  CsvTable table;
  table.columns = {"x [m]", "y [m]", "z [m]", "phi [m]", "nx", "ny", "nz"};
  const FieldSampler sampler(*compiled.built.field, compiled.scene.sampler);
  for (const Vec3& p : compiled.mesh->positions) {
    const GridSample sample = sampler.at(p);
    const double length = sample.gradient.norm();
    const Vec3 n = length > 0 ? Vec3(sample.gradient / length) : Vec3::Zero();
    table.rows.push_back({p.x(), p.y(), p.z(), sample.phi, n.x(), n.y(), n.z()});
  }
  return table;
}

// Of each triangle; nothing to tell apart in a scene of one.
std::vector<std::int32_t> objectsOf(const CompiledScene& compiled) {
  std::vector<std::int32_t> object;
  if (compiled.objects.size() < 2) return object;
  for (std::size_t i = 0; i < compiled.objects.size(); ++i)
    object.insert(object.end(), compiled.objects[i]->mesh->triangles.size(),
                  static_cast<std::int32_t>(i));
  return object;
}

int runExport(const ExportOptions& options, Console& console) {
  const std::filesystem::path& folder = options.output;
  std::vector<TimedTip> path;
  if (!options.path.empty()) path = readTipPath(options.path);
  const auto compiled =
      compileFor(openWith(options.input, options.scene, console), console, FaceLayer::kept);
  std::vector<ToolSample> samples;
  if (!path.empty()) samples = feel(*compiled->snapshot, path, console.progress());
  std::optional<SurfaceStability> stability;
  if (options.stability) stability = requiredStability(*compiled, console.progress());
  console.progress().throwIfCancelled();

  StagedFolder files_of(options.output, "scene.vtm");
  const std::filesystem::path& staging = files_of.path();
  std::vector<std::pair<std::string, std::string>> blocks = {
      {"mesh", "mesh.vtp"}, {"surface", "surface.vtp"}, {"field", "field.vti"}};
  writeMeshVtp(staging / "mesh.vtp", *compiled->mesh, {}, objectsOf(*compiled));
  // With a finite tip the surface that is felt lies its radius outside.
  const double iso = compiled->scene.haptics.tip_radius.value_or(0.0);
  if (stability)
    writeMeshVtp(staging / "surface.vtp", *stability->surface,
                 {{"stability [K*/K]", stability->map.ratio},
                  {"least stiffness [N/m]", stability->map.least}});
  else
    writeMeshVtp(staging / "surface.vtp", isoSurface(*compiled->paint.field, iso));
  writeField(staging / "field.vti", *compiled->paint.field);
  writeCsv(staging / "vertices.csv", vertexTable(*compiled));
  const std::vector<SceneObject>& objects = compiled->scene.objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const ObjectPaint* paint = objects[i].paint.get();
    if (paint == nullptr) continue;
    const std::string surface = "paint-" + objects[i].name + ".vtp";
    writePaintVtp(staging / surface, compiled->scene, i);
    blocks.emplace_back(objects[i].name + " paint", surface);
    if (!paint->material || paint->material->blocks().empty()) continue;
    const std::string volume = "material-" + objects[i].name + ".vti";
    writeMaterialVti(staging / volume, compiled->scene, i);
    blocks.emplace_back(objects[i].name + " material", volume);
  }
  if (!samples.empty()) {
    writeToolPathVtp(staging / "path.vtp", samples);
    writeToolSamplesCsv(staging / "forces.csv", samples);
    blocks.emplace_back("path", "path.vtp");
  }
  const std::vector<std::string> images = writePaintImages(compiled->scene, staging, console);
  writeCollectionVtm(staging / "scene.vtm", blocks);
  console.progress().throwIfCancelled();
  files_of.commit();

  Report report(kExportKeys);
  Json files = Json::array();
  const auto wrote = [&](const std::string& what, const std::string& file) {
    files.push(file);
    report.tell(what, (folder / file).string());
  };
  for (const auto& [name, file] : blocks) wrote(name, file);
  wrote("vertices", "vertices.csv");
  if (!samples.empty()) wrote("forces", "forces.csv");
  for (const std::string& image : images) wrote("image", image);
  wrote("all", "scene.vtm");
  report.set("folder", folder.string()).set("files", files);
  if (stability) report.set("stability", stabilityReport(*stability, compiled->scene));
  console.report(report);
  return kDone;
}

} // namespace

Command exportCommand() {
  auto options = std::make_shared<ExportOptions>();
  Command command{
      .name = "export",
      .summary = "write everything for ParaView",
      .description =
          "Into the folder: mesh.vtp (of several objects with the index of each triangle's), "
          "surface.vtp (the surface that the tip's centre feels, without relief that is pulled), "
          "field.vti, vertices.csv (the field at the mesh's vertices), scene.vtm, which opens them "
          "together, and with --path also path.vtp and forces.csv (as patina feel). Painted images "
          "go beside them, as .png (16 bits) and .exr (floats); paint-NAME.vtp has an object's "
          "mesh with all that was painted on it, material-NAME.vti its painted material.\n"
          "With --stability the vertices of surface.vtp carry K*(x)/K, below 1 where the loop "
          "would buzz, and the least stiffness of any direction, below 0 where the tip slips off.",
      .examples = {"patina export workspace -o paraview",
                   "patina export bunny.ply -o paraview --path tip.csv"},
      .keys = kExportKeys,
      .arguments = {sceneInput(options->input),
                    outputTo(options->output, "FOLDER", "Where to; made if it is missing."),
                    {"--path", "TIP.csv", "", "", "A tip path to feel and write too.",
                     into(options->path)},
                    {"--stability", "", "", "", "Where would it buzz: arrays on surface.vtp.",
                     into(options->stability)}},
      .run = [options](Console& console) { return runExport(*options, console); }};
  addHapticOptions(command, options->scene);
  addSampledFieldOptions(command, options->scene);
  return command;
}

} // namespace patina::cli
