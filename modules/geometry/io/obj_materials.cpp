#include "geometry/io/obj_materials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "core/utf8.h"
#include "geometry/io/text_scan.h"

namespace patina {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// Returns the text after a word of `line`; the word must be a view into it.
std::string_view after(std::string_view line, std::string_view word) {
  return trimmed(line.substr(static_cast<std::size_t>(word.data() + word.size() - line.data())));
}

std::optional<double> finiteNumber(std::string_view word) {
  const auto number = parseNumber(word);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

// Returns the text up to " #", which may begin a comment.
std::string withoutComment(const std::string& text) {
  const std::size_t at = text.find(" #");
  return at == text.npos ? text : std::string(trimmed(text.substr(0, at)));
}

// Returns the text after the options of a map statement, such as `-s 2 2 1 -clamp on`, and stores
// the options that place the picture.
std::string_view withoutMapOptions(std::string_view rest, MeshPicture& mapped) {
  while (rest.starts_with('-')) {
    text::Words words(rest);
    const std::string_view option = words.next();
    const bool vector = option == "-o" || option == "-s" || option == "-t";
    const int arguments = vector ? 3 : option == "-mm" ? 2 : 1;
    std::string_view last = option;
    for (int i = 0; i < arguments; ++i) {
      const std::string_view word = words.next();
      const auto number = finiteNumber(word);
      if (word.empty() || (vector && i > 0 && !number)) break;
      last = word;
      if (option == "-s" && number && i < 2) mapped.scale[i] = *number;
      if (option == "-o" && number && i < 2) mapped.offset[i] = *number;
      if (option == "-clamp") mapped.repeats = !text::equalIgnoringCase(word, "on");
    }
    const std::string_view left = after(rest, last);
    if (left.empty()) return rest; // a file whose name begins with a dash
    rest = left;
  }
  return rest;
}

// Returns true for two or more colours, or for one that is not grey. Colours beneath pictures that
// are shown do not count.
bool hasColors(const std::set<const MtlMaterial*>& materials, bool shows_pictures) {
  std::set<std::vector<double>> colors;
  for (const MtlMaterial* material : materials)
    if (!material->color.empty() && (material->picture.empty() || !shows_pictures))
      colors.insert(material->color);
  if (colors.size() != 1) return !colors.empty();
  const std::vector<double>& c = *colors.begin();
  return c[0] != c[1] || c[1] != c[2];
}

// Splits the argument of mtllib, which is one name with blanks or several names.
std::vector<std::string> librariesOf(const std::string& written,
                                     const std::filesystem::path& path) {
  if (std::error_code ignored; std::filesystem::exists(besideFile(path, written), ignored))
    return {written};
  const std::string bare = withoutComment(written);
  if (bare != written) return librariesOf(bare, path);
  std::vector<std::string> names;
  text::Words words(written);
  for (std::string_view word = words.next(); !word.empty(); word = words.next())
    names.emplace_back(word);
  return names;
}

using Library = std::map<std::string, MtlMaterial>; // key: name; the first of equal names counts

// Returns "'first'" or "'first' and 3 more".
std::string firstOf(const std::set<std::string>& names) {
  const std::string first = text::quoted(*names.begin(), 200);
  return names.size() == 1 ? first : first + " and " + formatCount(names.size() - 1) + " more";
}

Library readLibraries(const ObjMaterials& materials, const std::filesystem::path& path,
                      std::vector<std::string>& warnings) {
  Library library;
  std::set<std::string> read, lost;
  for (const std::string& written : materials.libraries)
    for (const std::string& name : librariesOf(written, path)) {
      if (!read.insert(name).second) continue;
      try {
        const std::filesystem::path file = besideFile(path, name);
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(file, ignored))
          throw FileError(file.string(), 0, "no file");
        for (MtlMaterial& material : parseMtl(readFile(file))) {
          material.library = file;
          library.emplace(material.name, std::move(material));
        }
      } catch (const FileError&) {
        lost.insert(name);
      }
    }
  if (!lost.empty())
    warnings.push_back("the materials " + firstOf(lost) +
                       " cannot be read: their colours and pictures are left out");
  return library;
}

const MtlMaterial* materialOf(const Library& library, const std::string& name) {
  auto found = library.find(name);
  if (found == library.end()) found = library.find(withoutComment(name));
  return found == library.end() ? nullptr : &found->second;
}

std::filesystem::path pictureFile(const MtlMaterial& material, const std::filesystem::path& path) {
  const std::filesystem::path file = besideFile(material.library, material.picture);
  std::error_code ignored;
  return std::filesystem::exists(file, ignored) ? file : besideFile(path, material.picture);
}

// Gives each triangle the colour and the picture of the material that is used for it.
void keepMaterials(const ObjMaterials& materials, const Library& library,
                   const std::filesystem::path& path, bool mapped, std::size_t triangles,
                   MeshColors& colors) {
  colors.faces.assign(triangles, Rgba{});
  if (mapped) colors.picture_of.assign(triangles, -1);
  std::map<const MtlMaterial*, std::int32_t> known; // index of its picture
  for (std::size_t i = 0; i < materials.uses.size(); ++i) {
    const ObjMaterials::Use& use = materials.uses[i];
    const std::size_t end =
        i + 1 < materials.uses.size() ? materials.uses[i + 1].first_triangle : triangles;
    const MtlMaterial* named = materialOf(library, use.name);
    if (!named || use.first_triangle == end) continue;
    const MtlMaterial& material = *named;
    const auto first = static_cast<std::ptrdiff_t>(use.first_triangle);
    const auto last = static_cast<std::ptrdiff_t>(end);
    Rgba color{1, 1, 1, 1};
    for (std::size_t k = 0; k < material.color.size(); ++k)
      color[k] = static_cast<float>(std::clamp(material.color[k], 0.0, 1.0));
    if (!material.color.empty() || !material.picture.empty())
      std::fill(colors.faces.begin() + first, colors.faces.begin() + last, color);
    if (!mapped || material.picture.empty()) continue;
    const auto [picture, is_new] =
        known.emplace(named, static_cast<std::int32_t>(colors.pictures.size()));
    if (is_new) {
      MeshPicture& kept = colors.pictures.emplace_back(material.mapped);
      kept.file = pictureFile(material, path);
    }
    std::fill(colors.picture_of.begin() + first, colors.picture_of.begin() + last, picture->second);
  }
}

} // namespace

