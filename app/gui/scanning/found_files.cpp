#include "app/gui/scanning/found_files.h"

#include "core/file.h"

namespace patina {
namespace {

std::vector<MissingPose> withoutPose(const OpenScan& scan) {
  std::vector<MissingPose> without;
  for (std::size_t i = 0; i < scan.seen().size(); ++i)
    if (!scan.seen()[i].why.empty())
      without.push_back({scan.files()->frames[i].t, scan.seen()[i].why});
  return without;
}

} // namespace

std::vector<SceneScan> foundSteps(const OpenScan& scan) {
  std::vector<SceneScan> steps;
  if (scan.files()->scan.files.empty()) return steps;
  steps.push_back(scan.files()->scan);
  const auto add = [&](const char* file, const auto& text) {
    if (scan.files()->scan.text(file)) return;
    SceneScan next = steps.back();
    next.files[file] = std::make_shared<const std::string>(text());
    steps.push_back(std::move(next));
  };
  const ScanPath* found = scan.path();
  if (found == nullptr || scan.grows() || scan.busy()) return steps;
  if (!found->poses.empty())
    add("poses.tum", [&] { return posesText(found->poses, withoutPose(scan)); });
  if (!found->path.empty()) add("path.csv", [&] { return pathText(found->path); });
  return steps;
}

bool canSaveResults(const OpenScan& scan) {
  const ScanFiles* files = scan.files();
  const ScanPath* found = scan.path();
  return found != nullptr && !scan.grows() && !files->of_scene && !found->poses.empty() &&
         !found->path.empty() && !scan.busy() && (files->poses.empty() || files->path.empty());
}

void saveResults(const OpenScan& scan) {
  const ScanFiles& files = *scan.files();
  if (files.poses.empty())
    writePoses(files.folder / "poses.tum", scan.path()->poses, withoutPose(scan));
  if (files.path.empty()) writePath(files.folder / "path.csv", scan.path()->path);
}

bool writeKeepingOld(const std::filesystem::path& path, const std::string& text) {
  const bool was_there = std::filesystem::exists(path);
  if (was_there) std::filesystem::rename(path, path.string() + "~");
  writeFileAtomically(path, text);
  return was_there;
}

} // namespace patina
