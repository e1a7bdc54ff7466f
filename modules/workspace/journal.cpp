#include "workspace/journal.h"

#include "core/append_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/utc_time.h"
#include "workspace/journal_lines.h"
#include "workspace/migrations.h"

namespace patina {
namespace {

constexpr std::int64_t kMaxSteps = 1'000'000'000;
constexpr std::int64_t kLatest = 100'000'000'000; // [s], the year 5138

struct Writer {
  Json& json;
  void operator()(const Stroke& stroke) const { json.set("stroke", toJson(stroke)); }
  void operator()(const ValueEdit& edit) const {
    Json list = Json::array(); // not an object: the order counts, and keys may repeat
    for (const auto& [key, value] : edit.values) {
      Json pair = Json::array();
      pair.push(key);
      pair.push(value);
      list.push(std::move(pair));
    }
    json.set("values", std::move(list));
  }
  void operator()(const StoredSceneEdit& edit) const {
    Json stored = Json::object();
    stored.set("what", edit.what).set("state", edit.state);
    json.set("scene", std::move(stored));
  }
  void operator()(const UndoEvent& event) const { json.set("undo", event.steps); }
  void operator()(const RedoEvent& event) const { json.set("redo", event.steps); }
};

ValueEdit valuesFrom(const Json& json) {
  ValueEdit edit;
  for (const Json& pair : json.asArray()) {
    const Json::Array& both = pair.asArray();
    if (both.size() != 2) throw Error("a value needs a key and a text");
    edit.values.emplace_back(both[0].asString(), both[1].asString());
  }
  migrateValues(edit.values); // a journal may be from an older version and is never changed
  return edit;
}

int stepsFrom(const Json& json) {
  const std::int64_t steps = json.asInteger();
  if (steps < 1 || steps > kMaxSteps) throw Error("steps must be 1 or more");
  return static_cast<int>(steps);
}

JournalEvent whatFrom(const Json& json) {
  if (const Json* stroke = json.find("stroke")) return strokeFrom(*stroke);
  if (const Json* list = json.find("values")) return valuesFrom(*list);
  if (const Json* stored = json.find("scene"))
    return StoredSceneEdit{stored->at("what").asString(), stored->at("state").asString()};
  if (const Json* steps = json.find("undo")) return UndoEvent{stepsFrom(*steps)};
  if (const Json* steps = json.find("redo")) return RedoEvent{stepsFrom(*steps)};
  throw Error("has no edit of a known kind");
}

std::string intentFrom(const Json& json) {
  const Json* intent = json.find("intent");
  return intent ? intent->asString() : "";
}

JournalEvent eventFrom(const Json& json) {
  JournalEvent event = whatFrom(json);
  event.intent = intentFrom(json);
  const Json* time = json.find("time");
  if (!time) return event;
  event.time = time->asInteger();
  if (event.time < 1 || event.time > kLatest) throw Error("time must be seconds since 1970");
  return event;
}

} // namespace

JournalText parseJournal(std::string_view text) {
  const JournalLines lines = journalLines(text);
  JournalText journal;
  journal.torn = lines.torn;
  journal.damaged_line = lines.damaged_line;
  journal.damage = lines.damage;
  for (std::size_t i = 0; i < lines.records.size(); ++i) {
    const JournalRecord& record = lines.records[i];
    try {
      const Json json = parseJson(record.text, "record");
      if (record.number == 0) {
        journal.from = json.at("from").asString();
        journal.intent = intentFrom(json);
      } else {
        journal.events.push_back(eventFrom(json));
      }
    } catch (const Error& error) {
      journal.torn = false;
      journal.damaged_line = i + 1;
      journal.damage = error.what();
      break;
    }
  }
  return journal;
}

std::string journalHeader(const std::string& from, const std::string& intent) {
  Json json = Json::object();
  json.set("n", 0).set("from", from);
  if (!intent.empty()) json.set("intent", intent);
  return withChecksum(json.dump(-1));
}

std::string journalLine(std::uint64_t number, const JournalEvent& event, bool more) {
  Json json = Json::object();
  json.set("n", static_cast<std::int64_t>(number));
  if (more) json.set("more", true); // journalLines() looks for it here
  if (event.time != 0) json.set("time", event.time);
  std::visit(Writer{json}, event);
  if (!event.intent.empty()) json.set("intent", event.intent);
  return withChecksum(json.dump(-1));
}

struct JournalWriter::Impl {
  AppendFile file;
  std::uint64_t events;
};

JournalWriter::JournalWriter(const std::filesystem::path& path, std::uint64_t events)
    : impl_(new Impl{AppendFile(path), events}) {
  const std::string text = impl_->file.content();
  const JournalLines lines = journalLines(text);
  const bool header = !lines.records.empty() && lines.records.front().number == 0;
  const std::size_t found = lines.records.size() - (header ? 1 : 0);
  const std::string wanted = " where " + std::to_string(events) + " were read";
  if (found < events)
    throw FileError(path.string(), 0, "has only " + std::to_string(found) + " records" + wanted);
  // A complete record that this program read and rejected counts as damaged, not as new.
  if (found > events && parseJournal(text).events.size() > events) {
    throw FileError(path.string(), 0,
                    "another program has written it since: " + std::to_string(found) + " records" +
                        wanted + "; open the workspace again");
  }
  const std::size_t kept = events + (header ? 1 : 0);
  const std::size_t end = kept == 0 ? 0 : lines.records[kept - 1].end;
  if (end == text.size()) return;
  if (!lines.torn || found > events)
    writeFileAtomically(path.string() + ".damaged", std::string_view(text).substr(end));
  impl_->file.truncate(end);
}

JournalWriter::~JournalWriter() = default;

void JournalWriter::append(std::vector<JournalEvent> events) {
  std::string text;
  for (std::size_t i = 0; i < events.size(); ++i) {
    JournalEvent& event = events[i];
    if (event.time == 0) event.time = utcSeconds();
    if (const Stroke* stroke = std::get_if<Stroke>(&event)) validate(*stroke);
    text += journalLine(impl_->events + i + 1, event, i + 1 < events.size());
  }
  impl_->file.append(text);
  impl_->events += events.size();
}

std::uint64_t JournalWriter::events() const {
  return impl_->events;
}

} // namespace patina
