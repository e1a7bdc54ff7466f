#include "visualization/files/xml_tags.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>

#include "core/error.h"

namespace patina {
namespace {

constexpr int kMaxDepth = 32; // a .vti has six levels
constexpr int kMaxElements = 10000;
constexpr std::size_t kLongestTag = 8192;
constexpr std::size_t kMaxMarkup = std::size_t{4} << 20; // bytes of tags and comments

class TagScan {
 public:
  TagScan(std::string name, const VisitTag& visit) : name_(std::move(name)), visit_(visit) {}

  // Returns false once the appended data are reached.
  bool take(std::string_view bytes) {
    while (!bytes.empty() && !appended_) {
      if (!in_markup_) {
        const std::size_t at = bytes.find('<');
        position_ += std::min(at, bytes.size());
        if (at == bytes.npos) break;
        bytes.remove_prefix(at);
        in_markup_ = true;
        ++position_;
      } else {
        ++position_;
        takeMarkup(bytes.front());
      }
      bytes.remove_prefix(1);
    }
    return !appended_;
  }

  void end() const {
    if (!appended_ && (depth_ > 0 || in_markup_)) fail("an element has no end");
  }

 private:
  [[noreturn]] void fail(const std::string& cause) const {
    throw FileError(name_, 0, "cannot be read: truncated or damaged: " + cause);
  }

  bool isEnd(char c) {
    if (markup_.starts_with("!--"))
      return c == '>' && markup_.size() >= 5 && markup_.ends_with("--");
    if (markup_.starts_with('?')) return c == '>' && markup_.ends_with('?');
    if (quote_ != 0) {
      if (c == quote_) quote_ = 0;
      return false;
    }
    if (c == '"' || c == '\'') quote_ = c;
    return c == '>';
  }

  void takeMarkup(char c) {
    if (++size_ > kMaxMarkup) fail("its tags and comments take more than 4 MB");
    if (!isEnd(c)) {
      markup_ += c;
      return;
    }
    finishMarkup();
    markup_.clear();
    in_markup_ = false;
  }

  // A reader that searches bytes instead of tags would take either for the end of a tag, behind
  // which data begin, or for the appended data.
  void refuseHiddenMarkup() const {
    if (markup_.starts_with("!--") || markup_.starts_with('?')) {
      if (markup_.find("<AppendedData") != markup_.npos) fail("a comment holds <AppendedData");
      return;
    }
    const bool has_data =
        markup_.starts_with("AppendedData") || (attributeOf(markup_, "format").data() != nullptr &&
                                                attributeOf(markup_, "offset").data() == nullptr);
    if (has_data && markup_.find('>') != markup_.npos)
      fail("an attribute has '>' before data: write &gt;");
    if (markup_.find("<AppendedData") != markup_.npos) fail("an attribute holds <AppendedData");
  }

  void finishMarkup() {
    refuseHiddenMarkup();
    if (markup_.starts_with("!--") || markup_.starts_with('?')) return;
    if (markup_.starts_with('!')) fail("it has a document type or raw text, which no .vti has");
    if (markup_.size() > kLongestTag) fail("a tag is longer than 8 kB");
    if (markup_.starts_with('/')) {
      if (--depth_ < 0) fail("an element ends that was not begun");
      return;
    }
    appended_ = markup_.starts_with("AppendedData");
    if (++elements_ > kMaxElements) fail("it has more than 10000 elements");
    visit_(markup_, position_, depth_);
    if (!markup_.ends_with('/') && ++depth_ > kMaxDepth)
      fail("its elements are nested more than 32 levels deep");
  }

  std::string name_;
  const VisitTag& visit_;
  std::string markup_; // between the angle brackets so far
  char quote_ = 0;
  bool in_markup_ = false, appended_ = false;
  int depth_ = 0, elements_ = 0;
  std::size_t size_ = 0;
  std::uint64_t position_ = 0; // offset in the file of what follows
};

} // namespace

void forEachTag(const std::filesystem::path& path, const VisitTag& visit) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 65536> part;
  TagScan scan(path.string(), visit);
  bool more = true;
  while (more && (file.read(part.data(), part.size()), file.gcount() > 0))
    more = scan.take({part.data(), static_cast<std::size_t>(file.gcount())});
  scan.end();
}

std::string_view attributeOf(std::string_view tag, std::string_view name) {
  constexpr std::string_view kBlanks = " \t\r\n";
  for (std::size_t at = tag.find_first_of(kBlanks); at < tag.size();) {
    const std::size_t begin = tag.find_first_not_of(kBlanks, at), equals = tag.find('=', begin);
    if (begin == tag.npos || equals == tag.npos) return {};
    const std::size_t open = tag.find_first_not_of(kBlanks, equals + 1);
    if (open == tag.npos || (tag[open] != '"' && tag[open] != '\'')) return {};
    const std::size_t close = tag.find(tag[open], open + 1);
    if (close == tag.npos) return {};
    std::string_view key = tag.substr(begin, equals - begin);
    key = key.substr(0, key.find_first_of(kBlanks));
    if (key == name) return tag.substr(open + 1, close - open - 1);
    at = close + 1;
  }
  return {};
}

} // namespace patina
