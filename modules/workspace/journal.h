// The journal of a workspace: every edit, undo and redo, one record a line, none ever changed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene/edit.h"

namespace patina {

struct UndoEvent {
  int steps = 1;
  bool operator==(const UndoEvent&) const = default;
};
struct RedoEvent {
  int steps = 1;
  bool operator==(const RedoEvent&) const = default;
};
// A SceneEdit as it stands in the journal: its scene is a state file of the workspace.
struct StoredSceneEdit {
  std::string what;
  std::string state; // path relative to the folder
  bool operator==(const StoredSceneEdit&) const = default;
};
// Equal where the variants are, whenever they were done.
struct JournalEvent : std::variant<Stroke, ValueEdit, StoredSceneEdit, UndoEvent, RedoEvent> {
  using variant::variant;
  std::int64_t time = 0; // when, in seconds since 1970 UTC; 0 = not known: an older journal
};

struct JournalText {
  std::string from; // the state file that the first record follows; "" where no heading says so
  std::vector<JournalEvent> events; // whole records from the first on
  // What follows them: a record that was being written when the program or the machine stopped
  // (torn), or records that are damaged or out of order (line and cause).
  bool torn = false;
  std::size_t damaged_line = 0; // 0 = none
  std::string damage;
};
// A record carries its number (from 1) and a checksum over itself. Bounded; never throws for bad
// text.
JournalText parseJournal(std::string_view text);
std::string journalHeading(const std::string& from);                      // line 1, with '\n'
std::string journalLine(std::uint64_t number, const JournalEvent& event); // with '\n'

// The file open for appending, locked against a second writer. append() returns when the record is
// on disk (fsync). On failure throws FileError, and the file ends where it ended before.
class JournalWriter {
 public:
  // The file must exist (saveWorkspace begins it). Cuts off what follows the first `events`
  // records: a torn record; damaged ones are first copied beside the file, as NAME.damaged. Throws
  // FileError if the file is locked by another program, has fewer records, or has a whole one more:
  // then another program has written it since it was read.
  JournalWriter(const std::filesystem::path& path, std::uint64_t events);
  ~JournalWriter();
  // Stamped with the time now if it has none. Error, too, for a stroke that could not be read
  // again.
  void append(JournalEvent event);
  std::uint64_t events() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
