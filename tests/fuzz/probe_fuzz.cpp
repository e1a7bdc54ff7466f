// Any bytes give samples or a FileError, and the same samples if they come in pieces. A path
// that is read is written and reads back the same.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/files/scan_tables.h"
#include "core/error.h"

namespace {

void checkPath(const std::string& text) {
  std::string written;
  std::vector<std::string> warnings;
  try {
    written = patina::pathText(patina::parsePath(text, "fuzz", &warnings));
  } catch (const patina::FileError&) {
    return;
  }
  if (patina::pathText(patina::parsePath(written, "written")) != written) std::abort();
}

// A stream that is joined in the middle of a line has no header.
void checkJoined(const std::string& text) {
  std::vector<patina::ProbeSample> samples;
  std::vector<patina::RateSample> rates;
  try {
    patina::ProbeLines lines("fuzz");
    lines.skipPartialLine();
    lines.take(text, samples, &rates);
  } catch (const patina::FileError&) {
  }
  if (samples.empty()) return;
  std::string written = patina::probeHeader();
  for (const patina::ProbeSample& sample : samples) written += patina::probeRow(sample);
  if (patina::parseProbeStream(written, "written").values.size() != samples.size()) std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(std::string_view(reinterpret_cast<const char*>(data), size));
  checkPath(text);
  checkJoined(text);
  std::vector<patina::ProbeSample> pieces;
  std::vector<patina::RateSample> rates, all_rates;
  try {
    patina::ProbeLines lines("fuzz");
    for (std::size_t at = 0; at < text.size(); at += 7)
      lines.take(std::string_view(text).substr(at, 7), pieces, &rates);
    lines.end();
  } catch (const patina::FileError&) {
    return 0;
  }
  try {
    const auto all = patina::parseProbeStream(text, "fuzz", nullptr, &all_rates).values;
    if (all.size() != pieces.size() || all_rates.size() != rates.size()) std::abort();
  } catch (const patina::FileError&) {
    if (!pieces.empty()) std::abort(); // the end may report a missing sample or header
  }
  return 0;
}
