// Any bytes give poses that are written and read back the same, or a FileError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/files/scan_tables.h"
#include "core/error.h"

namespace {

// The text as a program writes it, with a gap before the first pose and one after the last.
std::string written(const std::vector<patina::CameraPose>& poses) {
  const std::vector<patina::MissingPose> without{{poses.front().t - 1, "no marker"},
                                                 {poses.back().t + 1, "blurred"}};
  return patina::posesText(poses, without, poses.front().rig_doubted ? "a doubt" : "");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(std::string_view(reinterpret_cast<const char*>(data), size));
  std::vector<patina::CameraPose> poses;
  std::vector<std::string> warnings;
  try {
    poses = patina::parsePoses(text, "fuzz", {}, &warnings).values;
  } catch (const patina::FileError&) {
    return 0;
  }
  const std::string once = written(poses);
  if (written(patina::parsePoses(once, "written").values) != once) std::abort();
  return 0;
}
