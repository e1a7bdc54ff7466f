// Plain words: how comments begin, and words that the tree no longer uses.
#pragma once

#include <string>
#include <vector>

#include "architecture/project_files.h"

namespace patina::architecture {

// Returns "path:line: text" for each comment that begins with a preposition or a conjunction, is a
// clause with "what" or "who" for a subject, or trails a line of code as "// of …".
std::vector<std::string> commentsWithoutSubject(const SourceFile& file);

// Returns "path:line: word" for each of `words` that stands alone in the file: an identifier or a
// word of a comment. Text in string literals is not read, because files hold old keys for ever.
std::vector<std::string> retiredWords(const SourceFile& file,
                                      const std::vector<std::string>& words);

} // namespace patina::architecture