void ObjMaterials::addStatement(std::string_view keyword, std::string_view statement,
                                std::size_t triangles) {
  text::Words words(statement);
  std::string rest(after(statement, words.next()));
  if (keyword == "usemtl")
    uses.push_back({triangles, std::move(rest)});
  else if (!rest.empty() && (libraries.empty() || libraries.back() != rest))
    libraries.push_back(std::move(rest));
}

std::vector<MtlMaterial> parseMtl(std::string_view bytes) {
  std::vector<MtlMaterial> materials;
  text::Lines lines(withoutByteOrderMark(bytes));
  std::string_view line;
  while (lines.next(line)) {
    text::Words words(line);
    const std::string_view keyword = words.next();
    if (text::equalIgnoringCase(keyword, "newmtl"))
      materials.emplace_back().name = after(line, keyword);
    if (materials.empty()) continue;
    MtlMaterial& material = materials.back();
    if (text::equalIgnoringCase(keyword, "map_Kd")) {
      material.mapped = {};
      material.picture = withoutMapOptions(after(line, keyword), material.mapped);
    } else if (text::equalIgnoringCase(keyword, "Kd")) {
      std::vector<double> color;
      for (int k = 0; k < 3; ++k)
        if (const auto value = finiteNumber(words.next())) color.push_back(*value);
      if (color.size() == 1) color.assign(3, color[0]); // grey
      if (color.size() == 3) material.color = color;
    } else if (text::equalIgnoringCase(keyword, "d") || text::equalIgnoringCase(keyword, "Tr")) {
      const auto value = finiteNumber(words.next());
      const bool solid = value && *value == (keyword.size() == 1 ? 1 : 0);
      material.is_transparent = value && !solid;
    }
  }
  return materials;
}

std::filesystem::path besideFile(const std::filesystem::path& from, const std::string& written) {
  std::string name = written;
  if (name.size() > 1 && name.front() == '"' && name.back() == '"')
    name = name.substr(1, name.size() - 2);
  std::error_code ignored;
  const std::filesystem::path folder = from.parent_path();
  if (std::filesystem::exists(folder / name, ignored)) return folder / name;
  std::replace(name.begin(), name.end(), '\\', '/');
  if (std::filesystem::exists(folder / name, ignored)) return folder / name;
  const std::filesystem::path bare = folder / std::filesystem::path(name).filename();
  return std::filesystem::exists(bare, ignored) ? bare : folder / name;
}

std::string picturesLeftOut(const std::set<std::string>& pictures, bool mapped) {
  return std::string(pictures.size() == 1 ? "a picture is" : "pictures are") + " left out, " +
         firstOf(pictures) +
         (mapped ? ": only the surface is read here"
                 : ": the mesh has no texture coordinates that are kept");
}

void readMaterials(const ObjMaterials& materials, const std::filesystem::path& path,
                   const TriangleMesh& mesh, MeshColors* colors,
                   std::vector<std::string>* warnings) {
  if (!colors && !warnings) return;
  std::vector<std::string> lost;
  const Library library = readLibraries(materials, path, lost);
  std::set<std::string> unknown;
  std::set<const MtlMaterial*> seen;
  for (const ObjMaterials::Use& use : materials.uses) {
    if (const MtlMaterial* material = materialOf(library, use.name))
      seen.insert(material);
    else if (!use.name.empty())
      unknown.insert(use.name);
  }
  if (materials.uses.empty())
    for (const auto& [name, material] : library) seen.insert(&material);
  std::set<std::string> pictures;
  bool is_transparent = false;
  for (const MtlMaterial* material : seen) {
    if (!material->picture.empty()) pictures.insert(material->picture);
    is_transparent = is_transparent || material->is_transparent;
  }

  const bool mapped = mesh.corner_uvs.size() == mesh.triangles.size();
  const bool keeps = colors && !materials.uses.empty();
  const bool colored = hasColors(seen, mapped);
  if (keeps && (colored || (mapped && !pictures.empty())))
    keepMaterials(materials, library, path, mapped, mesh.triangles.size(), *colors);
  if (!pictures.empty() && !(keeps && mapped)) lost.push_back(picturesLeftOut(pictures, mapped));
  if (!keeps && colored) lost.push_back(text::colorsLeftOut("materials"));
  if (keeps && is_transparent) lost.push_back(text::kOpaque);
  if (!unknown.empty() && !library.empty())
    lost.push_back("no library of the mesh has the material " + firstOf(unknown) +
                   ": its faces have no colour");
  if (warnings) warnings->insert(warnings->end(), lost.begin(), lost.end());
}

} // namespace patina
