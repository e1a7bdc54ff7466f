#include "architecture/include_rules.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <sstream>

namespace patina::architecture {
namespace {

using Names = std::set<std::string>;

// Modules that a module may include besides itself. Siblings (haptics, workspace) never include one
// another.
const std::map<std::string, Names>& visibleModules() {
  static const Names kBelowSiblings{"core", "geometry", "field", "scene"};
  static const std::map<std::string, Names> kVisible{
      {"core", {}},
      {"pictures", {"core"}},
      {"geometry", {"core"}},
      {"usb", {"core"}},
      {"field", {"core", "geometry"}},
      {"scene", {"core", "geometry", "field"}},
      {"haptics", {"core", "geometry", "field", "scene", "usb"}},
      {"authoring", {"core", "geometry", "field", "scene", "pictures"}},
      {"acquisition", {"core", "geometry", "field", "scene", "usb", "pictures"}},
      {"visualization", kBelowSiblings},
      {"workspace", {"core", "geometry", "field", "scene", "pictures"}},
      {"session",
       {"core", "geometry", "field", "scene", "usb", "pictures", "haptics", "authoring",
        "visualization", "workspace"}},
      {"scan",
       {"core", "geometry", "field", "scene", "usb", "pictures", "haptics", "authoring",
        "visualization", "workspace", "session", "acquisition"}},
      {"demo",
       {"core", "geometry", "field", "scene", "usb", "pictures", "haptics", "authoring",
        "visualization", "workspace", "session", "acquisition", "scan"}}};
  return kVisible;
}

struct Owner {
  std::string place; // a folder, or one file
  bool in_headers_too;
};

struct Library {
  std::string name;
  std::vector<std::string> prefixes; // possible starts of the included path
  std::vector<Owner> owners;
};

const std::vector<Library>& libraries() {
  static const std::vector<Library> kLibraries{
      {"Eigen", {"Eigen/", "unsupported/Eigen/"}, {{"modules/", true}, {"app/", true}}},
      {"OpenMesh", {"OpenMesh/"}, {{"modules/geometry/", false}}},
      {"TBB",
       {"tbb/", "oneapi/"},
       {{"modules/geometry/", false},
        {"modules/field/", false},
        {"modules/authoring/", false},
        {"modules/acquisition/simulation/", false},
        {"modules/session/", false},
        {"modules/demo/", false},
        {"app/", false}}},
      {"nlohmann-json", {"nlohmann/"}, {{"modules/core/json.cpp", false}}},
      {"libusb", {"libusb.h"}, {{"modules/usb/libusb/", true}}},
      {"OpenImageIO", {"OpenImageIO/"}, {{"modules/pictures/", false}}},
      {"OpenCV",
       {"opencv2/"},
       {{"modules/acquisition/vision/", false}, {"modules/acquisition/video/", false}}},
      {"Ceres", {"ceres/", "glog/"}, {{"modules/acquisition/solver/", false}}},
      {"cairo", {"cairo"}, {{"modules/acquisition/printer/", false}}},
      {"Expat", {"expat.h"}, {{"modules/acquisition/profilometer/", false}}},
      {"minizip", {"minizip/"}, {{"modules/acquisition/profilometer/", false}}},
      {"FFmpeg", {"libav"}, {{"modules/acquisition/video/", false}}},
      {"OpenSSL", {"openssl/"}, {{"modules/core/sha256.cpp", false}}},
      {"pthread", {"pthread.h", "semaphore.h"}, {{"modules/haptics/", false}}},
      {"Qt", {"Q", "qt"}, {{"app/gui/", true}}},
      {"VTK", {"vtk"}, {{"modules/visualization/", true}, {"app/", true}}},
      {"X11", {"X11/"}, {{"modules/visualization/", false}}},
  };
  return kLibraries;
}

// System headers end in .h; those of C++ have no dot.
bool isSystem(const std::string& included) {
  if (included.find('.') == std::string::npos) return included.find('/') == std::string::npos;
  static const Names kSystem{"malloc.h",  "unistd.h",    "fcntl.h",     "sched.h",  "time.h",
                             "stdlib.h",  "stddef.h",    "stdint.h",    "string.h", "poll.h",
                             "dirent.h",  "immintrin.h", "emmintrin.h", "signal.h", "dlfcn.h",
                             "termios.h", "link.h"};
  return kSystem.contains(included) || included.starts_with("sys/");
}

bool isHeader(const std::string& path) {
  return path.ends_with(".h");
}

std::string firstPart(const std::string& path) {
  return path.substr(0, path.find('/'));
}

std::string moduleOf(const std::string& path) {
  const std::string root = "modules/";
  return path.starts_with(root) ? firstPart(path.substr(root.size())) : "";
}

const Library* libraryOf(const std::string& included) {
  for (const Library& library : libraries())
    for (const std::string& prefix : library.prefixes)
      if (included.starts_with(prefix)) return &library;
  return nullptr;
}

using Cause = std::optional<std::string>;

Cause ofLibrary(const std::string& path, const Library& library) {
  for (const Owner& owner : library.owners) {
    if (!path.starts_with(owner.place)) continue;
    if (owner.in_headers_too || !isHeader(path)) return std::nullopt;
    return library.name + " may not be in a header";
  }
  return library.name + " does not belong here";
}

Cause ofApp(const std::string& path, const std::string& included) {
  if (!path.starts_with("app/")) return "a module may not know the application";
  for (const std::string side : {"app/cli/", "app/gui/"}) {
    if (included.starts_with(side) && !path.starts_with(side))
      return "only " + side + " itself may include it";
  }
  return std::nullopt;
}

// Commands and window call the steps of a scan through modules/scan. From acquisition itself they
// include files and plain values, emulated and USB probes, the lens, and algorithms that are no
// step: figures of a path, a first guess, picked points, the texture of a picture.
Cause ofStep(const std::string& path, const std::string& included) {
  static const Names kKnown{"acquisition/values/camera.h",
                            "acquisition/values/orientation.h",
                            "acquisition/profile/roughness.h",
                            "acquisition/profilometer/measured_heights.h",
                            "acquisition/profilometer/square_area.h",
                            "acquisition/recording/recording_state.h",
                            "acquisition/registration/error_map.h",
                            "acquisition/registration/first_guess.h",
                            "acquisition/registration/rigid_fit.h",
                            "acquisition/values/scan_samples.h",
                            "acquisition/simulation/emulated_probe.h",
                            "acquisition/simulation/path_error.h",
                            "acquisition/sources/usb_probe.h",
                            "acquisition/texture/fit_plane.h",
                            "acquisition/tracking/lens.h"};
  if (!path.starts_with("app/cli/") && !path.starts_with("app/gui/")) return std::nullopt;
  if (!included.starts_with("acquisition/") || included.starts_with("acquisition/files/") ||
      kKnown.contains(included))
    return std::nullopt;
  return "a step of a scan is called through modules/scan";
}

Cause ofModule(const std::string& path, const std::string& target) {
  const std::string module = moduleOf(path);
  if (module.empty() || module == target) return std::nullopt;
  const auto visible = visibleModules().find(module);
  if (visible == visibleModules().end()) return "module " + module + " is not in the architecture";
  if (visible->second.contains(target)) return std::nullopt;
  return module + " may not see " + target;
}

Cause causeAgainst(const std::string& path, const std::string& included, bool quoted) {
  if (quoted) {
    const std::string target = firstPart(included);
    if (target == "app") return ofApp(path, included);
    if (const Cause step = ofStep(path, included)) return step;
    if (visibleModules().contains(target)) return ofModule(path, target);
    return "write it from the root, as \"module/file.h\"";
  }
  if (const Library* library = libraryOf(included)) return ofLibrary(path, *library);
  if (isSystem(included)) return std::nullopt;
  return "unknown third party";
}

} // namespace

std::vector<std::string> includeViolations(const SourceFile& file) {
  std::vector<std::string> violations;
  std::istringstream text(file.text);
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    line.erase(std::remove_if(line.begin(), line.end(),
                              [](char c) { return c == ' ' || c == '\t' || c == '\r'; }),
               line.end());
    const std::string directive = "#include";
    if (!line.starts_with(directive) || line.size() < directive.size() + 3) continue;
    const char open = line[directive.size()];
    const bool quoted = open == '"';
    if (!quoted && open != '<') continue;
    const std::size_t begin = directive.size() + 1;
    const std::string included = line.substr(begin, line.find(quoted ? '"' : '>', begin) - begin);
    // A tool's own output next to a source ("file.moc").
    if (included.ends_with(".moc") && file.path.starts_with("app/gui/")) continue;
    if (const Cause cause = causeAgainst(file.path, included, quoted))
      violations.push_back(file.path + ":" + std::to_string(number) + ": " + included + ": " +
                           *cause);
  }
  return violations;
}

} // namespace patina::architecture
