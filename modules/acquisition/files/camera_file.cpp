#include "acquisition/files/camera_file.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "acquisition/files/settings.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr std::size_t kFisheyeCount = 4;

// How other programs call a lens model.
struct ModelName {
  const char* name;
  LensModel lens;
  std::size_t most; // coefficients
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

  // The first of these keys that the file has; a matrix may hold its numbers under "data".
  const Setting* find(std::initializer_list<const char*> keys) const {
    for (const std::string key : keys)
      for (const std::string& path : {prefix_ + key + "/data", prefix_ + key}) {
        const auto found = settings_.find(path);
        if (found == settings_.end()) continue;
        if (found->second.repeats)
          throw FileError(name_, found->second.repeats,
                          "'" + key + "' stands in line " + std::to_string(found->second.line) +
                              " already");
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
  // kalibr names cameras cam0, cam1, ...; only one of them can be meant.
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

// The model that the file names, or by fisheye_model and else OpenCV's without a name.
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
  // Zeros beyond a model's own coefficients say nothing.
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
