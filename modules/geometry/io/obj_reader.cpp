#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "geometry/io/commented_file.h"
#include "geometry/io/obj_materials.h"
#include "geometry/io/text_scan.h"
#include "geometry/io/textured_obj.h"
#include "geometry/mesh/polygon_split.h"

namespace patina {
namespace {

constexpr std::int64_t kMaxIndices = std::numeric_limits<std::int32_t>::max();

class ObjParser {
 public:
  // textured: if not null, receives the lines of haptic coordinates.
  ObjParser(std::string_view bytes, const std::string& name, std::vector<std::string>* warnings,
            MeshColors* colors, std::vector<TexturedFace>* textured = nullptr)
      : name_(name), lines_(withoutByteOrderMark(bytes)), colors_(colors), warnings_(warnings),
        textured_(textured) {}

  TriangleMesh parse() {
    std::string_view statement;
    while (nextStatement(statement)) {
      text::Words words(statement);
      const std::string_view keyword = words.next();
      if (keyword == "v")
        readVertex(words);
      else if (keyword == "f")
        readFace(words);
      else if (keyword == "vt")
        readTexturePoint(words);
      else if (keyword == "vn")
        ++normal_count_;
      else if (textured_ && keyword == "h")
        readHapticCoordinates(words);
      else if (keyword == "mtllib" || keyword == "usemtl")
        materials_.addStatement(keyword, whole_, mesh_.triangles.size());
      else if (text::hasControl(statement))
        fail("binary data where OBJ text should be");
    }
    if (lines_.number() == 0) throw FileError(name_, 1, "the file is empty");
    if (highest_vertex_.index > static_cast<std::int64_t>(mesh_.positions.size()))
      throw FileError(name_, highest_vertex_.line,
                      "the face names vertex " + std::to_string(highest_vertex_.index) +
                          ", but the file has " + std::to_string(mesh_.positions.size()));
    line_ = lines_.number();
    if (mesh_.triangles.empty())
      fail(mesh_.positions.empty() ? "the file ends without a face"
                                   : text::pointCloud(mesh_.positions.size(), "it has no face"));
    if (haptic_lines_ > 0) checkHapticCoordinates();
    texture_points_.countMissing(static_cast<std::int64_t>(texture_.size()));
    normals_.countMissing(normal_count_);
    if (texture_points_.missing == 0 && all_textured_) gatherTexture();
    const PolygonFaults faults = splitPolygons(mesh_, fans_);
    if (warnings_) addWarnings(faults);
    if (colors_ && colored_vertices_ > 0) {
      colors_->vertices.resize(mesh_.positions.size());
      scaleColors(colors_->vertices, 0);
    }
    readMaterials(materials_, name_, mesh_, colors_, warnings_);
    return std::move(mesh_);
  }

 private:
  // An index may refer to a vertex later in the file, so it is checked at the end.
  struct Highest {
    std::int64_t index = 0;
    std::size_t line = 0;
  };
  struct Corner {
    std::int32_t vertex = 0;
    std::int32_t texture = kNone;
  };
  // Indices of normals or texture points, which are no error where they are out of range.
  struct References {
    const char* what = "";
    std::vector<std::int32_t> ahead{}; // indices beyond what the file had so far
    std::size_t missing = 0;
    std::size_t first_line = 0; // line of the first index that is ahead or missing

    void countMissing(std::int64_t count) {
      missing += static_cast<std::size_t>(
          std::count_if(ahead.begin(), ahead.end(), [&](std::int32_t i) { return i >= count; }));
    }
  };

  [[noreturn]] void fail(const std::string& cause) const { throw FileError(name_, line_, cause); }

  // One line without its comment; lines that end in a backslash are joined with the next.
  bool nextStatement(std::string_view& statement) {
    if (!lines_.next(whole_)) return false;
    line_ = lines_.number();
    if (endsInBackslash(whole_)) joinLines();
    statement = whole_.substr(0, whole_.find('#'));
    return true;
  }
  void joinLines() {
    joined_.clear();
    bool more = true;
    while (more && endsInBackslash(whole_)) {
      joined_.append(whole_.substr(0, whole_.size() - 1));
      joined_ += ' ';
      more = lines_.next(whole_);
    }
    if (more) joined_.append(whole_);
    whole_ = joined_;
  }
  static bool endsInBackslash(std::string_view& line) {
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return !line.empty() && line.back() == '\\' && line.find('#') == std::string_view::npos;
  }

  void readVertex(text::Words& words) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = text::number(words.next(), name_, line_, "a coordinate");
    // Reads a weight or a colour, then the transparency that some programs add.
    std::array<double, 3> after{};
    std::size_t more = 0;
    for (auto word = words.next(); !word.empty(); word = words.next(), ++more) {
      const double value = text::number(word, name_, line_, "a number");
      if (more < after.size()) after[more] = value;
    }
    if (more >= 3) addVertexColor(after);
    if (static_cast<std::int64_t>(mesh_.positions.size()) == kMaxIndices)
      fail("more vertices than this program can count");
    mesh_.positions.push_back(p);
  }

