// Journal of a workspace: every edit, undo and redo, one record per line, append-only.
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
// A SceneEdit in the journal: its scene is a state file of the workspace.
struct StoredSceneEdit {
  std::string what;
  std::string state; // path relative to the folder
  bool operator==(const StoredSceneEdit&) const = default;
};
// Equality ignores time and intent.
struct JournalEvent : std::variant<Stroke, ValueEdit, StoredSceneEdit, UndoEvent, RedoEvent> {
  using variant::variant;
  std::int64_t time = 0; // seconds since 1970 UTC; 0 = unknown, as in an older journal
  std::string intent;    // --intent of the command that made it; may be empty
};

struct JournalText {
  std::string from;                 // state file before the first record; "" without a header
  std::string intent;               // --intent of the command that made the file; may be empty
  std::vector<JournalEvent> events; // complete records up to the first fault
  // Fault after them: an incomplete record from a crash (torn), or damaged records or records out
  // of order (line and cause).
  bool torn = false;
  std::size_t damaged_line = 0; // 0 = none
  std::string damage;
};
// A record has a number (from 1) and a checksum. Memory is bounded; invalid text does not throw.
JournalText parseJournal(std::string_view text);
// Both functions return a line with its '\n'. `more`: the record counts only with the next one.
std::string journalHeader(const std::string& from, const std::string& intent = {});
std::string journalLine(std::uint64_t number, const JournalEvent& event, bool more = false);

// Appends to the file and locks it against other writers. append() returns when the records are on
// disk (fsync); after a crash all of them are there or none. On failure it throws FileError and
// leaves the file unchanged.
class JournalWriter {
 public:
  // The file must exist (saveWorkspace makes it). Truncates it after the first `events` records;
  // damaged records are first copied to NAME.damaged. Throws FileError if another program holds the
  // lock, if the file has fewer records, or if it has more because another program wrote to it.
  JournalWriter(const std::filesystem::path& path, std::uint64_t events);
  ~JournalWriter();
  // Adds the present time to events that have none. Throws Error for a stroke that could not be
  // read again.
  void append(std::vector<JournalEvent> events);
  void append(JournalEvent event) { append(std::vector<JournalEvent>{std::move(event)}); }
  std::uint64_t events() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
