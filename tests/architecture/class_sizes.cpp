#include "architecture/class_sizes.h"

#include <cctype>
#include <set>
#include <string_view>

namespace patina::architecture {
namespace {

struct Token {
  std::string text; // a word, ::, or one character
  int line = 1;
};

bool isWordPart(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool isWord(const Token& token) {
  return isWordPart(token.text[0]);
}

// Behind what begins at `at` and is no part of the code: a comment, a literal, a directive. At `at`
// where nothing of that kind begins.
std::size_t behindSilent(const std::string& text, std::size_t at, bool line_begins) {
  const std::string_view rest = std::string_view(text).substr(at);
  const auto behind = [&](std::string_view end, std::size_t from) {
    const std::size_t found = text.find(end, at + from);
    return found == std::string::npos ? text.size() : found + end.size();
  };
  if (rest.starts_with("//")) return behind("\n", 2) - 1;
  if (rest.starts_with("/*")) return behind("*/", 2);
  if (rest.starts_with("R\"")) {
    const std::string mark(rest.substr(2, rest.find('(') - 2));
    return behind(")" + mark + "\"", 2);
  }
  if (line_begins && rest[0] == '#') {
    std::size_t end = at;
    while (end < text.size() && (text[end] != '\n' || text[end - 1] == '\\')) ++end;
    return end;
  }
  if (rest[0] != '"' && rest[0] != '\'') return at;
  std::size_t end = at + 1;
  while (end < text.size() && text[end] != rest[0]) end += text[end] == '\\' ? 2 : 1;
  return end + 1;
}

std::vector<Token> tokensOf(const std::string& text) {
  std::vector<Token> tokens;
  int line = 1;
  bool line_begins = true;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    std::size_t end = behindSilent(text, at, line_begins);
    if (end == at && std::isspace(static_cast<unsigned char>(c)) == 0) {
      end = at + (text.compare(at, 2, "::") == 0 ? 2 : 1);
      if (isWordPart(c)) // a number's ' parts no digits
        while (end < text.size() &&
               (isWordPart(text[end]) ||
                (text[end] == '\'' && std::isdigit(static_cast<unsigned char>(c)) != 0)))
          ++end;
      tokens.push_back({text.substr(at, end - at), line});
    }
    end = std::max(end, at + 1);
    if (c == '\n')
      line_begins = true;
    else if (std::isspace(static_cast<unsigned char>(c)) == 0)
      line_begins = false;
    for (; at < end && at < text.size(); ++at) line += text[at] == '\n' ? 1 : 0;
  }
  tokens.push_back({";", line}); // what is cut off ends here
  return tokens;
}

class Reader {
 public:
  explicit Reader(std::vector<Token> tokens) : tokens_(std::move(tokens)) {}

  std::vector<ClassSize> classes() {
    std::vector<ClassSize> found;
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
      at_ = i;
      ClassSize one;
      if (!enterClass(one)) continue;
      while (!ends() && !is("}")) one.methods += member() ? 1 : 0;
      found.push_back(one);
    }
    return found;
  }

 private:
  bool ends() const { return at_ + 1 >= tokens_.size(); }
  bool is(std::string_view text) const { return at_ < tokens_.size() && tokens_[at_].text == text; }
  bool isOne(const std::set<std::string>& of) const {
    return at_ < tokens_.size() && of.contains(tokens_[at_].text);
  }
  bool follows(std::string_view text) const { return !ends() && tokens_[at_ + 1].text == text; }

  // Behind the bracket that closes the one that is here.
  void skipBrackets() {
    int open = 0;
    do {
      if (isOne({"(", "[", "{"})) ++open;
      if (isOne({")", "]", "}"})) --open;
      ++at_;
    } while (open > 0 && !ends());
  }
  void skipAngles() {
    int open = 0;
    do {
      if (isOne({"(", "[", "{"})) {
        skipBrackets();
        continue;
      }
      if (is("<")) ++open;
      if (is(">")) --open;
      ++at_;
    } while (open > 0 && !ends());
  }
  // Behind the end of a statement.
  void skipStatement() {
    while (!ends() && !is(";")) isOne({"(", "[", "{"}) ? skipBrackets() : void(++at_);
    ++at_;
  }