  void addVertexColor(const std::array<double, 3>& rgb) {
    ++colored_vertices_;
    if (!colors_) return;
    colors_->vertices.resize(mesh_.positions.size());
    Rgba& color = colors_->vertices.emplace_back(Rgba{0, 0, 0, 1});
    for (std::size_t k = 0; k < 3; ++k) color[k] = static_cast<float>(rgb[k]);
  }

  void readTexturePoint(text::Words& words) {
    Vec2 uv(text::number(words.next(), name_, line_, "a texture coordinate"), 0);
    const std::string_view second = words.next();
    if (!second.empty()) uv[1] = text::number(second, name_, line_, "a texture coordinate");
    if (static_cast<std::int64_t>(texture_.size()) == kMaxIndices)
      fail("more texture points than this program can count");
    texture_.push_back(uv);
  }

  void readFace(text::Words& words) {
    polygon_.clear();
    for (auto word = words.next(); !word.empty(); word = words.next())
      polygon_.push_back(readCorner(word));
    if (polygon_.size() > 3 && polygon_line_ == 0) polygon_line_ = line_;
    if (polygon_.size() < 3)
      fail("a face needs 3 corners or more, this one has " + std::to_string(polygon_.size()));
    if (polygon_.size() > 3) fans_.push_back({mesh_.triangles.size(), polygon_.size()});
    for (std::size_t k = 1; k + 1 < polygon_.size(); ++k) {
      const Corner &a = polygon_[0], &b = polygon_[k], &c = polygon_[k + 1];
      mesh_.triangles.push_back({a.vertex, b.vertex, c.vertex});
      const bool textured = a.texture >= 0 && b.texture >= 0 && c.texture >= 0;
      all_textured_ = all_textured_ && textured;
      if (!textured) ++bare_triangles_;
      if (all_textured_) corner_textures_.push_back({a.texture, b.texture, c.texture});
    }
  }

  void readHapticCoordinates(text::Words& words) {
    const std::string_view id = words.next();
    TexturedFace face;
    const auto [stop, error] = std::from_chars(id.data(), id.data() + id.size(), face.texture);
    if (id.empty() || error != std::errc() || stop != id.data() + id.size() || face.texture < -1)
      fail(text::quoted(id) + " is not a texture's number (0 or more; -1: none)");
    std::string_view word = words.next();
    const bool given = face.texture >= 0 || !word.empty();
    for (Vec2& corner : face.coords)
      for (int k = 0; given && k < 2; ++k, word = words.next()) {
        corner[k] = text::number(word, name_, line_, "a haptic coordinate");
        if (!std::isfinite(corner[k])) fail("a haptic coordinate is not finite");
      }
    if (!word.empty()) fail("more than three pairs of haptic coordinates");
    if (haptic_lines_ == kMaxIndices) fail("more faces than this program can count");
    face.face = static_cast<std::int32_t>(haptic_lines_++);
    if (face.texture >= 0) textured_->push_back(face);
  }

  void checkHapticCoordinates() const {
    if (polygon_line_ > 0)
      throw FileError(name_, polygon_line_,
                      "a face with more than three corners, but haptic coordinates are three");
    if (haptic_lines_ != static_cast<std::int64_t>(mesh_.triangles.size()))
      fail("haptic coordinates (h) for " + std::to_string(haptic_lines_) + " of " +
           std::to_string(mesh_.triangles.size()) + " faces; each face must have a line");
  }

  // Parses "v", "v/t", "v//n" or "v/t/n".
  Corner readCorner(std::string_view word) {
    Corner corner;
    const char* at = word.data();
    const char* end = at + word.size();
    corner.vertex = readVertexIndex(at, end, word);
    if (at != end && *at == '/') {
      ++at;
      if (at != end && *at != '/')
        corner.texture = readReference(at, end, word, static_cast<std::int64_t>(texture_.size()),
                                       texture_points_);
      if (at != end && *at == '/') {
        ++at;
        if (at != end) readReference(at, end, word, normal_count_, normals_);
      }
    }
    if (at != end) throwBadCorner(word);
    return corner;
  }

