#include <charconv>
#include <cstring>
#include <stdexcept>

#include "core/error.h"
#include "core/file.h"
#include "geometry/io/textured_obj.h"
#include "geometry/mesh/vertex_weld.h"

namespace patina {
namespace {

template <typename Number> void appendNumber(std::string& out, char before, Number value) {
  std::array<char, 32> text{before};
  const auto result = std::to_chars(text.data() + 1, text.data() + text.size(), value);
  out.append(text.data(), result.ptr);
}

template <typename T> void appendBytes(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string objText(const TriangleMesh& mesh) {
  std::string out;
  out.reserve(mesh.positions.size() * 64 + mesh.triangles.size() * 32);
  for (const Vec3& p : mesh.positions) {
    out += 'v';
    for (int k = 0; k < 3; ++k) appendNumber(out, ' ', p[k]);
    out += '\n';
  }
  // Corners that share a texture point share its line.
  VertexWeld weld(mesh.corner_uvs.size());
  std::vector<Triangle> texture;
  for (const auto& uvs : mesh.corner_uvs) {
    Triangle& indices = texture.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) indices[k] = weld.index({uvs[k][0], uvs[k][1], 0});
  }
  for (const Vec3& uv : weld.points()) {
    out += "vt";
    for (int k = 0; k < 2; ++k) appendNumber(out, ' ', uv[k]);
    out += '\n';
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    out += 'f';
    for (std::size_t k = 0; k < 3; ++k) {
      appendNumber(out, ' ', mesh.triangles[t][k] + 1);
      if (!texture.empty()) appendNumber(out, '/', texture[t][k] + 1);
    }
    out += '\n';
  }
  return out;
}

std::string stlBytes(const TriangleMesh& mesh) {
  std::string out(80, ' ');
  constexpr std::string_view kTitle = "binary STL"; // must not begin with "solid"
  out.replace(0, kTitle.size(), kTitle);
  out.reserve(84 + 50 * mesh.triangles.size());
  appendBytes(out, static_cast<std::uint32_t>(mesh.triangles.size()));
  const auto appendVector = [&](const Vec3& v) {
    for (int k = 0; k < 3; ++k) appendBytes(out, static_cast<float>(v[k]));
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    appendVector(faceNormal(mesh, t));
    for (int k = 0; k < 3; ++k) appendVector(mesh.corner(t, k));
    appendBytes(out, std::uint16_t{0});
  }
  return out;
}

} // namespace

std::string plyBytes(const TriangleMesh& mesh) {
  const bool textured = !mesh.corner_uvs.empty();
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                    std::to_string(mesh.positions.size()) +
                    "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                    std::to_string(mesh.triangles.size()) +
                    "\nproperty list uchar int vertex_indices\n" +
                    (textured ? "property list uchar double texcoord\n" : "") + "end_header\n";
  out.reserve(out.size() + mesh.positions.size() * 24 +
              mesh.triangles.size() * (textured ? 62 : 13));
  for (const Vec3& p : mesh.positions)
    for (int k = 0; k < 3; ++k) appendBytes(out, p[k]);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    appendBytes(out, std::uint8_t{3});
    for (const std::int32_t v : mesh.triangles[t]) appendBytes(out, v);
    if (!textured) continue;
    appendBytes(out, std::uint8_t{6});
    for (const Vec2& uv : mesh.corner_uvs[t])
      for (int k = 0; k < 2; ++k) appendBytes(out, uv[k]);
  }
  return out;
}

void writeTexturedObj(const std::filesystem::path& path, const TriangleMesh& mesh,
                      const std::vector<TexturedFace>& textured) {
  if (meshFileType(path) != MeshFileType::obj)
    throw FileError(path.string(), 0, "only an .obj holds haptic coordinates");
  std::string out = objText(mesh);
  auto next = textured.begin();
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    out += 'h';
    if (next == textured.end() || static_cast<std::size_t>(next->face) != f) {
      out += " -1 0 0 0 0 0 0\n";
      continue;
    }
    appendNumber(out, ' ', next->texture);
    for (const Vec2& corner : next->coords)
      for (int k = 0; k < 2; ++k) appendNumber(out, ' ', corner[k]);
    out += '\n';
    ++next;
  }
  if (next != textured.end())
    throw std::invalid_argument("writeTexturedObj: faces out of order, or not of the mesh");
  writeFileAtomically(path, out);
}

void writeMesh(const std::filesystem::path& path, const TriangleMesh& mesh) {
  switch (meshFileType(path)) {
  case MeshFileType::obj:
    writeFileAtomically(path, objText(mesh));
    return;
  case MeshFileType::ply:
    writeFileAtomically(path, plyBytes(mesh));
    return;
  case MeshFileType::stl:
    writeFileAtomically(path, stlBytes(mesh));
    return;
  }
}

void writeMeshIn(const std::filesystem::path& path, TriangleMesh mesh, MeshUnit unit) {
  const double scale = inMetres({}, unit).scale;
  for (Vec3& position : mesh.positions) position /= scale;
  writeMesh(path, mesh);
}

} // namespace patina
