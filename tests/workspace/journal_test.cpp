#include "workspace/journal.h"

#include <fstream>

#include "workspace/workspace_support.h"

namespace patina {
namespace {

const std::vector<JournalEvent>& everyKind() {
  static const std::vector<JournalEvent> kEvents{
      someStroke(5, 800),
      ValueEdit{{{"stiffness", "800"}, {"relief.height", "0.5mm"}, {"stiffness", "700"}}},
      StoredSceneEdit{"add \"pot\"\nand \x01", "states/3-0123456789abcdef.json"},
      UndoEvent{2},
      RedoEvent{1},
      someStroke(0, 1.0 / 3)};
  return kEvents;
}

std::string textOf(const std::vector<JournalEvent>& events) {
  std::string text = journalHeader("states/0-a.json");
  for (std::size_t i = 0; i < events.size(); ++i) text += journalLine(i + 1, events[i]);
  return text;
}

bool isWhole(const JournalText& journal) {
  return !journal.torn && journal.damaged_line == 0;
}

TEST(Journal, ReadsBackEveryKindOfRecord) {
  const std::string text = textOf(everyKind());
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 7);
  const JournalText journal = parseJournal(text);
  EXPECT_TRUE(isWhole(journal)) << journal.damage;
  EXPECT_EQ(journal.from, "states/0-a.json");
  EXPECT_EQ(journal.events, everyKind());
}

TEST(Journal, RecordsKeepTheirTimeAndOlderOnesHaveNone) {
  JournalEvent stroke = someStroke(1, 800);
  stroke.time = 1795597607;
  const JournalText journal = parseJournal(journalLine(1, stroke) + journalLine(2, UndoEvent{}));
  ASSERT_EQ(journal.events.size(), 2u);
  EXPECT_EQ(journal.events[0].time, 1795597607);
  EXPECT_EQ(journal.events[1].time, 0);
  for (const std::int64_t never : {std::int64_t{-1}, std::int64_t{1} << 60}) {
    stroke.time = never;
    EXPECT_NE(parseJournal(journalLine(1, stroke)).damaged_line, 0u) << never;
  }
}

// A record's position in the history stays, even if none of its values is left.
TEST(Journal, ConvertsValuesOfOlderVersions) {
  const JournalText journal = parseJournal(
      textOf({ValueEdit{{{"history", "off"}, {"contact", "potential"}, {"stiffness", "700"}}},
              ValueEdit{{{"history", "on"}}}, ValueEdit{{{"contact", "ray"}}}}));
  EXPECT_TRUE(isWhole(journal)) << journal.damage;
  const std::vector<JournalEvent> today{ValueEdit{{{"contact", "proxy"}, {"stiffness", "700"}}},
                                        ValueEdit{}, ValueEdit{{{"contact", "ray"}}}};
  EXPECT_EQ(journal.events, today);
}

TEST(Journal, KeepsWholeRecordsIfCutAnywhere) {
  const std::string text = textOf(everyKind());
  for (std::size_t size = 0; size <= text.size(); ++size) {
    const JournalText journal = parseJournal(text.substr(0, size));
    const auto lines = static_cast<std::size_t>(std::count(text.data(), text.data() + size, '\n'));
    ASSERT_EQ(journal.events.size(), lines == 0 ? 0 : lines - 1) << size;
    ASSERT_EQ(journal.torn, size > 0 && text[size - 1] != '\n') << size;
    ASSERT_EQ(journal.damaged_line, 0u) << size;
  }
}

// After a power failure a record's end may be on the disk and earlier blocks not.
TEST(Journal, LastRecordWithZerosIsTorn) {
  std::string text = textOf({someStroke(3, 1), someStroke(300, 2)});
  std::fill_n(text.end() - 5000, 4096, '\0');
  const JournalText journal = parseJournal(text);
  EXPECT_TRUE(journal.torn);
  EXPECT_EQ(journal.events.size(), 1u);
}

TEST(Journal, FindsAnyChangedByteWithItsLine) {
  const std::string text = textOf(everyKind());
  std::size_t line = 1;
  for (std::size_t at = 0; at < text.size(); ++at) {
    std::string changed = text;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    const JournalText journal = parseJournal(changed);
    ASSERT_FALSE(isWhole(journal)) << at;
    ASSERT_LT(journal.events.size(), line) << at;
    // The last newline is left out: without it the last record looks unfinished.
    if (at + 1 < text.size()) {
      ASSERT_EQ(journal.damaged_line, line) << at;
    }
    if (text[at] == '\n') ++line;
  }
}

TEST(Journal, RecordsOutOfOrderAreDamage) {
  const std::string one = journalLine(1, UndoEvent{}), two = journalLine(2, UndoEvent{});
  EXPECT_EQ(parseJournal(two).damaged_line, 1u);
  EXPECT_EQ(parseJournal(one + one).damaged_line, 2u);
  EXPECT_EQ(parseJournal(one + journalLine(3, UndoEvent{})).damage,
            "record 3 stands where record 2 should");
  EXPECT_EQ(parseJournal(one + journalHeader("x")).damaged_line, 2u);
  EXPECT_TRUE(isWhole(parseJournal(one + two)));
}

TEST(Journal, InvalidRecordsAreDamageEvenWithAValidChecksum) {
  for (const JournalEvent& event : std::vector<JournalEvent>{UndoEvent{0}, RedoEvent{-1}}) {
    const JournalText journal = parseJournal(journalLine(1, event));
    EXPECT_EQ(journal.damaged_line, 1u);
    EXPECT_EQ(journal.damage, "steps must be 1 or more");
  }
  Stroke stroke = someStroke(2, 100);
  stroke.brush.radius = -1;
  EXPECT_NE(parseJournal(journalLine(1, stroke)).damage, "");
}

class JournalFileTest : public WorkspaceTest {
 protected:
  JournalFileTest() : path(root / "journal-1.jsonl") { writeFileAtomically(path, textOf({})); }
  std::filesystem::path path;
};

TEST_F(JournalFileTest, AppendedRecordsAreOnDiskAtOnce) {
  setenv("SOURCE_DATE_EPOCH", "1764000000", 1);
  JournalWriter writer(path, 0);
  for (std::size_t i = 0; i < everyKind().size(); ++i) {
    writer.append(everyKind()[i]);
    EXPECT_EQ(writer.events(), i + 1);
    EXPECT_EQ(parseJournal(readFile(path)).events.size(), i + 1);
  }
  unsetenv("SOURCE_DATE_EPOCH");
  std::vector<JournalEvent> stamped = everyKind();
  for (JournalEvent& event : stamped) event.time = 1764000000;
  EXPECT_EQ(readFile(path), textOf(stamped));
}

// A command that was killed while it wrote its records has not happened.
TEST_F(JournalFileTest, RecordsWrittenTogetherCountTogetherIfCutAnywhere) {
  JournalWriter(path, 0).append(UndoEvent{});
  const std::string before = readFile(path);
  JournalWriter(path, 1).append(everyKind());
  const std::string text = readFile(path);
  for (std::size_t size = before.size(); size <= text.size(); ++size) {
    const JournalText journal = parseJournal(std::string_view(text).substr(0, size));
    EXPECT_EQ(journal.damaged_line, 0u) << size;
    EXPECT_EQ(journal.torn, size > before.size() && size < text.size()) << size;
    EXPECT_EQ(journal.events.size(), size < text.size() ? 1 : 1 + everyKind().size()) << size;
  }
  const std::size_t third = text.find("{\"n\":4");
  writeFileAtomically(path, text.substr(0, third));
  JournalWriter(path, 1).append(RedoEvent{});
  EXPECT_EQ(parseJournal(readFile(path)).events,
            (std::vector<JournalEvent>{UndoEvent{}, RedoEvent{}}));
}

TEST(Journal, KeepsTheCallersNameOfACommand) {
  JournalEvent undo = UndoEvent{};
  undo.intent = "try-1";
  const JournalText journal = parseJournal(journalHeader("states/0-a.json", "make") +
                                           journalLine(1, undo) + journalLine(2, UndoEvent{}));
  EXPECT_EQ(journal.intent, "make");
  ASSERT_EQ(journal.events.size(), 2u);
  EXPECT_EQ(journal.events[0].intent, "try-1");
  EXPECT_EQ(journal.events[1].intent, "");
}

TEST_F(JournalFileTest, ContinuesAfterATornRecord) {
  writeFileAtomically(path, textOf(everyKind()) + "{\"n\":7,\"stro");
  JournalWriter(path, 6).append(UndoEvent{});
  const JournalText journal = parseJournal(readFile(path));
  EXPECT_TRUE(isWhole(journal));
  EXPECT_EQ(journal.events.size(), 7u);
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".damaged"));
}

