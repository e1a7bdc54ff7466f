// Folds a journal into the edits that are still in the history, and its undo position.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "workspace/journal.h"

namespace patina {

// Holds pointers into the journal.
struct FoldedJournal {
  struct Step {
    const JournalEvent* event = nullptr; // an edit
    std::uint64_t number = 0;            // number of that record, from 1
  };
  std::vector<Step> steps;  // without those undone for good
  std::size_t position = 0; // number of applied steps; the others can be redone
  // Position after each record, by its number.
  std::vector<std::size_t> position_at{0};
};

// Throws FileError(name) if a record undoes or redoes more steps than there are.
FoldedJournal folded(const std::vector<JournalEvent>& journal, const std::string& name);

} // namespace patina
