// Time stamps for files.
#pragma once

#include <cstdint>
#include <string>

namespace patina {

// Seconds since 1970, UTC, or SOURCE_DATE_EPOCH for reproducible files. Any thread.
std::int64_t utcSeconds();
std::string formatUtc(std::int64_t seconds); // "2026-11-25T09:06:47Z"

} // namespace patina
