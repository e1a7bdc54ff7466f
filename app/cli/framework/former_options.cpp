#include "app/cli/framework/former_options.h"

#include <algorithm>
#include <string_view>

namespace patina::cli {
namespace {

struct FormerOption {
  std::string_view command, former, present; // present is empty if the option has no effect
};

constexpr FormerOption kFormerOptions[] = {
    {"calibrate", "--still", "--accelerometers"},
    {"filter", "--forward", "--no-smoother"},
    {"filter", "--lifted", "--keep-air"},
    {"filter", "--over", "--reference-mesh"},
    {"filter", "--smooth", ""},
    {"fit-texture", "--over-noise", "--min-snr"},
    {"fit-texture", "--stretch", "--interval"},
    {"latency-test", "--wire", "--emulated-falcon"},
    {"map-texture", "--most-stretch", "--max-stretch"},
    {"paint", "--seed", "--dab-anchor"},
    {"register", "--align", "--initial-values"},
    {"register", "--also", "--with"},
    {"scan", "--also", "--with"},
    {"simulate-device", "--together", "--samples-per-packet"},
};

} // namespace

std::vector<std::string> inPresentSpelling(std::vector<std::string> words) {
  if (words.empty()) return words;
  std::vector<std::string> present;
  bool only_inputs = false;
  for (std::string& word : words) {
    only_inputs = only_inputs || word == "--";
    const std::size_t end = std::min(word.find('='), word.size());
    const auto* const option = std::ranges::find_if(kFormerOptions, [&](const FormerOption& one) {
      return one.command == words.front() && word.compare(0, end, one.former) == 0;
    });
    if (!only_inputs && option != std::end(kFormerOptions)) {
      if (option->present.empty()) continue;
      word.replace(0, end, option->present);
    }
    present.push_back(word);
  }
  return present;
}

} // namespace patina::cli
