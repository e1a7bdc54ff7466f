#include "app/cli/output/reports.h"

#include <cmath>
#include <cstdio>
#include <unistd.h>

#include "core/error.h"
#include "core/numbers.h"

namespace patina::cli {

namespace {

std::string fixed(double value, const char* format) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

} // namespace

Json vectorJson(const Vec3& v) {
  return Json(Json::Array{v.x(), v.y(), v.z()});
}

Json fieldJson(const SurfaceField& field, const FieldReport& report) {
  const FieldGrid& grid = field.grid;
  Json resolution = Json::array();
  for (const int nodes : grid.nodes) resolution.push(nodes - 1);
  Json json = Json::object();
  json.set("seconds", report.seconds);
  json.set("cpu_seconds", report.cpu_seconds);
  json.set("voxel", grid.voxel);
  json.set("resolution", resolution);
  json.set("origin", vectorJson(grid.origin));
  json.set("band_voxels", field.band);
  json.set("blocks", report.blocks);
  json.set("bytes", report.bytes);
  json.set("dense_bytes", report.dense_bytes);
  json.set("dropped_triangles", report.dropped_triangles);
  json.set("ambiguous_signs", report.ambiguous_signs);
  json.set("redistanced_nodes", report.redistanced_nodes);
  return json;
}

TextRows fieldRows(const SurfaceField& field, const FieldReport& report) {
  const FieldGrid& grid = field.grid;
  TextRows rows;
  rows.emplace_back("grid", std::to_string(grid.nodes[0] - 1) + " x " +
                                std::to_string(grid.nodes[1] - 1) + " x " +
                                std::to_string(grid.nodes[2] - 1) + " cells of " +
                                formatLength(grid.voxel));
  rows.emplace_back("band", formatNumber(field.band) + " voxels = " +
                                formatLength(field.band * grid.voxel) + " each side");
  if (report.seconds > 0)
    rows.emplace_back("built in", fixed(report.seconds, "%.3f s, ") +
                                      fixed(report.cpu_seconds, "%.3f s of CPU"));
  rows.emplace_back("memory", formatBytes(static_cast<double>(report.bytes)) + " in " +
                                  formatCount(report.blocks) + " blocks; the whole grid " +
                                  formatBytes(static_cast<double>(report.dense_bytes)));
  if (report.dropped_triangles)
    rows.emplace_back("left out", formatCount(report.dropped_triangles) + " triangles");
  if (report.ambiguous_signs)
    rows.emplace_back("unsure",
                      formatCount(report.ambiguous_signs) + " nodes may be inside or outside");
  if (report.redistanced_nodes)
    rows.emplace_back("depths", formatCount(report.redistanced_nodes) +
                                    " nodes re-measured to the union's own surface");
  return rows;
}

Json toJson(const Percentiles& p) {
  Json json = Json::object();
  json.set("p50", p.p50);
  json.set("p99", p.p99);
  json.set("p999", p.p999);
  json.set("max", p.max);
  return json;
}

std::string rounded(double value) {
  const double size = std::abs(value);
  if (size >= 999.5)
    return (value < 0 ? "-" : "") + formatCount(static_cast<std::size_t>(size + 0.5));
  const int digits = size >= 99.95 ? 0 : size >= 9.995 ? 1 : size >= 0.9995 ? 2 : 3;
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string withUnit(const std::string& key, const std::string& value) {
  if (key == "tip.radius" || key == "voxel") return formatLength(parseLength(value));
  const std::pair<const char*, const char*> units[] = {{"stiffness", " N/m"},
                                                       {"damping", " N s/m"},
                                                       {"force.limit", " N"},
                                                       {"resolution", " cells"},
                                                       {"band", " voxels"}};
  for (const auto& [name, unit] : units)
    if (key == name) return value + unit;
  return value;
}

Json valuesJson(const Scene& scene) {
  Json json = Json::object();
  for (const auto& [key, value] : values(scene)) {
    const auto number = parseNumber(value);
    json.set(key, number ? Json(*number) : Json(value));
  }
  return json;
}

void requireWritable(const std::filesystem::path& path,
                     const std::vector<std::filesystem::path>& inputs) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!std::filesystem::is_directory(folder))
    throw FileError(path.string(), 0, "cannot be written: there is no folder " + folder.string());
  if (std::filesystem::is_directory(path))
    throw FileError(path.string(), 0, "cannot be written: it is a folder");
  if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path))
    throw FileError(path.string(), 0, "cannot be written: not a file");
  for (const std::filesystem::path& input : inputs) {
    std::error_code unknown; // one that does not exist is not the other
    if (std::filesystem::equivalent(path, input, unknown))
      throw FileError(path.string(), 0, "cannot be written: it is an input of this command");
  }
  if (access(folder.c_str(), W_OK) != 0)
    throw FileError(path.string(), 0, "cannot be written: no permission in " + folder.string());
}

} // namespace patina::cli
