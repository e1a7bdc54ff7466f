// How much memory there is still to take.
#pragma once

#include <cstddef>
#include <string>

namespace patina {

// [bytes] that this process may still take: of the machine, and of its own limit (ulimit -v). An
// estimate; the largest size_t where the system does not say.
std::size_t memoryLeft();
// Whether its own limit is set.
bool memoryIsLimited();
// Error "WHAT needs about 2.1 GB of memory, and 300 MB are left" if that is so; `advice` follows
// it.
void requireMemory(double bytes, const std::string& what, const std::string& advice = "");
// The same, where a limit is set, before a library of many is loaded: with less, constructors of
// what it stands on end the program.
void requireRoomToLoad(const std::string& what);

} // namespace patina
