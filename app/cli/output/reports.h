// Parts shared by the reports of several commands.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/framework/report.h"
#include "core/file_kind.h"
#include "core/percentiles.h"
#include "field/construction/build_field.h"
#include "scene/scene.h"

namespace patina::cli {

Json vectorJson(const Vec3& v);

const Keys& fieldKeys();
Report fieldReport(const SurfaceField& field, const FieldReport& built);

Json toJson(const Percentiles& p);
// Keys for --help.
Keys percentileParts();
// Formats "0.8 ns (p50), 1.2 (p99), 3.1 (p99.9), 28.1 (max)".
std::string spreadText(const Percentiles& p, const std::string& unit);

// Sets the key "values": a scene's numbers and words, one row each.
void tellValues(const Scene& scene, Report& report);

// Sets the key "scans": a row for each scan with its files; nothing without scans.
const Keys& scanKeys();
void tellScans(const Scene& scene, Report& report);

// Formats "3 to undo, 1 to redo".
std::string historyText(std::size_t undoable, std::size_t redoable);

// Names of all items in a list, such as stages and layers.
template <typename List, typename Name>
std::vector<std::string> namesIn(const List& list, Name name) {
  std::vector<std::string> names;
  for (const auto& item : list) names.emplace_back(std::invoke(name, item));
  return names;
}
Json jsonOf(const std::vector<std::string>& words);

// Checks before any work: throws FileError if `path` cannot be written (outputTarget), holds a file
// of another kind than `kind`, or is one of `inputs`.
void requireWritable(const std::filesystem::path& path,
                     const std::vector<std::filesystem::path>& inputs = {},
                     std::optional<FileKind> kind = {});
// Returns true if both paths lead to the same file, also through links and if it does not exist
// yet. An empty path is none.
bool areOne(const std::filesystem::path& a, const std::filesystem::path& b);

} // namespace patina::cli
