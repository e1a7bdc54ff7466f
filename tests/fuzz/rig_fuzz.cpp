// Any bytes give a probe and its markers, which can be written and read back, or a FileError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/files/scan_tables.h"
#include "core/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(std::string_view(reinterpret_cast<const char*>(data), size));
  std::optional<patina::Rig> rig;
  std::vector<patina::RigMarker> markers;
  try {
    rig = patina::parseRig(text, "fuzz");
  } catch (const patina::FileError&) {
  }
  try {
    markers = patina::parseMarkers(text, "fuzz");
  } catch (const patina::FileError&) {
  }
  try {
    patina::parseRigDeviations(text, "fuzz");
  } catch (const patina::FileError&) {
  }
  const std::string written = patina::rigText(rig.value_or(patina::Rig()), markers);
  const patina::Rig again = patina::parseRig(written, "written");
  if (rig && (again.accelerometers != rig->accelerometers || again.force_gain != rig->force_gain))
    std::abort();
  if (!markers.empty() && patina::parseMarkers(written, "written").size() != markers.size())
    std::abort();
  return 0;
}
