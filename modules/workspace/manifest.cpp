#include "workspace/manifest.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "workspace/content_files.h"
#include "workspace/migrations.h"

namespace patina {
namespace {

Json toJson(const Pose& pose) {
  Json rows = Json::array();
  for (int r = 0; r < 4; ++r) {
    Json row = Json::array();
    for (int c = 0; c < 4; ++c) row.push(pose.matrix()(r, c));
    rows.push(std::move(row));
  }
  return rows;
}

Pose poseFrom(const Json& json) {
  Pose pose;
  const Json::Array& rows = json.asArray();
  if (rows.size() != 4) throw Error("'world_from_object' must have 4 rows");
  for (std::size_t r = 0; r < 4; ++r) {
    const Json::Array& row = rows[r].asArray();
    if (row.size() != 4) throw Error("'world_from_object' must have 4 numbers in each row");
    for (std::size_t c = 0; c < 4; ++c)
      pose.matrix()(static_cast<int>(r), static_cast<int>(c)) = row[c].asNumber();
  }
  if (pose.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    throw Error("'world_from_object' must end in the row 0 0 0 1");
  return pose;
}

// Workspaces are shared: a path must not make the reader open files elsewhere.
void requireInside(const std::string& relative) {
  const std::filesystem::path path(relative);
  bool inside = !relative.empty() && path.is_relative();
  for (const std::filesystem::path& part : path) inside = inside && part != "..";
  if (!inside) throw Error("path '" + relative + "' leaves the workspace's folder");
}

ContentFile fileFrom(const Json& json, const char* key = "file") {
  ContentFile file{json.at(key).asString(), json.at("sha256").asString()};
  requireInside(file.path);
  return file;
}

Json toJson(const ContentFile& file) {
  Json json = Json::object();
  json.set("file", file.path).set("sha256", file.sha256);
  return json;
}

std::optional<ContentFile> fileIfAny(const Json& json, const char* key) {
  const Json* found = json.find(key);
  return found ? std::optional(fileFrom(*found)) : std::nullopt;
}

std::uint64_t countFrom(const Json& json) {
  const std::int64_t count = json.asInteger();
  if (count < 0) throw Error("a number of edits cannot be " + std::to_string(count));
  return static_cast<std::uint64_t>(count);
}

ManifestPaint paintFrom(const Json& json) {
  ManifestPaint paint;
  if (const Json* layout = json.find("layout")) {
    const std::int64_t charts = layout->at("charts").asInteger();
    if (charts < 0 || charts > std::numeric_limits<int>::max()) throw Error("bad 'charts'");
    paint.layout = ManifestLayout{layout->at("made").asBool(), static_cast<int>(charts), {}};
    if (layout->find("file")) paint.layout->file = fileFrom(*layout);
  }
  paint.color = fileIfAny(json, "color");
  paint.relief = fileIfAny(json, "relief");
  paint.material = fileIfAny(json, "material");
  paint.textures = fileIfAny(json, "textures");
  if ((paint.color || paint.relief) && !paint.layout)
    throw Error("a painted image has no 'layout'");
  return paint;
}

Json toJson(const ManifestPaint& paint) {
  Json json = Json::object();
  if (paint.layout) {
    Json layout = paint.layout->file ? toJson(*paint.layout->file) : Json::object();
    layout.set("made", paint.layout->generated).set("charts", paint.layout->charts);
    json.set("layout", std::move(layout));
  }
  if (paint.color) json.set("color", toJson(*paint.color));
  if (paint.relief) json.set("relief", toJson(*paint.relief));
  if (paint.material) json.set("material", toJson(*paint.material));
  if (paint.textures) json.set("textures", toJson(*paint.textures));
  return json;
}

ManifestObject objectFrom(const Json& json) {
  ManifestObject object;
  object.name = json.at("name").asString();
  object.mesh = fileFrom(json, "mesh");
  object.world_from_object = poseFrom(json.at("world_from_object"));
  if (const Json* paint = json.find("paint")) object.paint = paintFrom(*paint);
  return object;
}

ManifestScan scanFrom(const Json& json) {
  ManifestScan scan;
  scan.name = json.at("name").asString();
  for (const auto& [name, file] : json.at("files").asObject()) scan.files[name] = fileFrom(file);
  if (const Json* frames = json.find("frames")) {
    scan.folder = frames->at("folder").asString();
    scan.frames = frames->at("digest").asString();
  }
  return scan;
}

Json toJson(const ManifestScan& scan) {
  Json files = Json::object();
  for (const auto& [name, file] : scan.files) files.set(name, toJson(file));
  Json json = Json::object();
  json.set("name", scan.name).set("files", std::move(files));
  if (!scan.folder.empty())
    json.set("frames", Json::object().set("folder", scan.folder).set("digest", scan.frames));
  return json;
}

ManifestState stateFrom(const Json& json) {
  return {countFrom(json.at("event")), fileFrom(json)};
}

void readHistory(const Json& json, Manifest& manifest) {
  manifest.event = countFrom(json.at("event"));
  if (const Json* journal = json.find("journal")) {
    manifest.journal =
        ManifestJournal{journal->at("file").asString(), journal->at("check").asString()};
    requireInside(manifest.journal->file);
  }
  if (const Json* states = json.find("states"))
    for (const Json& state : states->asArray()) manifest.states.push_back(stateFrom(state));
  for (std::size_t i = 0; i < manifest.states.size(); ++i) {
    const bool ascends = i == 0 ? manifest.states[0].event == 0
                                : manifest.states[i - 1].event < manifest.states[i].event;
    if (!ascends) throw Error("'states' must begin with event 0 and ascend");
  }
  if (manifest.journal && manifest.states.empty()) throw Error("'states' is missing");
}

std::string textOf(const Json& value) {
  return value.isString() ? value.asString() : formatNumber(value.asNumber());
}

// Writes a whole number without the ".0" of a double.
Json jsonOf(const std::string& text) {
  const std::optional<double> number = parseNumber(text);
  if (!number) return text;
  const bool whole = text.find_first_not_of("0123456789") == std::string::npos && *number < 1e15;
  return whole ? Json(static_cast<std::int64_t>(*number)) : Json(*number);
}

Manifest manifestFrom(const Json& json) {
  const std::int64_t version = json.at("version").asInteger();
  if (version < 1 || version > kWorkspaceVersion) {
    throw Error("workspace version " + std::to_string(version) +
                " is unknown; this program reads versions 1 to " +
                std::to_string(kWorkspaceVersion));
  }
  Manifest manifest;
  for (const Json& object : json.at("objects").asArray())
    manifest.objects.push_back(objectFrom(object));
  if (const Json* scans = json.find("scans"))
    for (const Json& scan : scans->asArray()) manifest.scans.push_back(scanFrom(scan));
  std::vector<std::pair<std::string, std::string>> list;
  for (const auto& [key, value] : json.at("values").asObject())
    list.emplace_back(key, textOf(value));
  if (version < 3) migrateValues(list);
  setValues(manifest.values, list);
  if (version >= 2) readHistory(json, manifest);
  return manifest;
}

// Paths and messages end at a NUL, so that a name with one would stand for another.
void requireNoNul(std::string_view text, const std::string& name) {
  constexpr std::string_view kNul = "\\u0000";
  for (std::size_t at = text.find(kNul); at != std::string_view::npos;
       at = text.find(kNul, at + 1)) {
    const std::size_t before = text.find_last_not_of('\\', at);
    if ((at - before) % 2 == 0) continue; // an escaped backslash before a 'u'
    const auto line =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw FileError(name, static_cast<std::size_t>(line) + 1,
                    "a text holds the character NUL (\\u0000), which no name may have");
  }
}

} // namespace

Json toJson(const Manifest& manifest) {
  Json objects = Json::array();
  for (const ManifestObject& object : manifest.objects) {
    Json json = Json::object();
    json.set("name", object.name).set("mesh", object.mesh.path).set("sha256", object.mesh.sha256);
    json.set("world_from_object", toJson(object.world_from_object));
    if (object.paint) json.set("paint", toJson(*object.paint));
    objects.push(std::move(json));
  }
  Json list = Json::object();
  for (const auto& [key, text] : values(manifest.values)) {
    list.set(key, jsonOf(text));
  }
  Json json = Json::object();
  json.set("version", manifest.scans.empty() ? 3 : kWorkspaceVersion).set("units", "SI");
  json.set("objects", std::move(objects)).set("values", std::move(list));
  if (!manifest.scans.empty()) {
    Json scans = Json::array();
    for (const ManifestScan& scan : manifest.scans) scans.push(toJson(scan));
    json.set("scans", std::move(scans));
  }
  json.set("event", static_cast<std::int64_t>(manifest.event));
  if (!manifest.journal) return json;
  Json journal = Json::object();
  journal.set("file", manifest.journal->file).set("check", manifest.journal->checksum);
  Json states = Json::array();
  for (const ManifestState& state : manifest.states) {
    Json item = Json::object();
    item.set("event", static_cast<std::int64_t>(state.event));
    item.set("file", state.file.path).set("sha256", state.file.sha256);
    states.push(std::move(item));
  }
  json.set("journal", std::move(journal)).set("states", std::move(states));
  return json;
}

namespace {

// Text that is no JSON was damaged, for this program writes it as a whole.
Json intactJson(std::string_view text, const std::string& name) {
  try {
    return parseJson(text, name);
  } catch (const FileError& error) {
    const std::string said = error.what();
    throw FileError(name, error.line(), said.substr(said.find(": ", name.size()) + 2) + kAdvice);
  }
}

} // namespace

Manifest parseManifest(std::string_view text, const std::string& name) {
  const Json json = intactJson(text, name);
  requireNoNul(text, name);
  try {
    return manifestFrom(json);
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(name, 0, error.what());
  }
}

Manifest readManifest(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kManifestName;
  return parseManifest(readFile(path), path.string());
}

std::vector<ContentFile> filesOf(const Manifest& manifest) {
  std::vector<ContentFile> files;
  const auto add = [&](const std::optional<ContentFile>& file) {
    if (file) files.push_back(*file);
  };
  for (const ManifestScan& scan : manifest.scans)
    for (const auto& [name, file] : scan.files) files.push_back(file);
  for (const ManifestObject& object : manifest.objects) {
    files.push_back(object.mesh);
    if (!object.paint) continue;
    if (object.paint->layout) add(object.paint->layout->file);
    add(object.paint->color);
    add(object.paint->relief);
    add(object.paint->material);
    add(object.paint->textures);
  }
  return files;
}

} // namespace patina
