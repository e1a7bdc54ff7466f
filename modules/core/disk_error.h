// Errors of the disk rather than of what is on it.
#pragma once

#include "core/error.h"

namespace patina {

// The system refused a call on the file (full, damaged, no memory): the file as a whole, and
// another time it may work.
class DiskError : public FileError {
 public:
  DiskError(const std::string& path, const std::string& cause) : FileError(path, 0, cause) {}
};

} // namespace patina
