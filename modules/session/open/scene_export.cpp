#include "session/open/scene_export.h"

#include <algorithm>

#include "core/csv.h"
#include "core/numbers.h"
#include "core/staged_folder.h"
#include "field/sampling/field_sampler.h"
#include "field/surface/iso_surface.h"
#include "pictures/picture_file.h"
#include "visualization/export/export_files.h"
#include "visualization/export/export_paint.h"
#include "visualization/files/field_io.h"

namespace patina {
namespace {

// Field values at the mesh's vertices, the deviation of the sampled surface from the mesh.
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

// Object number of each triangle; empty for a scene of one object.
std::vector<std::int32_t> objectsOf(const CompiledScene& compiled) {
  std::vector<std::int32_t> object;
  if (compiled.objects.size() < 2) return object;
  for (std::size_t i = 0; i < compiled.objects.size(); ++i)
    object.insert(object.end(), compiled.objects[i]->mesh->triangles.size(),
                  static_cast<std::int32_t>(i));
  return object;
}

Picture pictureOf(const TiledImage& image) {
  Picture picture{image.width(), image.height(), image.channels(), {}};
  for (int j = 0; j < image.height(); ++j)
    for (int i = 0; i < image.width(); ++i)
      for (int c = 0; c < image.channels(); ++c) picture.texel.push_back(image.at(i, j, c));
  return picture;
}

void divideByCoverage(Picture& picture) {
  for (std::size_t i = 0; i < picture.texel.size(); i += kColorChannels) {
    const float alpha = picture.texel[i + 3];
    if (alpha <= 0) continue;
    for (std::size_t c = 0; c < 3; ++c) picture.texel[i + c] /= alpha;
  }
}

// Writes each image as .png (16 bits; relief clamped to 0..1, with a warning) and .exr (floats, bit
// for bit; relief unscaled, 1 = relief.height). Colour is not premultiplied.
void writeImages(const Scene& scene, const std::filesystem::path& folder,
                 const ExportExtras& extras, std::vector<ExportedFile>& files) {
  const auto write = [&](const std::string& stem, const Picture& picture) {
    for (const char* extension : {".png", ".exr"}) {
      writePicture(folder / (stem + extension), picture);
      files.push_back({"image", stem + extension});
    }
  };
  for (const SceneObject& object : scene.objects) {
    if (!object.paint) continue;
    if (object.paint->color) {
      Picture picture = pictureOf(*object.paint->color);
      divideByCoverage(picture);
      write(object.name + "-color", picture);
    }
    if (!object.paint->relief) continue;
    const Picture picture = pictureOf(*object.paint->relief);
    const auto [least, most] = std::minmax_element(picture.texel.begin(), picture.texel.end());
    if (extras.warn && (*least < 0 || *most > 1))
      extras.warn(object.name + "-relief.png is clamped to 0..1: the full range " +
                  formatNumber(static_cast<double>(*least)) + " to " +
                  formatNumber(static_cast<double>(*most)) + " is in the .exr");
    write(object.name + "-relief", picture);
  }
}

} // namespace

std::vector<ExportedFile> exportScene(const CompiledScene& compiled,
                                      const std::filesystem::path& folder,
                                      const ExportExtras& extras, Progress& progress) {
  StagedFolder staged(folder, "scene.vtm");
  const std::filesystem::path& into = staged.path();
  std::vector<std::pair<std::string, std::string>> blocks = {
      {"mesh", "mesh.vtp"}, {"surface", "surface.vtp"}, {"field", "field.vti"}};
  writeMeshVtp(into / "mesh.vtp", *compiled.mesh, {}, objectsOf(compiled));
  const double iso = compiled.scene.haptics.tip_radius.value_or(0.0);
  if (extras.stability)
    writeMeshVtp(into / "surface.vtp", *extras.stability->surface,
                 {{"stability [K*/K]", extras.stability->map.ratio},
                  {"least stiffness [N/m]", extras.stability->map.least}});
  else
    writeMeshVtp(into / "surface.vtp", isoSurface(*compiled.paint.field, iso));
  progress.throwIfCancelled();
  writeField(into / "field.vti", *compiled.paint.field);
  writeCsv(into / "vertices.csv", vertexTable(compiled));
  const std::vector<SceneObject>& objects = compiled.scene.objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const ObjectPaint* paint = objects[i].paint.get();
    if (paint == nullptr) continue;
    progress.throwIfCancelled();
    const std::string surface = "paint-" + objects[i].name + ".vtp";
    writePaintVtp(into / surface, compiled.scene, i);
    blocks.emplace_back(objects[i].name + " paint", surface);
    if (!paint->material || paint->material->blocks().empty()) continue;
    const std::string volume = "material-" + objects[i].name + ".vti";
    writeMaterialVti(into / volume, compiled.scene, i);
    blocks.emplace_back(objects[i].name + " material", volume);
  }
  if (!extras.samples.empty()) {
    writeToolPathVtp(into / "path.vtp", extras.samples);
    writeToolSamplesCsv(into / "forces.csv", extras.samples);
    blocks.emplace_back("path", "path.vtp");
  }
  std::vector<ExportedFile> files;
  for (const auto& [what, name] : blocks) files.push_back({what, name});
  files.push_back({"vertices", "vertices.csv"});
  if (!extras.samples.empty()) files.push_back({"forces", "forces.csv"});
  writeImages(compiled.scene, into, extras, files);
  writeCollectionVtm(into / "scene.vtm", blocks);
  files.push_back({"all", "scene.vtm"});
  for (const auto& made : std::filesystem::directory_iterator(into))
    for (const std::filesystem::path& input : extras.inputs) {
      std::error_code unknown; // a missing file is no input
      const std::filesystem::path target = folder / made.path().filename();
      if (std::filesystem::equivalent(target, input, unknown))
        throw FileError(target.string(), 0, "cannot be written: it is an input of this command");
    }
  progress.throwIfCancelled();
  staged.commit();
  return files;
}

} // namespace patina
