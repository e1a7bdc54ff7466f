// A journal read to its end: which edits stand, and where the history stands among them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "workspace/journal.h"

namespace patina {

// Points into the journal that it was made of.
struct FoldedJournal {
  struct Step {
    const JournalEvent* event = nullptr; // an edit
    std::uint64_t number = 0;            // of that record, from 1
  };
  std::vector<Step> steps;  // those not undone for good
  std::size_t position = 0; // how many of them are done; the others can be redone
  // After each record, by its number: the position at that time.
  std::vector<std::size_t> position_at{0};
};

// Throws FileError(name) for a record that undoes or redoes more than there is.
FoldedJournal folded(const std::vector<JournalEvent>& journal, const std::string& name);

} // namespace patina
