// Flags the parts of a copy-on-write value that no copy shares.
#pragma once

#include <set>
#include <vector>

namespace patina {

// Returns flags for the same parts, all unset.
template <class T> std::set<T> sharedCopy(const std::set<T>&) {
  return {};
}
template <class T> std::vector<T> sharedCopy(const std::vector<T>& flags) {
  return std::vector<T>(flags.size());
}

// Set of the parts that no copy shares. A copy starts empty, because it shares every part; the
// owner's published() must then clear the original. Reference counts cannot replace this: a thread
// that dropped its pointer may still be reading.
template <class Set> struct UniqueFlags {
  Set set;

  UniqueFlags() = default;
  UniqueFlags(const UniqueFlags& other) : set(sharedCopy(other.set)) {}
  UniqueFlags(UniqueFlags&&) noexcept = default;
  UniqueFlags& operator=(const UniqueFlags& other) {
    set = sharedCopy(other.set);
    return *this;
  }
  UniqueFlags& operator=(UniqueFlags&&) noexcept = default;
  ~UniqueFlags() = default;
};

} // namespace patina
