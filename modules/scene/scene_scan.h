// A scan in a scene: the contents of its files, which only acquisition interprets, and the folder
// of its frames.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace patina {

struct Scene;

struct SceneScan {
  std::string name;                                                // rules as for an object's name
  std::map<std::string, std::shared_ptr<const std::string>> files; // texts by name of kScanFiles
  std::filesystem::path folder; // absolute folder of the frames; empty: none
  std::string frames; // identifies the frames: framesDigest() of session/store/attach_scan.h

  const std::string* text(const std::string& file) const; // nullptr if absent
  bool operator==(const SceneScan& other) const;          // compares the files' contents
};

// Files of a scan and the step that makes each.
struct ScanFile {
  std::string_view name, step;
};
inline constexpr std::array<ScanFile, 10> kScanFiles = {{{"frames.csv", "record"},
                                                         {"probe.csv", "record"},
                                                         {"truth.json", "record"},
                                                         {"camera.yml", "calibrate"},
                                                         {"rig.json", "calibrate"},
                                                         {"poses.tum", "track"},
                                                         {"path.csv", "filter"},
                                                         {"heights.csv", "filter"},
                                                         {"registered.csv", "register"},
                                                         {"registered.txt", "register"}}};

const SceneScan* findScan(const Scene& scene, std::string_view name); // nullptr if absent
// Adds a scan or replaces the one of its name. Throws Error if it is invalid.
Scene withScan(Scene scene, SceneScan scan);
// Throws Error naming the existing scans if it is unknown.
Scene withoutScan(Scene scene, std::string_view name);
// Returns `found` completed by those files of `known`, a scan of the same name, that are still
// valid. Takes nothing if the recordings differ (in frames, frames.csv, probe.csv or truth.json),
// and no file that depends on one that differs. The registration depends on the path only.
SceneScan mergedScan(const SceneScan& known, SceneScan found);
// Returns the files of `before` that `after` lacks, as "path.csv, heights.csv".
std::string invalidatedFiles(const SceneScan& before, const SceneScan& after);
// Returns a text for the history, such as "attach scan plate"; empty if equal.
std::string describeChange(const SceneScan* before, const SceneScan& after);
// Returns the folder's name with '-' for characters that a name may not have.
std::string scanNameOf(const std::filesystem::path& folder);

// Throws Error for an invalid name, file or combination.
void validate(const std::vector<SceneScan>& scans);

} // namespace patina
