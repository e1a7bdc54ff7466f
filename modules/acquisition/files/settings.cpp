#include "acquisition/files/settings.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <string_view>

#include "core/error.h"
#include "core/line_buffer.h"
#include "core/utf8.h"

namespace patina {
namespace {

constexpr int kDeepest = 50; // lists within lists

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) + 1 - first);
}

std::string joinedPath(const std::string& parent, std::string_view key) {
  return parent.empty() ? std::string(key) : parent + "/" + std::string(key);
}

class Collector {
 public:
  explicit Collector(std::string file) : file_(std::move(file)) {}

  // Begins the setting of a path.
  Setting& begin(const std::string& path, std::size_t line) {
    const auto [found, is_new] = settings_.emplace(path, Setting{{}, line});
    if (!is_new) found->second.repeats = line;
    return found->second;
  }
  Setting& at(const std::string& path) { return settings_[path]; }
  [[noreturn]] void refuse(std::size_t line, const std::string& cause) const {
    throw FileError(file_, line, cause);
  }
  Settings take() { return std::move(settings_); }

 private:
  std::string file_;
  Settings settings_;
};

// The text without its tag ("!!opencv-matrix") and its quotes.
std::string_view plainScalar(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('!'))
    text = trimmed(text.substr(std::min(text.find_first_of(" \t"), text.size())));
  if (text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
      text.back() == text.front())
    text = text.substr(1, text.size() - 2);
  return text;
}

// The first of `stops` outside of quotes and brackets.
std::size_t findOutside(std::string_view text, std::string_view stops) {
  char quote = 0;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote) {
      if (c == quote) quote = 0;
      continue;
    }
    if (depth == 0 && stops.find(c) != std::string_view::npos) return i;
    const bool begins =
        i == 0 || std::string_view(" \t,:[{\n").find(text[i - 1]) != std::string_view::npos;
    if ((c == '"' || c == '\'') && begins) quote = c;
    depth += c == '[' || c == '{';
    depth -= c == ']' || c == '}';
  }
  return std::string_view::npos;
}

// A value in brackets or a scalar: its words become those of the path, its keys paths below it.
void readFlow(std::string_view text, const std::string& path, std::size_t line, int depth,
              Collector& out) {
  text = trimmed(text);
  if (depth > kDeepest) out.refuse(line, "has brackets within more than 50 others");
  if (!text.starts_with('[') && !text.starts_with('{')) {
    if (const auto scalar = plainScalar(text); !scalar.empty())
      out.at(path).words.emplace_back(scalar);
    return;
  }
  const bool map = text.front() == '{';
  if (text.back() != (map ? '}' : ']')) out.refuse(line, "has a bracket that does not close here");
  text = text.substr(1, text.size() - 2);
  while (!trimmed(text).empty()) {
    const std::size_t end = std::min(findOutside(text, ","), text.size());
    const std::string_view item = text.substr(0, end);
    const std::size_t colon = map ? findOutside(item, ":") : std::string_view::npos;
    if (colon == std::string_view::npos) {
      readFlow(item, path, line, depth + 1, out);
    } else {
      const std::string key = joinedPath(path, plainScalar(item.substr(0, colon)));
      out.begin(key, line);
      readFlow(item.substr(colon + 1), key, line, depth + 1, out);
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

// How many brackets are open at the end of the text.
int openBrackets(std::string_view text) {
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote) {
      if (c == quote) quote = 0;
    } else if (c == '"') {
      quote = c;
    } else {
      depth += c == '[' || c == '{';
      depth -= c == ']' || c == '}';
    }
  }
  return depth;
}

std::string_view withoutComment(std::string_view line) {
  const std::size_t hash = findOutside(line, "#");
  if (hash == std::string_view::npos) return line;
  if (hash == 0 || line[hash - 1] == ' ' || line[hash - 1] == '\t') return line.substr(0, hash);
  return line;
}

// Block mappings and sequences by their indents, with values in brackets. Anchors, references and
// texts of several lines are not part of any camera's file.
Settings parseYaml(std::string_view text, const std::string& name) {
  struct Level {
    std::size_t indent;
    std::string path;
  };
  Collector out(name);
  std::vector<Level> levels;
  LineBuffer lines;
  lines.append(text);
  std::string flow; // a value in brackets that goes on
  std::string flow_path;
  std::size_t number = 0, flow_line = 0;
  int flow_depth = 0;
  for (std::string_view whole; lines.next(whole, true);) {
    ++number;
    std::string_view line = withoutComment(whole);
    if (!flow.empty()) {
      flow.append("\n").append(line);
      flow_depth += openBrackets(line);
      if (flow_depth > 0) continue;
      readFlow(flow, flow_path, flow_line, 0, out);
      flow.clear();
      continue;
    }
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos || line[0] == '%' || trimmed(line) == "---" ||
        trimmed(line) == "...")
      continue;
    std::size_t indent = first;
    line = trimmed(line);
    // An item may stand as far left as the key that it belongs to.
    while (line == "-" || line.starts_with("- ")) {
      while (!levels.empty() && levels.back().indent > indent) levels.pop_back();
      line = trimmed(line.substr(1));
      indent += 2;
    }
    const bool item = indent > first;
    if (line.empty()) continue;
    const std::size_t colon = line.front() == '[' || line.front() == '{' ? std::string_view::npos
                                                                         : findOutside(line, ":");
    std::string path = levels.empty() ? "" : levels.back().path;
    std::string_view value = line;
    if (colon != std::string_view::npos) {
      while (!levels.empty() && levels.back().indent >= indent) levels.pop_back();
      path =
          joinedPath(levels.empty() ? "" : levels.back().path, plainScalar(line.substr(0, colon)));
      levels.push_back({indent, path});
      out.begin(path, number);
      value = trimmed(line.substr(colon + 1));
    } else if (!item && line.front() != '[' && line.front() != '{') {
      continue; // text that goes on
    }
    if (value.starts_with('!'))
      value = trimmed(value.substr(std::min(value.find(' '), value.size())));
    flow_depth = value.starts_with('[') || value.starts_with('{') ? openBrackets(value) : 0;
    if (flow_depth > 0) {
      flow = value;
      flow_path = path;
      flow_line = number;
    } else {
      readFlow(value, path, number, 0, out);
    }
  }
  if (!flow.empty()) out.refuse(flow_line, "has a bracket that never closes");
  return out.take();
}

