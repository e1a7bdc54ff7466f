#include "app/journal_fold.h"

#include <string>

#include "core/error.h"

namespace patina {
namespace {

std::size_t stepsOf(int steps, std::size_t most, std::uint64_t number, const char* what) {
  if (steps < 0 || static_cast<std::size_t>(steps) > most)
    throw Error("journal: record " + std::to_string(number) + " " + what + " more than there is");
  return static_cast<std::size_t>(steps);
}

} // namespace

FoldedJournal folded(const std::vector<JournalEvent>& journal) {
  FoldedJournal fold;
  for (std::size_t i = 0; i < journal.size(); ++i) {
    const std::uint64_t number = i + 1;
    if (const auto* undo = std::get_if<UndoEvent>(&journal[i])) {
      fold.position -= stepsOf(undo->steps, fold.position, number, "undoes");
    } else if (const auto* redo = std::get_if<RedoEvent>(&journal[i])) {
      const std::size_t undone = fold.steps.size() - fold.position;
      fold.position += stepsOf(redo->steps, undone, number, "redoes");
    } else {
      fold.steps.resize(fold.position);
      fold.steps.push_back({&journal[i], number});
      ++fold.position;
    }
    fold.position_at.push_back(fold.position);
  }
  return fold;
}

} // namespace patina
