// Settings that other programs write: YAML, JSON, or the XML of OpenCV's FileStorage.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace patina {

// The words of a scalar or of a list, those of lists within it too.
struct Setting {
  std::vector<std::string> words;
  std::size_t line = 0;    // of its key
  std::size_t repeats = 0; // a later line with the same key, or 0
};

// Values by their path: "image_width", "camera_matrix/data", "cam0/intrinsics". The root element of
// XML is not part of it.
using Settings = std::map<std::string, Setting>;

// Throws FileError with the line for brackets, quotes and tags that do not close.
Settings parseSettings(const std::string& text, const std::string& name);

} // namespace patina