TEST_F(JournalFileTest, KeepsACopyOfRemovedDamagedRecords) {
  const std::string good = textOf({UndoEvent{}}), bad = "garbage\n" + journalLine(3, UndoEvent{});
  writeFileAtomically(path, good + bad);
  JournalWriter(path, 1).append(RedoEvent{});
  EXPECT_EQ(parseJournal(readFile(path)).events,
            (std::vector<JournalEvent>{UndoEvent{}, RedoEvent{}}));
  EXPECT_EQ(readFile(path.string() + ".damaged"), bad);
}

TEST_F(JournalFileTest, RefusesASecondWriter) {
  const JournalWriter first(path, 0);
  EXPECT_TRUE(says(errorOf([&] { JournalWriter(path, 0); }), "another program is writing it"));
}

TEST_F(JournalFileTest, KeepsRecordsThatAnotherProgramAppended) {
  JournalWriter(path, 0).append(UndoEvent{});
  const std::string before = readFile(path);
  EXPECT_TRUE(says(errorOf([&] { JournalWriter(path, 0); }), "another program has written"));
  EXPECT_TRUE(says(errorOf([&] { JournalWriter(path, 2); }), "only 1 records where 2 were read"));
  EXPECT_EQ(readFile(path), before);
}

TEST_F(JournalFileTest, RefusesAnUnreadableStroke) {
  JournalWriter writer(path, 0);
  Stroke stroke = someStroke(2, 100);
  stroke.samples[1].position.x() = std::nan("");
  EXPECT_THROW(writer.append(stroke), Error);
  EXPECT_EQ(writer.events(), 0u);
  writer.append(someStroke(2, 100));
  EXPECT_TRUE(isWhole(parseJournal(readFile(path))));
}

TEST_F(JournalFileTest, NamesAMissingFile) {
  EXPECT_TRUE(says(errorOf([&] { JournalWriter(root / "none.jsonl", 0); }), "none.jsonl: cannot"));
}

} // namespace
} // namespace patina
