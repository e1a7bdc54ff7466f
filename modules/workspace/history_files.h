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

// The check of record `event` (0: of the heading); "" if there is no such record.
std::string checkOf(const JournalLines& lines, std::uint64_t event);
std::uint64_t countOf(const JournalLines& lines); // without the heading
std::string headingOf(const JournalLines& lines); // the state it begins from; "" without one
// States that records name, each with its record's number.
std::vector<StoredState> statesIn(const JournalLines& lines);

// Why this is not the journal that a workspace with this first state was saved with; "" if it is.
// `check` "" = not known.
std::string mismatch(const JournalLines& lines, const std::string& first_state, std::uint64_t event,
                     const std::string& check);

// Files under names that saving gives, which nothing needs any more. Whatever cannot be removed,
// or judged, stays: it only takes room.
void removeUnused(const std::filesystem::path& folder, const Manifest& manifest,
                  const JournalLines& lines);

// What can still be read (openWorkspace with `recover`).
OpenedWorkspace recoverWorkspace(const std::filesystem::path& folder);

} // namespace patina
