// Whatever the bytes: samples, or a FileError; and the same samples where they come in pieces.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/files/scan_files.h"
#include "core/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(std::string_view(reinterpret_cast<const char*>(data), size));
  std::vector<patina::ProbeSample> pieces;
  try {
    patina::ProbeLines lines("fuzz");
    for (std::size_t at = 0; at < text.size(); at += 7)
      lines.take(std::string_view(text).substr(at, 7), pieces);
    lines.end();
  } catch (const patina::FileError&) {
    return 0;
  }
  try {
    if (patina::parseProbeStream(text, "fuzz").values.size() != pieces.size()) std::abort();
  } catch (const patina::FileError&) {
    if (!pieces.empty()) std::abort(); // it may say that there is no sample, or no header
  }
  return 0;
}