  // Into the body, if a class is defined here.
  bool enterClass(ClassSize& one) {
    static const std::set<std::string> kKeys{"class", "struct", "union"};
    if (!isOne(kKeys) || (at_ > 0 && tokens_[at_ - 1].text == "enum")) return false;
    one.line = tokens_[at_].line;
    for (++at_; !ends();) {
      if (is("[")) {
        skipBrackets();
      } else if (is("alignas")) {
        ++at_;
        skipBrackets();
      } else if (is("<") && !one.name.empty()) { // of a specialization
        skipAngles();
      } else if (is("::")) {
        ++at_;
        one.name.clear();
      } else if (isWord(tokens_[at_]) && (one.name.empty() || is("final"))) {
        if (!is("final")) one.name = tokens_[at_].text;
        ++at_;
      } else {
        break;
      }
    }
    if (is(":"))
      while (!ends() && !isOne({"{", ";"})) is("<") ? skipAngles() : void(++at_);
    if (!is("{")) return false;
    ++at_;
    return true;
  }

  // Behind one member of a class. True: it is a method.
  bool member() {
    static const std::set<std::string> kAccess{"public",  "protected", "private",
                                               "signals", "slots",     "Q_SIGNALS"};
    static const std::set<std::string> kOthers{"friend", "using", "typedef", "static_assert",
                                               "enum"};
    if (isOne(kAccess) || isOne({":", ";"})) return ++at_, false;
    if (tokens_[at_].text.starts_with("Q_")) { // a macro has no ;
      if (++at_; is("(")) skipBrackets();
      return false;
    }
    if (isOne(kOthers)) return skipStatement(), false;
    if (is("template")) return ++at_, skipAngles(), member();
    const std::size_t begin = at_;
    if (ClassSize inner; enterClass(inner)) {
      --at_; // onto its {
      return skipStatement(), false;
    }
    at_ = begin;
    if (!reachParameters()) return skipStatement(), false;
    skipMethod();
    return true;
  }

  // Onto a method's parameters; false: it is none.
  bool reachParameters() {
    static const std::set<std::string> kWithBrackets{"alignas", "decltype", "explicit", "noexcept",
                                                     "requires"};
    while (!ends()) {
      if (is("operator")) {
        ++at_;
        if (is("(")) skipBrackets(); // a call's name
        while (!ends() && !is("(")) ++at_;
        return true;
      }
      if (isOne({";", "=", "{"})) return false;
      if (isOne(kWithBrackets) && follows("(")) {
        ++at_;
        skipBrackets();
      } else if (is("[")) {
        skipBrackets();
      } else if (is("<")) {
        skipAngles();
      } else if (is("(")) {
        return !pointsInBrackets();
      } else {
        ++at_;
      }
    }
    return false;
  }

  // Whether the bracket holds a name that is a pointer, as in void (*call)(int).
  bool pointsInBrackets() const {
    std::size_t i = at_ + 1;
    while (isWord(tokens_[i]) && tokens_[i + 1].text == "::") i += 2;
    return tokens_[i].text == "*" || tokens_[i].text == "&";
  }

  // From its parameters to behind its body, or behind its ; without one.
  void skipMethod() {
    skipBrackets();
    while (!ends() && !isOne({";", "{", ":"})) is("(") ? skipBrackets() : void(++at_);
    if (is(":")) skipInitializers();
    if (is("{")) return skipBrackets();
    ++at_;
  }
  void skipInitializers() {
    do {
      ++at_;
      while (!ends() && !isOne({"(", "{"})) is("<") ? skipAngles() : void(++at_);
      skipBrackets();
      while (is(".")) ++at_; // of a pack
    } while (is(","));
  }

  std::vector<Token> tokens_;
  std::size_t at_ = 0;
};

} // namespace

std::vector<ClassSize> classesIn(const std::string& text) {
  return Reader(tokensOf(text)).classes();
}

} // namespace patina::architecture
