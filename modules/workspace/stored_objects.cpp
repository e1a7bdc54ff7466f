#include "workspace/stored_objects.h"

#include "core/error.h"
#include "geometry/io/mesh_io.h"
#include "workspace/content_files.h"
#include "workspace/paint_files.h"
#include "workspace/texture_file.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

std::optional<ContentFile> storeImage(const std::shared_ptr<const TiledImage>& image,
                                      const std::string& prefix, const fs::path& folder) {
  if (!image) return std::nullopt;
  return storeValue(folder, prefix, ".exr", image, exrBytes);
}

void requireInUnitSquare(const CornerUvs& uvs, std::size_t triangles, const std::string& name) {
  if (uvs.size() != triangles)
    throw FileError(name, 0,
                    "has " + std::to_string(uvs.size()) +
                        " faces with texture coordinates, the "
                        "mesh " +
                        std::to_string(triangles));
  for (const auto& corners : uvs)
    for (const Vec2& uv : corners)
      if (!(uv.minCoeff() >= 0 && uv.maxCoeff() <= 1))
        throw FileError(name, 0, "a texture coordinate lies outside the unit square");
}

std::optional<ManifestLayout> storeLayout(const TextureLayout& layout, const TriangleMesh& mesh,
                                          const std::string& prefix, const fs::path& folder) {
  if (!layout.uvs) return std::nullopt;
  // The reader rejects such coordinates, so they must not be stored.
  requireInUnitSquare(*layout.uvs, mesh.triangles.size(), prefix);
  ManifestLayout stored{layout.generated, layout.charts, {}};
  if (*layout.uvs == mesh.corner_uvs) return stored;
  stored.file = storeValue(folder, prefix, ".ply", layout.uvs, [&](const CornerUvs& uvs) {
    return plyBytes({mesh.positions, mesh.triangles, uvs});
  });
  return stored;
}

std::optional<ManifestPaint> storePaint(const SceneObject& object, const fs::path& folder) {
  if (!object.paint) return std::nullopt;
  const ObjectPaint& paint = *object.paint;
  const std::string prefix = "paint/" + object.name;
  ManifestPaint stored;
  stored.layout = storeLayout(paint.layout, *object.mesh, prefix + "-layout", folder);
  stored.color = storeImage(paint.color, prefix + "-color", folder);
  stored.relief = storeImage(paint.relief, prefix + "-relief", folder);
  if (paint.material)
    stored.material =
        storeValue(folder, prefix + "-material", ".material", paint.material, materialBytes);
  if (paint.textures)
    stored.textures =
        storeValue(folder, prefix + "-textures", ".json", paint.textures, laidTexturesText);
  return stored;
}

TextureLayout loadLayout(const ManifestLayout& stored, const ContentFile& mesh_file,
                         const TriangleMesh& mesh, const fs::path& folder) {
  TextureLayout layout{nullptr, stored.generated, stored.charts};
  if (stored.file) {
    layout.uvs = loadValue<CornerUvs>(folder, *stored.file,
                                      [](const std::string& bytes, const std::string& name) {
                                        return parsePly(bytes, name).corner_uvs;
                                      });
  } else {
    layout.uvs = std::make_shared<const CornerUvs>(mesh.corner_uvs);
  }
  requireInUnitSquare(*layout.uvs, mesh.triangles.size(),
                      (folder / (stored.file ? stored.file->path : mesh_file.path)).string());
  return layout;
}

std::shared_ptr<const TiledImage> loadImage(const ContentFile& file, int channels,
                                            const fs::path& folder) {
  auto image =
      loadValue<TiledImage>(folder, file, [&](const std::string& bytes, const std::string& name) {
        return parseExr(bytes, channels, name);
      });
  // A cached image may have been read with other channels.
  if (image->channels() != channels)
    throw FileError((folder / file.path).string(), 0, "has another number of channels");
  return image;
}

// Reads each part separately, so that a damaged one does not affect the others.
std::shared_ptr<const ObjectPaint> loadPaint(const ManifestObject& object, const TriangleMesh& mesh,
                                             const fs::path& folder,
                                             std::vector<std::string>* notes) {
  ObjectPaint paint;
  const auto part = [&](const char* what, const auto& load) {
    if (!notes) return load();
    try {
      load();
    } catch (const Error& error) {
      notes->push_back(object.name + ": its " + what + " is left out: " + error.what());
    }
  };
  const ManifestPaint& stored = *object.paint;
  if (stored.layout)
    part("texture layout",
         [&] { paint.layout = loadLayout(*stored.layout, object.mesh, mesh, folder); });
  const bool images = !notes || paint.layout.uvs;
  if (stored.color && images)
    part("colour", [&] { paint.color = loadImage(*stored.color, kColorChannels, folder); });
  if (stored.relief && images)
    part("relief", [&] { paint.relief = loadImage(*stored.relief, 1, folder); });
  if (stored.material)
    part("material",
         [&] { paint.material = loadValue<MaterialMap>(folder, *stored.material, parseMaterial); });
  if (stored.textures)
    part("textures", [&] {
      paint.textures = loadValue<TextureMappings>(folder, *stored.textures, parseLaidTextures);
      validate(*paint.textures, mesh.triangles.size());
    });
  return std::make_shared<const ObjectPaint>(std::move(paint));
}

