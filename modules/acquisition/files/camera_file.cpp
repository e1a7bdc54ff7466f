#include "acquisition/files/camera_file.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/line_buffer.h"
#include "core/numbers.h"
#include "core/utf8.h"

namespace patina {

// Settings files of other programs: YAML, JSON, or the XML of OpenCV's FileStorage.

// Words of a scalar or a list, including nested lists.
struct Setting {
  std::vector<std::string> words;
  std::size_t line = 0;    // line of its key
  std::size_t repeats = 0; // a later line with the same key, or 0
};

// Values by path, without XML's root: "image_width", "camera_matrix/data", "cam0/intrinsics".
using Settings = std::map<std::string, Setting>;

namespace {

constexpr int kDeepest = 50; // largest depth of nested lists

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) + 1 - first);
}

std::string joinedPath(const std::string& parent, std::string_view key) {
  return parent.empty() ? std::string(key) : parent + "/" + std::string(key);
}

class Collector {
 public:
  explicit Collector(std::string file) : file_(std::move(file)) {}

  Setting& begin(const std::string& path, std::size_t line) {
    const auto [found, is_new] = settings_.emplace(path, Setting{{}, line});
    if (!is_new) found->second.repeats = line;
    return found->second;
  }
  Setting& at(const std::string& path) { return settings_[path]; }
  [[noreturn]] void refuse(std::size_t line, const std::string& cause) const {
    throw FileError(file_, line, cause);
  }
  Settings take() { return std::move(settings_); }

 private:
  std::string file_;
  Settings settings_;
};

// Returns the text without its tag ("!!opencv-matrix") and quotes.
std::string_view plainScalar(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('!'))
    text = trimmed(text.substr(std::min(text.find_first_of(" \t"), text.size())));
  if (text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
      text.back() == text.front())
    text = text.substr(1, text.size() - 2);
  return text;
}

// Returns the first of `stops` outside quotes and brackets.
std::size_t findOutside(std::string_view text, std::string_view stops) {
  char quote = 0;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote) {
      if (c == quote) quote = 0;
      continue;
    }
    if (depth == 0 && stops.find(c) != std::string_view::npos) return i;
    const bool begins =
        i == 0 || std::string_view(" \t,:[{\n").find(text[i - 1]) != std::string_view::npos;
    if ((c == '"' || c == '\'') && begins) quote = c;
    depth += c == '[' || c == '{';
    depth -= c == ']' || c == '}';
  }
  return std::string_view::npos;
}

