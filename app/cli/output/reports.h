// What several commands report in the same words.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/output/report.h"
#include "core/file_kind.h"
#include "core/percentiles.h"
#include "field/build/build_field.h"
#include "scene/scene.h"

namespace patina::cli {

Json vectorJson(const Vec3& v);

const Keys& fieldKeys();
Report fieldReport(const SurfaceField& field, const FieldReport& built);

Json toJson(const Percentiles& p);
// What --help says of them.
Keys percentileParts();
// "0.8 ns (p50), 1.2 (p99), 3.1 (p99.9), 28.1 (max)".
std::string spreadText(const Percentiles& p, const std::string& unit);

// A scene's values: numbers as numbers and words as words under the key "values", each a row.
void tellValues(const Scene& scene, Report& report);

// A scene's scans under the key "scans", each a row with its files; nothing where there is none.
const Keys& scanKeys();
void tellScans(const Scene& scene, Report& report);

// "3 to undo, 1 to redo".
std::string historyText(std::size_t undoable, std::size_t redoable);

// The names of all in a list, such as stages and layers.
template <typename List, typename Name>
std::vector<std::string> namesIn(const List& list, Name name) {
  std::vector<std::string> names;
  for (const auto& item : list) names.emplace_back(std::invoke(name, item));
  return names;
}
Json jsonOf(const std::vector<std::string>& words);

// Throws FileError now rather than after a minute's work if `path` cannot be written
// (outputTarget), holds a file of another kind than `kind`, or is one of `inputs`.
void requireWritable(const std::filesystem::path& path,
                     const std::vector<std::filesystem::path>& inputs = {},
                     std::optional<FileKind> kind = {});
// Links lead to one file by two names, also to one that does not exist yet.
bool areOne(const std::filesystem::path& a, const std::filesystem::path& b);

} // namespace patina::cli
