#include "app/gui/texturing/texture_edits.h"

#include <algorithm>
#include <map>

#include "scan/scan_texture.h"

namespace patina {
namespace {

const LaidTextures* texturesOn(const SceneObject& object) {
  return object.paint ? object.paint->textures.get() : nullptr;
}

void setTextures(SceneObject& object, LaidTextures laid) {
  ObjectPaint paint = object.paint ? *object.paint : ObjectPaint();
  paint.textures =
      laid.faces.empty() ? nullptr : std::make_shared<const LaidTextures>(std::move(laid));
  object.paint = std::make_shared<const ObjectPaint>(std::move(paint));
}

} // namespace

std::vector<TextureRow> texturesOf(const Scene& scene, const std::vector<TextureRow>& read) {
  std::map<std::int32_t, TextureRow> rows;
  for (const SceneObject& object : scene.objects) {
    const LaidTextures* laid = texturesOn(object);
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
  const LaidTexture laid = layScanTexture(*on.mesh, strokes, options, progress);
  const LaidTextures* before = texturesOn(on);
  LaidTextures merged = before ? *before : LaidTextures();
  merged.faces = laidOver(laid.faces, merged.faces);
  merged.library[row.number] = row.texture;
  setTextures(on, std::move(merged));
  return made;
}

Scene withSwapped(const Scene& scene, std::int32_t number,
                  std::shared_ptr<const FeltTexture> texture) {
  Scene made = scene;
  for (SceneObject& object : made.objects) {
    const LaidTextures* before = texturesOn(object);
    if (before == nullptr ||
        std::none_of(before->faces.begin(), before->faces.end(),
                     [&](const TexturedFace& face) { return face.texture == number; }))
      continue;
    LaidTextures laid = *before;
    laid.library[number] = texture;
    setTextures(object, std::move(laid));
  }
  return made;
}

Scene withoutTexture(const Scene& scene, std::int32_t number) {
  Scene made = scene;
  for (SceneObject& object : made.objects) {
    const LaidTextures* before = texturesOn(object);
    if (before == nullptr) continue;
    LaidTextures laid = *before;
    std::erase_if(laid.faces, [&](const TexturedFace& face) { return face.texture == number; });
    laid.library.erase(number);
    setTextures(object, std::move(laid));
  }
  return made;
}

TexturedParts texturedParts(const Scene& scene, std::optional<std::int32_t> number) {
  TriangleMesh all;
  std::vector<bool> has;
  for (const SceneObject& object : scene.objects) {
    const LaidTextures* laid = texturesOn(object);
    if (laid == nullptr) continue;
    const auto first = static_cast<std::int32_t>(all.positions.size());
    for (const Vec3& p : object.mesh->positions)
      all.positions.push_back(object.world_from_object * p);
    std::map<std::int32_t, bool> faces; // several textures may lie on one
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
  const auto part = [&](bool meant) {
    auto mesh = std::make_shared<TriangleMesh>();
    for (std::size_t i = 0; i < has.size(); ++i)
      if ((has[i] || !lies) == meant) mesh->triangles.push_back(all.triangles[i]);
    if (mesh->triangles.empty()) return std::shared_ptr<const TriangleMesh>();
    mesh->positions = all.positions;
    return std::shared_ptr<const TriangleMesh>(mesh);
  };
  return {part(true), part(false)};
}

} // namespace patina
