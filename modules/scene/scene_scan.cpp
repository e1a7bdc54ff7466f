#include "scene/scene_scan.h"

#include <algorithm>
#include <set>

#include "core/error.h"
#include "scene/scene.h"

namespace patina {

const std::string* SceneScan::text(const std::string& file) const {
  const auto found = files.find(file);
  return found == files.end() ? nullptr : found->second.get();
}

bool SceneScan::operator==(const SceneScan& other) const {
  return name == other.name && folder == other.folder && frames == other.frames &&
         std::equal(files.begin(), files.end(), other.files.begin(), other.files.end(),
                    [](const auto& a, const auto& b) {
                      return a.first == b.first && (a.second == b.second || *a.second == *b.second);
                    });
}

const SceneScan* findScan(const Scene& scene, std::string_view name) {
  const auto found = std::find_if(scene.scans.begin(), scene.scans.end(),
                                  [&](const SceneScan& scan) { return scan.name == name; });
  return found == scene.scans.end() ? nullptr : &*found;
}

Scene withScan(Scene scene, SceneScan scan) {
  const SceneScan* before = findScan(scene, scan.name);
  if (before)
    scene.scans[static_cast<std::size_t>(before - scene.scans.data())] = std::move(scan);
  else
    scene.scans.push_back(std::move(scan));
  validate(scene.scans);
  return scene;
}

Scene withoutScan(Scene scene, std::string_view name) {
  const SceneScan* scan = findScan(scene, name);
  if (!scan) {
    std::string names;
    for (const SceneScan& other : scene.scans) names += (names.empty() ? "" : ", ") + other.name;
    throw Error("no scan '" + std::string(name) + "' in the scene; there is " +
                (names.empty() ? "none" : names));
  }
  scene.scans.erase(scene.scans.begin() + (scan - scene.scans.data()));
  return scene;
}

SceneScan mergedScan(const SceneScan& known, SceneScan found) {
  const auto differs = [&](std::string_view file) {
    const std::string *old = known.text(std::string(file)), *now = found.text(std::string(file));
    return bool(old) != bool(now) || (old && *old != *now);
  };
  bool recording = known.frames == found.frames, all = recording, where = true;
  for (const auto& [file, step] : kScanFiles) {
    // Camera and rig do not depend on each other.
    const bool follows = step == "calibrate" ? recording : step == "register" ? where : all;
    if (step != "record" && follows && !found.text(std::string(file)))
      if (const auto old = known.files.find(std::string(file)); old != known.files.end())
        found.files.insert(*old);
    const bool same = !differs(file);
    all = all && same;
    if (step == "record") recording = all;
    if (file == "path.csv" || step == "register") where = where && same;
  }
  return found;
}

std::string invalidatedFiles(const SceneScan& before, const SceneScan& after) {
  std::string names;
  for (const auto& [file, step] : kScanFiles)
    if (before.text(std::string(file)) && !after.text(std::string(file)))
      names.append(names.empty() ? "" : ", ").append(file);
  return names;
}

std::string describeChange(const SceneScan* before, const SceneScan& after) {
  if (!before) return "attach scan " + after.name;
  if (*before == after) return "";
  std::vector<std::string> steps;
  const auto add = [&](std::string_view step) {
    if (std::find(steps.begin(), steps.end(), step) == steps.end()) steps.emplace_back(step);
  };
  if (before->folder != after.folder || before->frames != after.frames) add("record");
  for (const auto& [file, step] : kScanFiles) {
    const std::string *old = before->text(std::string(file)), *now = after.text(std::string(file));
    if (bool(old) != bool(now) || (old && *old != *now)) add(step);
  }
  std::string words;
  for (std::size_t i = 0; i < steps.size(); ++i)
    words += (i == 0 ? "" : i + 1 == steps.size() ? " and " : ", ") + steps[i];
  return words + " scan " + after.name;
}

std::string scanNameOf(const std::filesystem::path& folder) {
  const std::filesystem::path path = std::filesystem::absolute(folder).lexically_normal();
  std::string name =
      (path.has_filename() ? path : path.parent_path()).filename().string().substr(0, 100);
  for (char& c : name)
    if (!isName(std::string(1, c)) && !(c & 0x80)) c = '-';
  return isName(name) ? name : "scan";
}

void validate(const std::vector<SceneScan>& scans) {
  std::set<std::string> seen;
  for (const SceneScan& scan : scans) {
    if (!isName(scan.name))
      throw Error("scan name '" + scan.name +
                  "': use letters (UTF-8), digits, '-' and '_' only, up to 100 bytes");
    if (!seen.insert(scan.name).second) throw Error("scan name '" + scan.name + "' is used twice");
    for (const auto& [file, text] : scan.files)
      if (!text ||
          std::none_of(kScanFiles.begin(), kScanFiles.end(),
                       [&name = file](const ScanFile& known) { return known.name == name; }))
        throw Error("scan '" + scan.name + "': '" + file + "' is no file of a scan");
    if (scan.folder.empty() != scan.frames.empty() ||
        (!scan.folder.empty() && !scan.folder.is_absolute()))
      throw Error("scan '" + scan.name + "': its frames' folder and digest do not fit together");
  }
}

} // namespace patina
