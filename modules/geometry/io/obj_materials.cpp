#include "geometry/io/obj_materials.h"

#include <algorithm>
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

// Returns the text after the options of a map statement, such as `-s 2 2 1 -clamp on`.
std::string_view withoutMapOptions(std::string_view rest) {
  while (rest.starts_with('-')) {
    text::Words words(rest);
    const std::string_view option = words.next();
    const bool vector = option == "-o" || option == "-s" || option == "-t";
    const int arguments = vector ? 3 : option == "-mm" ? 2 : 1;
    std::string_view last = option;
    for (int i = 0; i < arguments; ++i) {
      const std::string_view word = words.next();
      if (word.empty() || (vector && i > 0 && !parseNumber(word))) break;
      last = word;
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

} // namespace

void ObjMaterials::addStatement(std::string_view keyword, std::string_view statement) {
  text::Words words(statement);
  const std::string rest(after(statement, words.next()));
  if (rest.empty()) return;
  std::vector<std::string>& list = keyword == "mtllib" ? libraries : used;
  if (list.empty() || list.back() != rest) list.push_back(rest);
}

std::vector<MtlMaterial> parseMtl(std::string_view bytes) {
  std::vector<MtlMaterial> materials;
  text::Lines lines(withoutByteOrderMark(bytes));
  std::string_view line;
  while (lines.next(line)) {
    text::Words words(line);
    const std::string_view keyword = words.next();
    if (text::equalIgnoringCase(keyword, "newmtl"))
      materials.push_back({std::string(after(line, keyword)), {}, {}});
    if (materials.empty()) continue;
    MtlMaterial& material = materials.back();
    if (text::equalIgnoringCase(keyword, "map_Kd")) {
      material.picture = withoutMapOptions(after(line, keyword));
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

void addMaterialWarnings(const ObjMaterials& materials, const std::filesystem::path& path,
                         const TriangleMesh& mesh, std::vector<std::string>& warnings) {
  std::vector<MtlMaterial> known;
  for (const std::string& written : materials.libraries)
    for (const std::string& name : librariesOf(written, path)) {
      try {
        const std::filesystem::path file = besideFile(path, name);
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(file, ignored))
          throw FileError(file.string(), 0, "no file");
        const std::vector<MtlMaterial> read = parseMtl(readFile(file));
        known.insert(known.end(), read.begin(), read.end());
      } catch (const FileError&) {
        warnings.push_back("the materials " + text::quoted(name, 200) +
                           " cannot be read: their colours and pictures are left out");
      }
    }
  const std::set<std::string> used(materials.used.begin(), materials.used.end());
  std::vector<const MtlMaterial*> seen;
  std::vector<std::string> pictures;
  for (const MtlMaterial& material : known) {
    if (!used.empty() && used.count(material.name) == 0) continue;
    seen.push_back(&material);
    if (!material.picture.empty() &&
        std::find(pictures.begin(), pictures.end(), material.picture) == pictures.end())
      pictures.push_back(material.picture);
  }
  if (!pictures.empty())
    warnings.push_back(picturesLeftOut(path, "map_Kd", pictures, !mesh.corner_uvs.empty()));
  if (hasColors(seen)) warnings.push_back(text::colorsLeftOut("materials"));
}

} // namespace patina
