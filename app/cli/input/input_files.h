// Which files a command reads, for its report: by content, so that a published table can be
// checked.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/json.h"

namespace patina::cli {

// A list of {"path", "sha256"}, or {"path", "digest"} of a folder of pictures, in which names and
// sizes count. Of a workspace its workspace.json and its journal, which hold the hashes of the
// rest; of a scan folder each of its files and its frames. What is no file, such as standard input,
// has the SHA-256 null; what does not exist is left out.
Json describeInputs(const std::vector<std::filesystem::path>& paths);

// The file or folder in "replay:SCAN" or "SCAN"; none in "camera:0", "stream:PIPE" and the like.
std::vector<std::filesystem::path> filesOfSource(const std::string& source);

} // namespace patina::cli
