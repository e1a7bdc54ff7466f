// Where the bytes of an output go: through links, pipes and devices, never in their place.
#pragma once

#include <filesystem>
#include <string>

namespace patina {

// "-": standard output, or as an input standard input. A file of that name is "./-".
bool isStandardStream(const std::filesystem::path& path);

struct OutputTarget {
  std::string path;       // a link's end; of a stream its own name
  int descriptor = -1;    // of a stream that the program was started with (/dev/stdout, /dev/fd/3)
  bool is_stream = false; // a descriptor, pipe or device: written as it comes, never replaced
  bool exists = false;
  unsigned permissions = 0666; // of what exists
};

// FileError if nothing can be written there: a folder, a ring of links, a read-only file (also for
// who may write it in spite of that), a socket. Nothing is opened.
OutputTarget outputTarget(const std::filesystem::path& path);

// Whether something is at `path`; FileError with its cause where that cannot be known.
bool pathExists(const std::filesystem::path& path);

} // namespace patina
