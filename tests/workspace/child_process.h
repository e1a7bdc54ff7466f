// Runs support/workspace_child with a fault of the disk (support/fault_shim).
#pragma once

#include <filesystem>
#include <string>
#include <sys/types.h>

namespace patina {

struct ChildFault {
  std::string kind; // kind of fault_shim's fault; "" = none
  int at = 0;
};

struct ChildEnd {
  int code = -1;        // 128 + signal if one ended it
  bool faulted = false; // the fault happened
  std::string out, err;
};

// Runs the child without a real flush: only the program fails here, not the machine.
ChildEnd runChild(const std::string& command, const std::filesystem::path& folder,
                  const ChildFault& fault);

// Runs "strokes"; its reports can be read from `out`. The caller kills and reaps it.
struct StrokesChild {
  pid_t pid = -1;
  int out = -1;
};
StrokesChild startStrokes(const std::filesystem::path& folder, unsigned seed, bool flush);

} // namespace patina
