// Which parts of a copy-on-write value nobody else has seen.
#pragma once

namespace patina {

// A set that does not follow a copy: the copy shares every part, so none is its own. The counts of
// shared pointers cannot tell: that another thread has let go of a part does not say that its last
// reading of it is over. (The one that is copied must be told by published().)
template <class Set> struct OwnParts {
  Set set;

  OwnParts() = default;
  OwnParts(const OwnParts&) {}
  OwnParts(OwnParts&&) noexcept = default;
  OwnParts& operator=(const OwnParts&) {
    set = Set();
    return *this;
  }
  OwnParts& operator=(OwnParts&&) noexcept = default;
  ~OwnParts() = default;
};

} // namespace patina
