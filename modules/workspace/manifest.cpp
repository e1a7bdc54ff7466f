#include "workspace/manifest.h"

#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"

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

// A workspace travels between people: it must not make a reader open files elsewhere.
void requireInside(const std::string& relative) {
  const std::filesystem::path path(relative);
  bool inside = !relative.empty() && path.is_relative();
  for (const std::filesystem::path& part : path) inside = inside && part != "..";
  if (!inside) throw Error("path '" + relative + "' leaves the workspace's folder");
}

ManifestObject objectFrom(const Json& json) {
  ManifestObject object;
  object.name = json.at("name").asString();
  object.mesh = json.at("mesh").asString();
  object.sha256 = json.at("sha256").asString();
  object.world_from_object = poseFrom(json.at("world_from_object"));
  requireInside(object.mesh);
  return object;
}

std::string textOf(const Json& value) {
  return value.isString() ? value.asString() : formatNumber(value.asNumber());
}

// A whole number without the ".0" that a double carries.
Json jsonOf(const std::string& text) {
  const std::optional<double> number = parseNumber(text);
  if (!number) return text;
  const bool whole = text.find_first_not_of("0123456789") == std::string::npos && *number < 1e15;
  return whole ? Json(static_cast<std::int64_t>(*number)) : Json(*number);
}

Manifest manifestFrom(const Json& json) {
  const std::int64_t version = json.at("version").asInteger();
  if (version != kWorkspaceVersion) {
    throw Error("workspace version " + std::to_string(version) +
                " is unknown; this program reads version " + std::to_string(kWorkspaceVersion));
  }
  Manifest manifest;
  for (const Json& object : json.at("objects").asArray())
    manifest.objects.push_back(objectFrom(object));
  std::vector<std::pair<std::string, std::string>> list;
  for (const auto& [key, value] : json.at("values").asObject())
    list.emplace_back(key, textOf(value));
  setValues(manifest.values, list);
  return manifest;
}

} // namespace

Json toJson(const Manifest& manifest) {
  Json objects = Json::array();
  for (const ManifestObject& object : manifest.objects) {
    Json json = Json::object();
    json.set("name", object.name).set("mesh", object.mesh).set("sha256", object.sha256);
    json.set("world_from_object", toJson(object.world_from_object));
    objects.push(std::move(json));
  }
  Json list = Json::object();
  for (const auto& [key, text] : values(manifest.values)) {
    list.set(key, jsonOf(text));
  }
  Json json = Json::object();
  json.set("version", kWorkspaceVersion).set("units", "SI");
  json.set("objects", std::move(objects)).set("values", std::move(list));
  return json;
}

Manifest readManifest(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kManifestName;
  const Json json = parseJson(readFile(path), path.string());
  try {
    return manifestFrom(json);
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(path.string(), 0, error.what());
  }
}

} // namespace patina
