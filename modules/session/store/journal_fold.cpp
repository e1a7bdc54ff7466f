#include "session/store/journal_fold.h"

#include "core/error.h"

namespace patina {
namespace {

bool fits(int steps, std::size_t most) {
  return steps >= 0 && static_cast<std::size_t>(steps) <= most;
}

} // namespace

FoldedJournal folded(const std::vector<JournalEvent>& journal, const std::string& name) {
  const auto refuse = [&](std::uint64_t number, const char* what) {
    throw FileError(name, 0,
                    "record " + std::to_string(number) + " " + what + " more than there is");
  };
  FoldedJournal fold;
  for (std::size_t i = 0; i < journal.size(); ++i) {
    const std::uint64_t number = i + 1;
    if (const auto* undo = std::get_if<UndoEvent>(&journal[i])) {
      if (!fits(undo->steps, fold.position)) refuse(number, "undoes");
      fold.position -= static_cast<std::size_t>(undo->steps);
    } else if (const auto* redo = std::get_if<RedoEvent>(&journal[i])) {
      if (!fits(redo->steps, fold.steps.size() - fold.position)) refuse(number, "redoes");
      fold.position += static_cast<std::size_t>(redo->steps);
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
