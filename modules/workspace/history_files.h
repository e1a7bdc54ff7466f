// The journal and the states of a workspace as files. Internal to the workspace.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "workspace/journal_lines.h"
#include "workspace/manifest.h"
#include "workspace/workspace.h"

namespace patina {

std::vector<std::string> journalNames(const std::filesystem::path& folder); // newest first
std::string nextJournalName(const std::filesystem::path& folder);

// Checksum of record `event` (0: the header); "" if there is no such record.
std::string checksumOf(const JournalLines& lines, std::uint64_t event);
std::uint64_t countOf(const JournalLines& lines); // without the header
// state file that the journal starts from; "" if there is no header
std::string headerOf(const JournalLines& lines);
// States named by records, each with its record's number.
std::vector<StoredState> statesIn(const JournalLines& lines);

// Returns why the journal does not belong to a workspace saved with this first state; "" if it
// does. `check` "" = unknown.
std::string mismatch(const JournalLines& lines, const std::string& first_state, std::uint64_t event,
                     const std::string& checksum);

// Removes files with names that saving uses, if nothing refers to them. Files that cannot be
// removed or checked stay and only take space.
void removeUnused(const std::filesystem::path& folder, const Manifest& manifest,
                  const JournalLines& lines);

// Recovers what is readable (openWorkspace with `recover`).
OpenedWorkspace recoverWorkspace(const std::filesystem::path& folder);

} // namespace patina