  std::int32_t readVertexIndex(const char*& at, const char* end, std::string_view word) {
    const auto so_far = static_cast<std::int64_t>(mesh_.positions.size());
    std::int64_t index = 0;
    const auto [stop, error] = text::wholeNumber(at, end, index);
    if (error == std::errc::invalid_argument) throwBadCorner(word);
    if (error != std::errc() || index > kMaxIndices || index < -kMaxIndices)
      fail("the face names vertex " + text::quoted(word) + ", more than a file can hold");
    at = stop;
    if (index == 0) fail("the face names vertex 0; OBJ counts from 1");
    if (index < 0) {
      if (-index > so_far)
        fail("the face names vertex " + std::to_string(index) + ", but only " +
             std::to_string(so_far) + " stand before it");
      return static_cast<std::int32_t>(so_far + index);
    }
    if (index > highest_vertex_.index) highest_vertex_ = {index, line_};
    return static_cast<std::int32_t>(index - 1);
  }

  // Returns kNone for an index that is invalid in any file.
  std::int32_t readReference(const char*& at, const char* end, std::string_view word,
                             std::int64_t so_far, References& references) {
    std::int64_t index = 0;
    const auto [stop, error] = text::wholeNumber(at, end, index);
    if (error == std::errc::invalid_argument) throwBadCorner(word);
    at = stop;
    if (index < 0) index += so_far + 1;
    if (index > 0 && index <= so_far) return static_cast<std::int32_t>(index - 1);
    if (references.first_line == 0) references.first_line = line_;
    if (error != std::errc() || index <= 0 || index > kMaxIndices) {
      ++references.missing;
      return kNone;
    }
    references.ahead.push_back(static_cast<std::int32_t>(index - 1));
    return references.ahead.back();
  }

  [[noreturn]] void throwBadCorner(std::string_view word) const {
    if (text::hasControl(word)) fail("binary data where a face's corner should be");
    fail(text::quoted(word) + " is not a face's corner (v, v/t, v//n or v/t/n)");
  }

  void addWarnings(const PolygonFaults& faults) {
    addPolygonWarnings(faults, *warnings_);
    for (const References* references : {&texture_points_, &normals_})
      if (references->missing > 0)
        warnings_->push_back("line " + std::to_string(references->first_line) + ": " +
                             formatCount(references->missing) + " of the faces' corners name a " +
                             references->what);
    if (texture_points_.missing == 0 && !texture_.empty() && !all_textured_)
      warnings_->push_back("the texture coordinates are left out: " + formatCount(bare_triangles_) +
                           " of " + formatCount(mesh_.triangles.size()) + " triangles have none");
    if (colored_vertices_ > 0 && !colors_) warnings_->push_back(text::colorsLeftOut("vertices"));
    if (colors_ && colored_vertices_ > 0 && colored_vertices_ < mesh_.positions.size())
      warnings_->push_back(formatCount(mesh_.positions.size() - colored_vertices_) + " of " +
                           formatCount(mesh_.positions.size()) + " vertices have no colour");
  }

  void gatherTexture() {
    mesh_.corner_uvs.reserve(corner_textures_.size());
    for (const auto& t : corner_textures_)
      mesh_.corner_uvs.push_back({texture_[static_cast<std::size_t>(t[0])],
                                  texture_[static_cast<std::size_t>(t[1])],
                                  texture_[static_cast<std::size_t>(t[2])]});
  }

  const std::string& name_;
  text::Lines lines_;
  std::size_t line_ = 0; // first line of the current statement
  std::string joined_;
  std::string_view whole_; // statement with its comment: a material's name may contain '#'
  TriangleMesh mesh_;
  std::vector<Vec2> texture_;
  std::vector<std::array<std::int32_t, 3>> corner_textures_;
  std::vector<Corner> polygon_;
  std::vector<PolygonFan> fans_;
  std::int64_t normal_count_ = 0;
  bool all_textured_ = true;
  std::size_t bare_triangles_ = 0; // triangles without texture coordinates
  std::size_t colored_vertices_ = 0;
  ObjMaterials materials_;
  MeshColors* colors_;
  std::vector<std::string>* warnings_;
  std::vector<TexturedFace>* textured_;
  std::int64_t haptic_lines_ = 0;
  std::size_t polygon_line_ = 0; // line of the first face with more than three corners
  Highest highest_vertex_;
  References texture_points_{"texture point that is not there: the texture is left out"};
  References normals_{"normal that is not there: normals are not used"};
};

} // namespace

TriangleMesh parseObj(std::string_view bytes, const std::string& name,
                      std::vector<std::string>* warnings, MeshColors* colors) {
  return ObjParser(bytes, name, warnings, colors).parse();
}

TexturedMesh parseTexturedObj(std::string_view bytes, const std::string& name, MeshColors* colors) {
  TexturedMesh read;
  read.mesh = ObjParser(bytes, name, &read.warnings, colors, &read.textured).parse();
  return read;
}

TexturedMesh readTexturedObj(const std::filesystem::path& path, MeshColors* colors) {
  if (meshFileType(path) != MeshFileType::obj)
    throw FileError(path.string(), 0, "only an .obj holds haptic coordinates");
  return parseTexturedObj(readCommented(path), path.string(), colors);
}

} // namespace patina
