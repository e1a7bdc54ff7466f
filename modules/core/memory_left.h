// Memory that is still available.
#pragma once

#include <cstddef>
#include <string>

namespace patina {

// Estimated memory that this process may still allocate [bytes], limited by the machine and by its
// own limit (ulimit -v); the largest size_t if unknown.
std::size_t memoryLeft();
// True if the process has a memory limit of its own.
bool memoryIsLimited();
// Throws Error "WHAT needs about 2.1 GB of memory, and 300 MB are left" plus `advice`, if so.
void requireMemory(double bytes, const std::string& what, const std::string& advice = "");
// Same check before a library with many dependencies is loaded under a memory limit: their
// constructors would otherwise end the program.
void requireRoomToLoad(const std::string& what);

} // namespace patina
