// Identifies a command's input files by content, for its report, so that published tables can be
// verified.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/json.h"

namespace patina::cli {

// Returns a list of {"path", "sha256"}, or {"path", "digest"} for a folder of pictures, which
// covers names and sizes. A workspace gives its workspace.json and journal, which contain the other
// hashes; a scan folder gives each of its files and its frames. Inputs that are not files, such as
// standard input, have the SHA-256 null; missing files are left out.
Json describeInputs(const std::vector<std::filesystem::path>& paths);

// File or folder in "replay:SCAN" or "SCAN"; none in "camera:0", "stream:PIPE" and similar sources.
std::vector<std::filesystem::path> filesOfSource(const std::string& source);

} // namespace patina::cli
