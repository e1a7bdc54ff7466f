// Citations in comments and documents, and whether docs/mathematics.md defines them.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "architecture/project_files.h"

namespace patina::architecture {

// Items are the first cells of table rows ("K05", "T-K06b"), sections the numbers of headings and
// bold labels ("2.1", "2.1.7"). The result has one entry for each definition.
std::vector<std::string> definitionsIn(const std::string& mathematics);

// Returns one line for each item, numbered section or document that `defined` does not contain:
// "path:line: cause". Sections are cited with the document's name and a number; others are errors.
std::vector<std::string> unresolvedCitations(const SourceFile& file,
                                             const std::set<std::string>& defined);

// Returns the anchors of a document's headings: "## Where to start" is "where-to-start".
std::set<std::string> anchorsIn(const std::string& document);

} // namespace patina::architecture