// Reads a value in brackets or a scalar: words are added to this path, keys make paths below it.
void readFlow(std::string_view text, const std::string& path, std::size_t line, int depth,
              Collector& out) {
  text = trimmed(text);
  if (depth > kDeepest) out.refuse(line, "has brackets within more than 50 others");
  if (!text.starts_with('[') && !text.starts_with('{')) {
    if (const auto scalar = plainScalar(text); !scalar.empty())
      out.at(path).words.emplace_back(scalar);
    return;
  }
  const bool map = text.front() == '{';
  if (text.back() != (map ? '}' : ']')) out.refuse(line, "has a bracket that does not close here");
  text = text.substr(1, text.size() - 2);
  while (!trimmed(text).empty()) {
    const std::size_t end = std::min(findOutside(text, ","), text.size());
    const std::string_view item = text.substr(0, end);
    const std::size_t colon = map ? findOutside(item, ":") : std::string_view::npos;
    if (colon == std::string_view::npos) {
      readFlow(item, path, line, depth + 1, out);
    } else {
      const std::string key = joinedPath(path, plainScalar(item.substr(0, colon)));
      out.begin(key, line);
      readFlow(item.substr(colon + 1), key, line, depth + 1, out);
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

// Returns the number of brackets that are open at the end of the text.
int openBrackets(std::string_view text) {
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote) {
      if (c == quote) quote = 0;
    } else if (c == '"') {
      quote = c;
    } else {
      depth += c == '[' || c == '{';
      depth -= c == ']' || c == '}';
    }
  }
  return depth;
}

std::string_view withoutComment(std::string_view line) {
  const std::size_t hash = findOutside(line, "#");
  if (hash == std::string_view::npos) return line;
  if (hash == 0 || line[hash - 1] == ' ' || line[hash - 1] == '\t') return line.substr(0, hash);
  return line;
}

// Parses block mappings and sequences by indentation, with values in brackets. Anchors, references
// and multi-line texts do not occur in camera files and are not supported.
Settings parseYaml(std::string_view text, const std::string& name) {
  struct Level {
    std::size_t indent;
    std::string path;
  };
  Collector out(name);
  std::vector<Level> levels;
  LineBuffer lines;
  lines.append(text);
  std::string flow; // value in brackets that continues on the next line
  std::string flow_path;
  std::size_t number = 0, flow_line = 0;
  int flow_depth = 0;
  for (std::string_view whole; lines.next(whole, true);) {
    ++number;
    std::string_view line = withoutComment(whole);
    if (!flow.empty()) {
      flow.append("\n").append(line);
      flow_depth += openBrackets(line);
      if (flow_depth > 0) continue;
      readFlow(flow, flow_path, flow_line, 0, out);
      flow.clear();
      continue;
    }
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos || line[0] == '%' || trimmed(line) == "---" ||
        trimmed(line) == "...")
      continue;
    std::size_t indent = first;
    line = trimmed(line);
    // An item may have the same indentation as its key.
    while (line == "-" || line.starts_with("- ")) {
      while (!levels.empty() && levels.back().indent > indent) levels.pop_back();
      line = trimmed(line.substr(1));
      indent += 2;
    }
    const bool item = indent > first;
    if (line.empty()) continue;
    const std::size_t colon = line.front() == '[' || line.front() == '{' ? std::string_view::npos
                                                                         : findOutside(line, ":");
    std::string path = levels.empty() ? "" : levels.back().path;
    std::string_view value = line;
    if (colon != std::string_view::npos) {
      while (!levels.empty() && levels.back().indent >= indent) levels.pop_back();
      path =
          joinedPath(levels.empty() ? "" : levels.back().path, plainScalar(line.substr(0, colon)));
      levels.push_back({indent, path});
      out.begin(path, number);
      value = trimmed(line.substr(colon + 1));
    } else if (!item && line.front() != '[' && line.front() != '{') {
      continue; // continued text
    }
    if (value.starts_with('!'))
      value = trimmed(value.substr(std::min(value.find(' '), value.size())));
    flow_depth = value.starts_with('[') || value.starts_with('{') ? openBrackets(value) : 0;
    if (flow_depth > 0) {
      flow = value;
      flow_path = path;
      flow_line = number;
    } else {
      readFlow(value, path, number, 0, out);
    }
  }
  if (!flow.empty()) out.refuse(flow_line, "has a bracket that never closes");
  return out.take();
}

Settings parseXml(std::string_view text, const std::string& name) {
  Collector out(name);
  std::vector<std::string> open; // paths; that of the root is empty
  std::size_t line = 1;
  const auto skip = [&](std::size_t count) {
    line += static_cast<std::size_t>(
        std::count(text.begin(), text.begin() + static_cast<long>(count), '\n'));
    text.remove_prefix(count);
  };
  while (!text.empty()) {
    const std::size_t next = std::min(text.find('<'), text.size());
    if (open.size() > 1) {
      std::istringstream words{std::string(text.substr(0, next))};
      for (std::string word; words >> word;)
        out.at(open.back()).words.emplace_back(plainScalar(word));
    }
    skip(next);
    if (text.empty()) break;
    const bool comment = text.starts_with("<!--");
    const std::size_t end = text.find(comment ? "-->" : ">");
    if (end == std::string_view::npos) out.refuse(line, "has a tag that never ends");
    const std::string_view tag = text.substr(1, end - 1);
    const bool closes = tag.starts_with('/');
    const std::string_view key = tag.substr(0, tag.find_first_of(" \t\r\n/"));
    if (closes && open.empty()) out.refuse(line, "closes a tag that was never opened");
    if (closes) {
      open.pop_back();
    } else if (!comment && !tag.starts_with('?') && !tag.starts_with('!')) {
      const std::string path = open.empty() ? "" : joinedPath(open.back(), key);
      if (open.size() > static_cast<std::size_t>(kDeepest))
        out.refuse(line, "has more than 50 tags in one another");
      if (!open.empty()) out.begin(path, line);
      if (!tag.ends_with('/')) open.push_back(path);
    }
    skip(end + (comment ? 3 : 1));
  }
  if (!open.empty()) out.refuse(line, "ends within the tag of '" + open.back() + "'");
  return out.take();
}

} // namespace