Settings parseXml(std::string_view text, const std::string& name) {
  Collector out(name);
  std::vector<std::string> open; // paths; that of the root is empty
  std::size_t line = 1;
  const auto skip = [&](std::size_t count) {
    line += static_cast<std::size_t>(
        std::count(text.begin(), text.begin() + static_cast<long>(count), '\n'));
    text.remove_prefix(count);
  };
  while (!text.empty()) {
    const std::size_t next = std::min(text.find('<'), text.size());
    if (open.size() > 1) {
      std::istringstream words{std::string(text.substr(0, next))};
      for (std::string word; words >> word;)
        out.at(open.back()).words.emplace_back(plainScalar(word));
    }
    skip(next);
    if (text.empty()) break;
    const bool comment = text.starts_with("<!--");
    const std::size_t end = text.find(comment ? "-->" : ">");
    if (end == std::string_view::npos) out.refuse(line, "has a tag that never ends");
    const std::string_view tag = text.substr(1, end - 1);
    const bool closes = tag.starts_with('/');
    const std::string_view key = tag.substr(0, tag.find_first_of(" \t\r\n/"));
    if (closes && open.empty()) out.refuse(line, "closes a tag that was never opened");
    if (closes) {
      open.pop_back();
    } else if (!comment && !tag.starts_with('?') && !tag.starts_with('!')) {
      const std::string path = open.empty() ? "" : joinedPath(open.back(), key);
      if (open.size() > static_cast<std::size_t>(kDeepest))
        out.refuse(line, "has more than 50 tags in one another");
      if (!open.empty()) out.begin(path, line);
      if (!tag.ends_with('/')) open.push_back(path);
    }
    skip(end + (comment ? 3 : 1));
  }
  if (!open.empty()) out.refuse(line, "ends within the tag of '" + open.back() + "'");
  return out.take();
}

} // namespace

Settings parseSettings(const std::string& text, const std::string& name) {
  const std::string_view bytes = withoutByteOrderMark(text);
  return trimmed(bytes).starts_with('<') ? parseXml(bytes, name) : parseYaml(bytes, name);
}

} // namespace patina
