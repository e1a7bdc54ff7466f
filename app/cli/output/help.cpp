#include "app/cli/output/help.h"

#include <algorithm>
#include <sstream>

#include "core/version.h"

namespace patina::cli {

namespace {

const char* const kAbout = "A workspace for touch research: a mesh becomes a sampled implicit "
                           "surface, and a 1 kHz servo feels it.";
const char* const kUnits =
    "All numbers are SI. A length may carry its unit (um mm cm m in): 1.5mm. Meshes have no unit: "
    "--unit says what theirs is.";
const char* const kExitCodes[] = {
    "0    done",
    "1    the numerics did not succeed; the report is printed",
    "2    bad input or usage; one line on stderr says what and where",
    "130  cancelled (Ctrl-C, SIGTERM, SIGHUP); no file was touched (what runs until then: 0)",
};

using Lines = std::vector<std::pair<std::string, std::string>>; // name and caption

std::vector<std::string> paragraphs(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

std::string namesOf(const Argument& argument) {
  std::string names;
  for (const char c : argument.names) names += c == ',' ? std::string(", ") : std::string(1, c);
  return argument.isInput() || argument.isFlag() ? names : names + " " + argument.value;
}

std::string inBrackets(const std::string& text) {
  return text.empty() ? "" : " [" + text + "]";
}

// Skips full stops inside file names.
std::size_t firstStop(const std::string& text) {
  for (std::size_t at = 0; (at = text.find_first_of(".;:", at)) != std::string::npos; ++at)
    if (at + 1 == text.size() || text[at + 1] == ' ') return at;
  return text.size();
}

// Puts the unit before the caption's full stop.
std::string textOf(const Argument& argument) {
  std::string text = argument.caption;
  if (!argument.unit.empty()) text.insert(firstStop(text), inBrackets(argument.unit));
  if (argument.isRepeated()) text += " May be given more than once.";
  if (argument.isRequired() && !argument.isInput()) text += " Required.";
  return text + inBrackets(argument.fallback);
}

std::string nameOf(const Key& key) {
  return key.name + inBrackets(key.unit == "B" ? "bytes" : key.unit);
}

std::string textOf(const Key& key) {
  std::vector<std::string> parts;
  for (const Key& part : key.parts)
    parts.push_back(nameOf(part) + (part.about.empty() ? "" : ": " + part.about));
  std::string plain = key.name; // a caption that repeats the name is left out
  std::ranges::replace(plain, '_', ' ');
  const std::string text = key.about.empty()      ? key.caption
                           : key.caption == plain ? key.about
                                                  : key.caption + ": " + key.about;
  return text + (parts.empty() ? "" : " (" + joined(parts) + ")");
}

Lines linesOf(const Command& command, bool inputs) {
  Lines lines;
  std::vector<Argument> all = command.arguments;
  for (Argument& argument : commonArguments(command)) all.push_back(std::move(argument));
  for (const Argument& argument : all)
    if (argument.isInput() == inputs) lines.emplace_back(namesOf(argument), textOf(argument));
  return lines;
}

Lines linesOfKeys(const Command& command) {
  Lines lines;
  if (command.keys.empty()) return lines;
  for (const Keys* keys : {&command.keys, &commonKeys()})
    for (const Key& key : *keys) lines.emplace_back(nameOf(key), textOf(key));
  return lines;
}

std::string usage(const Command& command) {
  std::string line = "patina " + command.name;
  bool optional = !command.keys.empty();
  for (const Argument& argument : command.arguments) {
    if (argument.isInput()) {
      const std::string name = argument.value + (argument.isRepeated() ? "..." : "");
      line += argument.isRequired() ? " " + name : " [" + name + "]";
    } else if (argument.isRequired()) {
      line += " " + argument.names.substr(0, argument.names.find(',')) + " " + argument.value;
    } else {
      optional = true;
    }
  }
  return line + (optional ? " [options]" : "");
}

std::string table(const Lines& rows) {
  std::size_t width = 0;
  for (const auto& row : rows) width = std::max(width, row.first.size());
  const std::size_t indent = std::min<std::size_t>(width, 26) + 4;
  std::string out;
  for (const auto& [name, text] : rows) {
    out += "  " + name;
    if (name.size() + 4 > indent)
      out += "\n" + std::string(indent, ' ');
    else
      out += std::string(indent - 2 - name.size(), ' ');
    out += wrapped(text, indent, indent) + "\n";
  }
  return out;
}

std::string section(const std::string& title, const Lines& rows) {
  return rows.empty() ? "" : "\n" + title + ":\n" + table(rows);
}

std::string exitCodes() {
  std::string out = "\nExit codes:\n";
  for (const char* line : kExitCodes) out += "  " + std::string(line) + "\n";
  return out;
}

std::string roff(const std::string& text) {
  std::string out;
  bool line_start = true;
  for (const char c : text) {
    if (line_start && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
    line_start = c == '\n';
  }
  return out;
}

std::string manHeader(const std::string& page, const std::string& summary) {
  std::string upper = page;
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return ".TH " + roff(upper) + " 1 \"\" \"patina " + std::string(programVersion()) +
         "\" \"Patina\"\n.SH NAME\n" + roff(page) + " \\- " + roff(summary) + "\n";
}

std::string manList(const Lines& rows) {
  std::string out;
  for (const auto& [name, text] : rows) out += ".TP\n.B " + roff(name) + "\n" + roff(text) + "\n";
  return out;
}

std::string manExitCodes() {
  std::string out = ".SH EXIT STATUS\n.nf\n";
  for (const char* line : kExitCodes) out += roff(line) + "\n";
  return out + ".fi\n";
}

} // namespace

std::string wrapped(const std::string& text, std::size_t indent, std::size_t column,
                    std::size_t width) {
  std::istringstream in(text);
  std::string out;
  for (std::string word; in >> word;) {
    if (column + word.size() + 1 > width && column > indent) {
      out += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (!out.empty()) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
  }
  return out;
}

std::string programHelp(const std::vector<Command>& commands) {
  Lines rows;
  for (const Command& command : commands) rows.emplace_back(command.name, command.summary);
  return "patina " + std::string(programVersion()) + "\n" + wrapped(kAbout, 0, 0) +
         "\n\nUsage: patina COMMAND INPUT... -o OUTPUT [options]\n\nCommands:\n" + table(rows) +
         "\n" + wrapped(kUnits, 0, 0) + "\n\nOptions:\n" +
         table({{"-h, --help", "Print this help; after a command, that of the command."},
                {"-V, --version", "Print the version."}}) +
         "\nExample:\n  patina model dinosaur -o dino.ply\n  patina info dino.ply\n" + exitCodes();
}

std::string commandHelp(const Command& command) {
  std::string out =
      "patina " + command.name + ": " + command.summary + "\n\nUsage: " + usage(command) + "\n";
  for (const std::string& paragraph : paragraphs(command.description))
    out += "\n" + wrapped(paragraph, 0, 0) + "\n";
  out += section("Input", linesOf(command, true)) + section("Options", linesOf(command, false)) +
         section("Keys of --json", linesOfKeys(command));
  out += "\n" + wrapped(kUnits, 0, 0) + "\n";
  out += command.examples.size() > 1 ? "\nExamples:\n" : "\nExample:\n";
  for (const std::string& example : command.examples) out += "  " + example + "\n";
  return out + exitCodes();
}

std::string programManPage(const std::vector<Command>& commands) {
  Lines rows;
  for (const Command& command : commands)
    rows.emplace_back("patina-" + command.name + "(1)", command.summary);
  return manHeader("patina", "a workspace for touch research") +
         ".SH SYNOPSIS\n.B patina\nCOMMAND INPUT... \\-o OUTPUT [options]\n.SH DESCRIPTION\n" +
         roff(kAbout) + "\n.PP\n" + roff(kUnits) + "\n.SH COMMANDS\n" + manList(rows) +
         manExitCodes();
}

std::string commandManPage(const Command& command) {
  std::string out = manHeader("patina-" + command.name, command.summary) + ".SH SYNOPSIS\n" +
                    roff(usage(command)) + "\n.SH DESCRIPTION\n";
  for (const std::string& paragraph : paragraphs(command.description))
    out += roff(paragraph) + "\n.PP\n";
  out += roff(kUnits) + "\n.SH OPTIONS\n" + manList(linesOf(command, true)) +
         manList(linesOf(command, false));
  if (!command.keys.empty()) out += ".SH KEYS OF JSON\n" + manList(linesOfKeys(command));
  out += ".SH EXAMPLES\n.nf\n";
  for (const std::string& example : command.examples) out += roff(example) + "\n";
  return out + ".fi\n" + manExitCodes() + ".SH SEE ALSO\n.BR patina (1)\n";
}

std::string markdown(const std::vector<Command>& commands) {
  std::string out = "# The command line\n\nWhat `patina --help` and `patina COMMAND --help` print; "
                    "made by `patina man -o docs --markdown`.\n\n```\n" +
                    programHelp(commands) + "```\n";
  for (const Command& command : commands)
    out += "\n## patina " + command.name + "\n\n```\n" + commandHelp(command) + "```\n";
  return out;
}

} // namespace patina::cli