// Throws FileError with the line if brackets, quotes or tags are not closed.
Settings parseSettings(const std::string& text, const std::string& name) {
  const std::string_view bytes = withoutByteOrderMark(text);
  return trimmed(bytes).starts_with('<') ? parseXml(bytes, name) : parseYaml(bytes, name);
}

namespace {

constexpr std::size_t kFisheyeCount = 4;

// Names of the lens models in other programs.
struct ModelName {
  const char* name;
  LensModel lens;
  std::size_t most; // number of coefficients
};
constexpr ModelName kModels[] = {{"plumb_bob", LensModel::brown, 14},
                                 {"radtan", LensModel::brown, 4},
                                 {"rational_polynomial", LensModel::brown, 14},
                                 {"thin_prism", LensModel::brown, 14},
                                 {"tilted", LensModel::brown, 14},
                                 {"none", LensModel::brown, 0},
                                 {"equidistant", LensModel::fisheye, 4},
                                 {"fisheye", LensModel::fisheye, 4},
                                 {"kannala_brandt", LensModel::fisheye, 4},
                                 {"kannala_brandt4", LensModel::fisheye, 4}};

std::string lowerCase(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

class CameraSettings {
 public:
  CameraSettings(const std::string& text, std::string name)
      : settings_(parseSettings(text, name)), name_(std::move(name)), prefix_(camPrefix()) {}

  [[noreturn]] void refuse(const Setting& at, const std::string& cause) const {
    throw FileError(name_, at.line, cause);
  }
  [[noreturn]] void refuse(const std::string& cause) const { throw FileError(name_, 0, cause); }

  // Returns the first of these keys that the file has; a matrix may store its numbers under "data".
  const Setting* find(std::initializer_list<const char*> keys) const {
    for (const std::string key : keys)
      for (const std::string& path : {prefix_ + key + "/data", prefix_ + key}) {
        const auto found = settings_.find(path);
        if (found == settings_.end()) continue;
        if (found->second.repeats)
          throw FileError(name_, found->second.repeats,
                          "'" + key + "' stands in line " + std::to_string(found->second.line) +
                              " already");
        requireSize(path.substr(0, path.find("/data")), key, found->second);
        return &found->second;
      }
    return nullptr;
  }
  const Setting& at(std::initializer_list<const char*> keys) const {
    if (const Setting* found = find(keys)) return *found;
    refuse("'" + std::string(*keys.begin()) + "' is missing");
  }
  std::vector<double> numbers(const Setting& setting) const {
    std::vector<double> values;
    for (const std::string& word : setting.words) {
      const auto value = parseNumber(word);
      if (!value || !std::isfinite(*value))
        refuse(setting, "'" + word.substr(0, 40) + "' is not a finite number");
      values.push_back(*value);
    }
    return values;
  }
  std::string word(const Setting* setting) const {
    return setting && !setting->words.empty() ? setting->words.front() : "";
  }
  bool isKalibr() const { return find({"intrinsics"}) != nullptr; }

 private:
  // Throws FileError if a matrix states another size than it has numbers.
  void requireSize(const std::string& path, const std::string& key, const Setting& matrix) const {
    const auto rows = settings_.find(path + "/rows"), cols = settings_.find(path + "/cols");
    if (rows == settings_.end() || cols == settings_.end()) return;
    const auto r = parseNumber(word(&rows->second)), c = parseNumber(word(&cols->second));
    const double size = r && c ? *r * *c : 0;
    if (size == 0 || size == static_cast<double>(matrix.words.size())) return;
    refuse(matrix, "'" + key + "' has " + std::to_string(matrix.words.size()) + " numbers for " +
                       word(&rows->second) + " x " + word(&cols->second));
  }
  // Returns the path's prefix of kalibr's camera (cam0, cam1, ...); throws if there are several.
  std::string camPrefix() const {
    std::string prefix;
    for (const auto& [path, setting] : settings_) {
      const std::size_t slash = path.find('/');
      if (!path.starts_with("cam") || slash == std::string::npos ||
          path.substr(slash) != "/intrinsics")
        continue;
      if (!prefix.empty())
        refuse(setting, "there are several cameras, " + prefix.substr(0, prefix.size() - 1) +
                            " and " + path.substr(0, slash) + ": keep one of them in the file");
      prefix = path.substr(0, slash + 1);
    }
    return prefix;
  }

  Settings settings_;
  std::string name_, prefix_;
};

int sideOf(const CameraSettings& file, const Setting& setting, const std::string& key,
           std::size_t index) {
  const double value = file.numbers(setting).at(index);
  if (!(value >= 1 && value <= 16384 && value == std::floor(value)))
    file.refuse(setting, "'" + key + "' must be a whole number up to 16384");
  return static_cast<int>(value);
}

void readPinhole(const CameraSettings& file, Camera& camera) {
  const auto counted = [&](const Setting& setting, const std::string& key, std::size_t count) {
    if (setting.words.size() != count)
      file.refuse(setting,
                  "'" + key + "' has " + std::to_string(setting.words.size()) + " numbers");
  };
  if (file.isKalibr()) {
    if (const Setting* model = file.find({"camera_model"});
        model && lowerCase(file.word(model)) != "pinhole")
      file.refuse(*model, "'camera_model' is '" + file.word(model).substr(0, 40) +
                              "'; only pinhole is known");
    const Setting &size = file.at({"resolution"}), &intrinsics = file.at({"intrinsics"});
    counted(size, "resolution", 2);
    counted(intrinsics, "intrinsics", 4);
    camera.width = sideOf(file, size, "resolution", 0);
    camera.height = sideOf(file, size, "resolution", 1);
    const std::vector<double> m = file.numbers(intrinsics);
    if (!(m[0] > 0 && m[1] > 0))
      file.refuse(intrinsics, "'intrinsics' must be fu fv pu pv, the first two above 0");
    camera.fx = m[0], camera.fy = m[1], camera.cx = m[2], camera.cy = m[3];
    return;
  }
  const Setting &width = file.at({"image_width", "image_Width", "width"}),
                &height = file.at({"image_height", "image_Height", "height"}),
                &matrix = file.at({"camera_matrix", "Camera_Matrix", "cameraMatrix", "K", "k"});
  counted(width, "image_width", 1);
  counted(height, "image_height", 1);
  camera.width = sideOf(file, width, "image_width", 0);
  camera.height = sideOf(file, height, "image_height", 0);
  counted(matrix, "camera_matrix", 9);
  const std::vector<double> m = file.numbers(matrix);
  if (!(m[0] > 0 && m[4] > 0) || m[1] != 0 || m[3] != 0 || m[6] != 0 || m[7] != 0 || m[8] != 1)
    file.refuse(matrix, "'camera_matrix' must be fx 0 cx 0 fy cy 0 0 1");
  camera.fx = m[0], camera.cx = m[2], camera.fy = m[4], camera.cy = m[5];
}

// Returns the model that the file names, else the one of fisheye_model, else OpenCV's.
ModelName modelOf(const CameraSettings& file) {
  const Setting* fisheye = file.find({"fisheye_model"});
  const std::string flag = lowerCase(file.word(fisheye));
  const bool is_fisheye = flag == "1" || flag == "true";
  if (fisheye && !is_fisheye && flag != "0" && flag != "false")
    file.refuse(*fisheye, "'fisheye_model' is '" + flag.substr(0, 40) + "'; known are 0 and 1");
  const Setting* named = file.find({"distortion_model"});
  const std::string name = lowerCase(file.word(named));
  if (name.empty()) return is_fisheye ? kModels[7] : ModelName{"", LensModel::brown, 14};
  std::string known;
  for (const ModelName& model : kModels) {
    known += (known.empty() ? "" : ", ") + std::string(model.name);
    if (name != model.name) continue;
    if (fisheye && is_fisheye != (model.lens == LensModel::fisheye))
      file.refuse(*fisheye, "'fisheye_model' is " + flag + ", but 'distortion_model' is '" +
                                name.substr(0, 40) + "'");
    return model;
  }
  file.refuse(*named, "'distortion_model' is '" + name.substr(0, 40) + "'; known are " + known);
}

void readLens(const CameraSettings& file, Camera& camera) {
  const ModelName model = modelOf(file);
  const Setting* setting = file.find({"distortion_coefficients", "Distortion_Coefficients",
                                      "distortion_coeffs", "distCoeffs", "dist_coeffs", "D", "d"});
  if (!setting && model.name == std::string("none")) return;
  if (!setting) file.refuse("'distortion_coefficients' is missing");
  std::vector<double> numbers = file.numbers(*setting);
  const std::size_t count = numbers.size();
  // Zeros beyond the model's own coefficients are padding.
  while (numbers.size() > model.most && numbers.back() == 0) numbers.pop_back();
  const std::string of = *model.name ? std::string(" of '") + model.name + "'" : "";
  const bool is_fisheye = model.lens == LensModel::fisheye;
  const bool usual = is_fisheye ? count == 0 || count >= kFisheyeCount
                                : count <= 5 || count == 8 || count == 12 || count == 14;
  if (numbers.size() > model.most || !usual)
    file.refuse(*setting, "'distortion_coefficients'" + of + " has " + std::to_string(count) +
                              " numbers; known are " +
                              (model.most == 0   ? "none"
                               : model.most == 4 ? "4"
                                                 : "4, 5, 8, 12 and 14"));
  camera.lens = model.lens;
  std::copy(numbers.begin(), numbers.end(), camera.distortion.begin());
}

std::size_t coefficientsUsed(const Camera& camera) {
  std::size_t used = camera.distortion.size();
  while (used > 0 && camera.distortion[used - 1] == 0) --used;
  return used;
}

} // namespace

Camera readCamera(const std::filesystem::path& path) {
  return parseCamera(readFile(path), path.string());
}

Camera parseCamera(const std::string& text, const std::string& name) {
  const CameraSettings file(text, name);
  Camera camera;
  readPinhole(file, camera);
  readLens(file, camera);
  return camera;
}

std::string lensName(const Camera& camera) {
  if (camera.lens == LensModel::fisheye) return "equidistant";
  const std::size_t used = coefficientsUsed(camera);
  return used <= 5    ? "plumb_bob"
         : used <= 8  ? "rational_polynomial"
         : used <= 12 ? "thin_prism"
                      : "tilted";
}

std::string cameraText(const Camera& camera, const std::string& more) {
  const auto list = [](const std::vector<double>& numbers) {
    std::string text;
    for (const double number : numbers) text += (text.empty() ? "" : ", ") + formatNumber(number);
    return "   dt: d\n   data: [ " + text + " ]\n";
  };
  const std::size_t used = coefficientsUsed(camera);
  const std::size_t count = camera.lens == LensModel::fisheye ? kFisheyeCount
                            : used <= 5                       ? 5
                            : used <= 8                       ? 8
                            : used <= 12                      ? 12
                                                              : 14;
  std::string model;
  if (camera.lens == LensModel::fisheye) model = "fisheye_model: 1\n";
  if (lensName(camera) != "plumb_bob") model += "distortion_model: " + lensName(camera) + "\n";
  return "%YAML:1.0\n---\nimage_width: " + std::to_string(camera.width) +
         "\nimage_height: " + std::to_string(camera.height) +
         "\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n" +
         list({camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1}) + model +
         "distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: " + std::to_string(count) +
         "\n" +
         list({camera.distortion.begin(),
               camera.distortion.begin() + static_cast<std::ptrdiff_t>(count)}) +
         more;
}

} // namespace patina
