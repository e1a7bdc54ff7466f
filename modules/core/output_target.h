// Resolves an output path; links, pipes and devices are written through and never replaced.
#pragma once

#include <filesystem>
#include <string>

namespace patina {

// True for "-": standard output or, for an input, standard input. A file of that name is "./-".
bool isStandardStream(const std::filesystem::path& path);

struct OutputTarget {
  std::string path;       // target of a link; a stream's own name
  int descriptor = -1;    // descriptor inherited at the start (/dev/stdout, /dev/fd/3)
  bool is_stream = false; // a descriptor, pipe or device: written directly, never replaced
  bool exists = false;
  unsigned permissions = 0666; // permissions of an existing file
};

// Throws FileError for a folder, a cycle of links, a link that isForeignLink() names, a socket or a
// read-only file, even if the user's privileges would allow writing it. Opens nothing.
OutputTarget outputTarget(const std::filesystem::path& path);

// True if something exists at `path`. Throws FileError if that cannot be determined.
bool pathExists(const std::filesystem::path& path);

} // namespace patina
