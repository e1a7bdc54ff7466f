#include "core/utc_time.h"

#include <array>
#include <cstdlib>
#include <ctime>

#include "core/numbers.h"

namespace patina {

std::int64_t utcSeconds() {
  if (const char* fixed = std::getenv("SOURCE_DATE_EPOCH"))
    if (const auto seconds = parseNumber(fixed); seconds && *seconds >= 0 && *seconds < 1e11)
      return static_cast<std::int64_t>(*seconds);
  return std::time(nullptr);
}

std::string formatUtc(std::int64_t seconds) {
  const std::time_t time = seconds;
  std::tm parts{};
  if (!gmtime_r(&time, &parts)) return "";
  std::array<char, 40> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

} // namespace patina
