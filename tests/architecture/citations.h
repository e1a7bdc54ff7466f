// What comments and documents cite, and whether it stands in docs/mathematics.md.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "architecture/project_files.h"

namespace patina::architecture {

// Items are the first cells of table rows ("K05", "T-K06b"), sections the numbers of headings and
// bold labels ("2.1", "2.1.7"). Once for each time that one is defined.
std::vector<std::string> definitionsIn(const std::string& mathematics);

// One line for each item, numbered section or document that `defined` does not hold: "path:line:
// cause". Sections are cited with the document's name and a number; without it they lead nowhere.
std::vector<std::string> unresolvedCitations(const SourceFile& file,
                                             const std::set<std::string>& defined);

// The anchors that headings of a document make: "## Where to start" is "where-to-start".
std::set<std::string> anchorsIn(const std::string& document);

} // namespace patina::architecture
