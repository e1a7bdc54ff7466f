// What several commands report in the same words.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/json.h"
#include "core/percentiles.h"
#include "field/build/build_field.h"
#include "geometry/mesh/mesh_report.h"
#include "scene/scene.h"

namespace patina::cli {

using TextRows = std::vector<std::pair<std::string, std::string>>;

Json vectorJson(const Vec3& v);
Json fieldJson(const SurfaceField& field, const FieldReport& report);
TextRows fieldRows(const SurfaceField& field, const FieldReport& report);

Json toJson(const Percentiles& p);

// For people: three significant digits, never an exponent ("0.8", "28.1", "1,411").
std::string rounded(double value);

// A scene's value by its key, with the unit: "stiffness", "800" -> "800 N/m".
std::string withUnit(const std::string& key, const std::string& value);

// A scene's values by their keys: numbers as numbers, words as words.
Json valuesJson(const Scene& scene);

// Throws FileError now rather than after a minute's work if `path` cannot become a file.
// `inputs` are not to be replaced by it.
void requireWritable(const std::filesystem::path& path,
                     const std::vector<std::filesystem::path>& inputs = {});

} // namespace patina::cli
