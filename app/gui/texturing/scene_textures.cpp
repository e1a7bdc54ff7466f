#include "app/gui/texturing/scene_textures.h"

#include <algorithm>
#include <map>

namespace patina {
namespace {

const TextureMappings* texturesOn(const SceneObject& object) {
  return object.paint ? object.paint->textures.get() : nullptr;
}

void setTextures(SceneObject& object, TextureMappings laid) {
  ObjectPaint paint = object.paint ? *object.paint : ObjectPaint();
  paint.textures =
      laid.faces.empty() ? nullptr : std::make_shared<const TextureMappings>(std::move(laid));
  object.paint = std::make_shared<const ObjectPaint>(std::move(paint));
}

// Calls edit(textures) for each object that has some, and keeps the changes if it returns true.
template <typename Edit> Scene withEdited(const Scene& scene, const Edit& edit) {
  Scene made = scene;
  for (SceneObject& object : made.objects) {
    const TextureMappings* before = texturesOn(object);
    if (before == nullptr) continue;
    TextureMappings laid = *before;
    if (edit(laid)) setTextures(object, std::move(laid));
  }
  return made;
}

} // namespace

std::vector<TextureRow> texturesOf(const Scene& scene, const std::vector<TextureRow>& read) {
  std::map<std::int32_t, TextureRow> rows;
  for (const SceneObject& object : scene.objects) {
    const TextureMappings* laid = texturesOn(object);
    if (laid == nullptr) continue;
    for (const TexturedFace& face : laid->faces) {
      TextureRow& row = rows[face.texture];
      row.number = face.texture;
      ++row.faces;
      const auto known = laid->library.find(face.texture);
      if (known != laid->library.end()) row.texture = known->second;
    }
  }
  for (const TextureRow& row : read) rows.try_emplace(row.number, row);
  std::vector<TextureRow> list;
  for (const auto& [number, row] : rows) list.push_back(row);
  return list;
}

std::int32_t freeNumber(const std::vector<TextureRow>& rows) {
  std::int32_t number = 1;
  for (const TextureRow& row : rows) number = std::max(number, row.number + 1);
  return number;
}

Scene withLaid(const Scene& scene, std::size_t object, const std::vector<PathOnMesh>& strokes,
               const TextureRow& row, int rings, const Progress& progress) {
  Scene made = scene;
  SceneObject& on = made.objects.at(object);
  LayOptions options;
  options.texture = row.number;
  options.rings = rings;
  const MappedTexture laid = layScanTexture(*on.mesh, strokes, options, progress);
  const TextureMappings* before = texturesOn(on);
  TextureMappings merged = before ? *before : TextureMappings();
  merged.faces = laidOver(laid.faces, merged.faces);
  merged.library[row.number] = row.texture;
  setTextures(on, std::move(merged));
  return made;
}

Scene withSwapped(const Scene& scene, std::int32_t number,
                  std::shared_ptr<const HapticTexture> texture) {
  return withEdited(scene, [&](TextureMappings& laid) {
    const bool lies = std::any_of(laid.faces.begin(), laid.faces.end(),
                                  [&](const TexturedFace& face) { return face.texture == number; });
    if (lies) laid.library[number] = texture;
    return lies;
  });
}

Scene withoutTexture(const Scene& scene, std::int32_t number) {
  return withEdited(scene, [&](TextureMappings& laid) {
    std::erase_if(laid.faces, [&](const TexturedFace& face) { return face.texture == number; });
    laid.library.erase(number);
    return true;
  });
}

TexturedFaces texturedParts(const Scene& scene, std::optional<std::int32_t> number) {
  TriangleMesh all;
  std::vector<bool> has;
  for (const SceneObject& object : scene.objects) {
    const TextureMappings* laid = texturesOn(object);
    if (laid == nullptr) continue;
    const auto first = static_cast<std::int32_t>(all.positions.size());
    for (const Vec3& p : object.mesh->positions)
      all.positions.push_back(object.world_from_object * p);
    std::map<std::int32_t, bool> faces; // A face may have several textures.
    for (const TexturedFace& face : laid->faces)
      faces[face.face] = faces[face.face] || face.texture == number;
    for (const auto& [face, is_meant] : faces) {
      Triangle triangle = object.mesh->triangles[static_cast<std::size_t>(face)];
      for (std::int32_t& corner : triangle) corner += first;
      all.triangles.push_back(triangle);
      has.push_back(is_meant);
    }
  }
  const bool lies = std::find(has.begin(), has.end(), true) != has.end();
  const auto part = [&](bool selected) {
    auto mesh = std::make_shared<TriangleMesh>();
    for (std::size_t i = 0; i < has.size(); ++i)
      if ((has[i] || !lies) == selected) mesh->triangles.push_back(all.triangles[i]);
    if (mesh->triangles.empty()) return std::shared_ptr<const TriangleMesh>();
    mesh->positions = all.positions;
    return std::shared_ptr<const TriangleMesh>(mesh);
  };
  return {part(true), part(false)};
}

} // namespace patina
