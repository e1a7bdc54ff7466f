#include "geometry/io/obj_materials.h"

#include <algorithm>
#include <map>
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

// Returns the text after the options of a map statement, such as `-s 2 2 1 -clamp on`, and notes
// those that say where the picture lies.
std::string_view withoutMapOptions(std::string_view rest, MeshPicture& mapped) {
  while (rest.starts_with('-')) {
    text::Words words(rest);
    const std::string_view option = words.next();
    const bool vector = option == "-o" || option == "-s" || option == "-t";
    const int arguments = vector ? 3 : option == "-mm" ? 2 : 1;
    std::string_view last = option;
    for (int i = 0; i < arguments; ++i) {
      const std::string_view word = words.next();
      const auto number = parseNumber(word);
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

// Returns true for two or more colours, or for one that is not grey.
bool hasColors(const std::vector<const MtlMaterial*>& materials) {
  std::set<std::vector<double>> colors;
  for (const MtlMaterial* material : materials)
    if (material->picture.empty() && !material->color.empty()) colors.insert(material->color);
  if (colors.size() != 1) return !colors.empty();
  const std::vector<double>& c = *colors.begin();
  return c[0] != c[1] || c[1] != c[2];
}

// Splits the argument of mtllib, which is one name with blanks or several names.
std::vector<std::string> librariesOf(const std::string& written,
                                     const std::filesystem::path& path) {
  if (std::error_code ignored; std::filesystem::exists(besideFile(path, written), ignored))
    return {written};
  std::vector<std::string> names;
  text::Words words(written);
  for (std::string_view word = words.next(); !word.empty(); word = words.next())
    names.emplace_back(word);
  return names;
}

using Library = std::map<std::string, MtlMaterial>; // by name; of two alike the first

Library readLibraries(const ObjMaterials& materials, const std::filesystem::path& path,
                      std::vector<std::string>& warnings) {
  Library library;
  for (const std::string& written : materials.libraries)
    for (const std::string& name : librariesOf(written, path)) {
      try {
        const std::filesystem::path file = besideFile(path, name);
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(file, ignored))
          throw FileError(file.string(), 0, "no file");
        for (MtlMaterial& material : parseMtl(readFile(file)))
          library.emplace(material.name, std::move(material));
      } catch (const FileError&) {
        warnings.push_back("the materials " + text::quoted(name, 200) +
                           " cannot be read: their colours and pictures are left out");
      }
    }
  return library;
}

// Gives each triangle the colour and the picture of the material that is used for it.
void keepMaterials(const ObjMaterials& materials, const Library& library,
                   const std::filesystem::path& path, bool mapped, std::size_t triangles,
                   MeshColors& colors) {
  colors.faces.assign(triangles, Rgba{});
  if (mapped) colors.picture_of.assign(triangles, -1);
  std::map<std::string, std::int32_t> known; // material -> its picture
  for (std::size_t i = 0; i < materials.uses.size(); ++i) {
    const ObjMaterials::Use& use = materials.uses[i];
    const std::size_t end =
        i + 1 < materials.uses.size() ? materials.uses[i + 1].first_triangle : triangles;
    const auto found = library.find(use.name);
    if (found == library.end() || use.first_triangle == end) continue;
    const MtlMaterial& material = found->second;
    const auto first = static_cast<std::ptrdiff_t>(use.first_triangle);
    const auto last = static_cast<std::ptrdiff_t>(end);
    Rgba color{1, 1, 1, 1};
    for (std::size_t k = 0; k < material.color.size(); ++k)
      color[k] = static_cast<float>(std::clamp(material.color[k], 0.0, 1.0));
    if (!material.color.empty() || !material.picture.empty())
      std::fill(colors.faces.begin() + first, colors.faces.begin() + last, color);
    if (!mapped || material.picture.empty()) continue;
    const auto [picture, is_new] =
        known.emplace(use.name, static_cast<std::int32_t>(colors.pictures.size()));
    if (is_new) {
      MeshPicture& kept = colors.pictures.emplace_back(material.mapped);
      kept.file = besideFile(path, material.picture);
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
      materials.push_back({std::string(after(line, keyword)), {}, {}, {}});
    if (materials.empty()) continue;
    MtlMaterial& material = materials.back();
    if (text::equalIgnoringCase(keyword, "map_Kd")) {
      material.mapped = {};
      material.picture = withoutMapOptions(after(line, keyword), material.mapped);
    } else if (text::equalIgnoringCase(keyword, "Kd")) {
      std::vector<double> color;
      for (int k = 0; k < 3; ++k)
        if (const auto value = parseNumber(words.next())) color.push_back(*value);
      if (color.size() == 3) material.color = color;
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

std::string picturesLeftOut(const std::filesystem::path& path, const std::string& keyword,
                            const std::vector<std::string>& pictures,
                            bool has_texture_coordinates) {
  constexpr std::size_t kShown = 3;
  const bool one = pictures.size() == 1;
  std::string names;
  for (std::size_t i = 0; i < std::min(pictures.size(), kShown); ++i)
    names += (i == 0 ? "" : ", ") + text::shown(pictures[i]);
  if (pictures.size() > kShown) names += ", ...";
  const std::string what =
      one ? "the picture of " + keyword + " " + names + " is not shown"
          : formatCount(pictures.size()) + " pictures of " + keyword + " are not shown: " + names;
  if (!has_texture_coordinates) return what + "; the mesh has no texture coordinates that are kept";
  const std::filesystem::path file = besideFile(path, pictures.front());
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    return what + "; " + (one ? "it" : "the first") + " is not beside the mesh";
  return what + "; patina scene -o WORKSPACE --image " + text::shown(path.stem().string()) + "=" +
         text::shown(file.string()) + ",color,mapped shows " + (one ? "it" : "the first");
}

void readMaterials(const ObjMaterials& materials, const std::filesystem::path& path,
                   const TriangleMesh& mesh, MeshColors* colors,
                   std::vector<std::string>* warnings) {
  if (!colors && !warnings) return;
  std::vector<std::string> lost;
  const Library library = readLibraries(materials, path, lost);
  std::set<std::string> unknown;
  std::vector<const MtlMaterial*> seen;
  std::vector<std::string> pictures;
  const auto see = [&](const MtlMaterial& material) {
    if (std::find(seen.begin(), seen.end(), &material) != seen.end()) return;
    seen.push_back(&material);
    if (!material.picture.empty() &&
        std::find(pictures.begin(), pictures.end(), material.picture) == pictures.end())
      pictures.push_back(material.picture);
  };
  for (const ObjMaterials::Use& use : materials.uses) {
    const auto found = library.find(use.name);
    if (found != library.end())
      see(found->second);
    else if (!use.name.empty())
      unknown.insert(use.name);
  }
  if (materials.uses.empty())
    for (const auto& [name, material] : library) see(material);

  const bool mapped = mesh.corner_uvs.size() == mesh.triangles.size();
  const bool keeps = colors && !materials.uses.empty();
  if (keeps && (hasColors(seen) || (mapped && !pictures.empty())))
    keepMaterials(materials, library, path, mapped, mesh.triangles.size(), *colors);
  if (!pictures.empty() && !(keeps && mapped))
    lost.push_back(picturesLeftOut(path, "map_Kd", pictures, mapped));
  if (!keeps && hasColors(seen)) lost.push_back(text::colorsLeftOut("materials"));
  if (!unknown.empty() && !library.empty())
    lost.push_back("the material " + text::quoted(*unknown.begin(), 200) +
                   (unknown.size() > 1 ? " and " + formatCount(unknown.size() - 1) + " more are"
                                       : std::string(" is")) +
                   " in no library of the mesh: their faces have no colour");
  if (warnings) warnings->insert(warnings->end(), lost.begin(), lost.end());
}

} // namespace patina
