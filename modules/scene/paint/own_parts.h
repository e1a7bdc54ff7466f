// Which parts of a copy-on-write value nobody else has seen.
#pragma once

#include <set>
#include <vector>

namespace patina {

// Of the same parts, with none of them in it.
template <class T> std::set<T> noneOf(const std::set<T>&) {
  return {};
}
template <class T> std::vector<T> noneOf(const std::vector<T>& flags) {
  return std::vector<T>(flags.size());
}

// A set that does not follow a copy: the copy shares every part, so none is its own. The counts of
// shared pointers cannot tell: that another thread has let go of a part does not say that its last
// reading of it is over. (The one that is copied must be told by published().)
template <class Set> struct OwnParts {
  Set set;

  OwnParts() = default;
  OwnParts(const OwnParts& other) : set(noneOf(other.set)) {}
  OwnParts(OwnParts&&) noexcept = default;
  OwnParts& operator=(const OwnParts& other) {
    set = noneOf(other.set);
    return *this;
  }
  OwnParts& operator=(OwnParts&&) noexcept = default;
  ~OwnParts() = default;
};

} // namespace patina
