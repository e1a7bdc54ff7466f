// When something was done, for records that outlive the program.
#pragma once

#include <cstdint>
#include <string>

namespace patina {

// Seconds since 1970, UTC. SOURCE_DATE_EPOCH in the environment takes the clock's place, so that
// the same work gives the same files. Any thread.
std::int64_t utcSeconds();
std::string formatUtc(std::int64_t seconds); // "2026-11-25T09:06:47Z"

} // namespace patina
