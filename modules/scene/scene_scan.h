// A scan that belongs to a scene: the files of its folder, whole, and where its frames stay. What
// the files mean is known to acquisition alone; who builds without it still keeps them.
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
  std::string name;                                                // as that of an object
  std::map<std::string, std::shared_ptr<const std::string>> files; // by kScanFiles, texts
  std::filesystem::path folder; // absolute, where its frames are; empty: it has none
  std::string frames;           // which those are: framesDigest() of session/store/attach_scan.h

  const std::string* text(const std::string& file) const; // nullptr: it has none
  bool operator==(const SceneScan& other) const;          // files by what they hold
};

// The files that go with a scan, and the step that makes each.
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

const SceneScan* findScan(const Scene& scene, std::string_view name); // nullptr: there is none
// In the place of one of its name. Throws Error if it makes no sense.
Scene withScan(Scene scene, SceneScan scan);
// Throws Error naming those that there are.
Scene withoutScan(Scene scene, std::string_view name);
// `found` with what it lacks and `known`, which has its name, still has to give: nothing of another
// recording (frames, frames.csv, probe.csv or truth.json differ, or one has what the other lacks),
// and no file of a step before which something differs. Where a path lies follows from that alone.
SceneScan renewed(const SceneScan& known, SceneScan found);
// "path.csv, heights.csv": those of `before` that `after` lacks; empty: none.
std::string filesLost(const SceneScan& before, const SceneScan& after);
// "attach scan plate", "track and filter scan plate", for the history; empty: nothing has changed.
std::string wordsFor(const SceneScan* before, const SceneScan& after);
// The folder's name with '-' for what no name may hold.
std::string scanNameOf(const std::filesystem::path& folder);

// Throws Error: a name, a file or a pair of them that cannot be.
void validate(const std::vector<SceneScan>& scans);

} // namespace patina
