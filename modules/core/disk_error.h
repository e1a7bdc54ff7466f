// Errors of the storage itself, as opposed to a file's content.
#pragma once

#include "core/error.h"

namespace patina {

// The system refused a call on the whole file (disk full, no memory); a retry may succeed.
class DiskError : public FileError {
 public:
  DiskError(const std::string& path, const std::string& cause) : FileError(path, 0, cause) {}
};

} // namespace patina