SceneObject loadObject(const ManifestObject& stored, const fs::path& folder,
                       std::vector<std::string>* notes) {
  SceneObject object{stored.name, nullptr, stored.world_from_object, nullptr};
  object.mesh = loadValue<TriangleMesh>(
      folder, stored.mesh,
      [](const std::string& bytes, const std::string& name) { return parsePly(bytes, name); });
  if (stored.paint) object.paint = loadPaint(stored, *object.mesh, folder, notes);
  return object;
}

ManifestScan storeScan(const SceneScan& scan, const fs::path& folder) {
  ManifestScan stored;
  stored.name = scan.name;
  for (const auto& [name, text] : scan.files) {
    const fs::path file(name);
    stored.files[name] =
        storeValue(folder, "scans/" + scan.name + "-" + file.stem().string(),
                   file.extension().string(), text, [](const std::string& bytes) { return bytes; });
  }
  // A relative path stays valid if both folders are moved together.
  if (!scan.folder.empty())
    stored.folder =
        scan.folder.lexically_relative(fs::absolute(folder).lexically_normal()).string();
  stored.frames = scan.frames;
  return stored;
}

SceneScan loadScan(const ManifestScan& stored, const fs::path& folder) {
  SceneScan scan;
  scan.name = stored.name;
  for (const auto& [name, file] : stored.files)
    scan.files[name] = loadValue<std::string>(
        folder, file, [](const std::string& bytes, const std::string&) { return bytes; });
  if (!stored.folder.empty()) scan.folder = fs::absolute(folder / stored.folder).lexically_normal();
  scan.frames = stored.frames;
  return scan;
}

bool isSameMesh(const TriangleMesh& a, const TriangleMesh& b) {
  return &a == &b ||
         (a.positions == b.positions && a.triangles == b.triangles && a.corner_uvs == b.corner_uvs);
}

// File of an earlier object with the same mesh.
std::optional<ContentFile> fileOfEqual(const Scene& scene, const Manifest& manifest) {
  const TriangleMesh& mesh = *scene.objects[manifest.objects.size()].mesh;
  for (std::size_t i = 0; i < manifest.objects.size(); ++i)
    if (isSameMesh(*scene.objects[i].mesh, mesh)) return manifest.objects[i].mesh;
  return std::nullopt;
}

} // namespace

Manifest storeObjects(const Scene& scene, const fs::path& folder) {
  Manifest manifest;
  manifest.values = scene;
  manifest.values.objects.clear();
  manifest.values.scans.clear();
  for (const SceneScan& scan : scene.scans) manifest.scans.push_back(storeScan(scan, folder));
  for (const SceneObject& object : scene.objects) {
    ManifestObject stored;
    stored.name = object.name;
    stored.world_from_object = object.world_from_object;
    const auto equal = fileOfEqual(scene, manifest);
    stored.mesh =
        equal ? *equal : storeValue(folder, "meshes/" + object.name, ".ply", object.mesh, plyBytes);
    stored.paint = storePaint(object, folder);
    manifest.objects.push_back(std::move(stored));
  }
  return manifest;
}

Scene loadScene(const Manifest& manifest, const fs::path& folder, const std::string& name,
                std::vector<std::string>* notes) {
  Scene scene = manifest.values;
  for (const ManifestObject& object : manifest.objects) {
    const std::size_t whole = scene.objects.size();
    try {
      scene.objects.push_back(loadObject(object, folder, notes));
      if (notes) validate(scene);
    } catch (const Error& error) {
      if (!notes) throw;
      scene.objects.resize(whole);
      notes->push_back(object.name + " is left out: " + error.what());
    }
  }
  for (const ManifestScan& scan : manifest.scans) {
    const std::size_t whole = scene.scans.size();
    try {
      scene.scans.push_back(loadScan(scan, folder));
      if (notes) validate(scene.scans);
    } catch (const Error& error) {
      if (!notes) throw;
      scene.scans.resize(whole);
      notes->push_back("scan " + scan.name + " is left out: " + error.what());
    }
  }
  try {
    validate(scene);
  } catch (const Error& error) {
    throw FileError(name, 0, error.what());
  }
  return scene;
}

} // namespace patina
