"""Finds what a C++ source could have got wrong, and writes it beside what it says.

A site is a statement or a condition inside a function; a mutant is a site with one change in it:

    return a < b;    becomes    { if (::patina::mutant(17)) return a >= b; return a < b; }

Lines keep their numbers, so that the compiler's complaints tell which mutants are none. Text is
read by the project's own layout (clang-format): what is not understood is left alone.
"""
import bisect
import re
from dataclasses import dataclass


@dataclass
class Mutant:
    path: str
    begin: int  # of the site, in the file's text
    end: int
    line: int
    last_line: int
    was: str  # the lines of the site, as one
    change: str  # "a < b -> a >= b", as short as it can be told
    text: str  # what replaces the site; @ stands for the number
    number: int = 0


def blank(text):
    """The text with comments, strings and preprocessor lines made unreadable, equally long."""
    pattern = (r'//[^\n]*|/\*.*?\*/|R"\((?:.|\n)*?\)"|"(?:\\.|[^"\\\n])*"|'
               r"(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'|^[ \t]*\#(?:\\\n|[^\n])*")
    keep = lambda m: re.sub(r"[^\n]", "_" if m[0][0] in "\"'R" else " ", m[0])
    return re.sub(pattern, keep, text, flags=re.S | re.M)


def closing(text, at):
    """Where the bracket that opens at `at` is closed; -1 if it is not."""
    depth = 0
    for i in range(at, len(text)):
        depth += (text[i] in "([{") - (text[i] in ")]}")
        if depth == 0:
            return i
    return -1


def split_top(text, separator):
    """(begin, end) of the parts between separators that no bracket holds."""
    parts, begin, depth = [], 0, 0
    for i, c in enumerate(text):
        depth += (c in "([{") - (c in ")]}")
        if c == separator and depth == 0:
            parts.append((begin, i))
            begin = i + 1
    return parts + [(begin, len(text))]


def balanced(text):
    depth = 0
    for c in text:
        depth += (c in "([{") - (c in ")]}")
        if depth < 0:
            return False
    return depth == 0


SWAPS = [
    (r"(?<= )<(?= )", [">=", "<="]), (r"(?<= )>(?= )", ["<=", ">="]),
    (r"(?<= )<=(?= )", [">", "<"]), (r"(?<= )>=(?= )", ["<", ">"]),
    (r"(?<= )==(?= )", ["!="]), (r"(?<= )!=(?= )", ["=="]),
    (r"(?<= )&&(?= )", ["||"]), (r"(?<= )\|\|(?= )", ["&&"]),
    (r"(?<= )\+(?= )", ["-"]), (r"(?<= )-(?= )", ["+"]),
    (r"(?<= )\*(?= )", ["/"]), (r"(?<= )/(?= )", ["*"]), (r"(?<= )%(?= )", ["*"]),
    (r"(?<![\w)\]] )(?<![\w)\]])-(?=[\w(])", [""]), (r"!(?=[\w(])", [""]),
    (r"\bstd::min\b", ["std::max"]), (r"\bstd::max\b", ["std::min"]),
    (r"\btrue\b", ["false"]), (r"\bfalse\b", ["true"]),
]
TERM = r" [-+*] (?:[\w:.]|->|\[[^][]*\]|\([^()]*\))+(?=$|[;,)\]]| [-+<>=!?:&|])"
NUMBER = r"(?<![\w.'])(?<!e-)\d+(?![\w.'])"


def changes(text):
    """(begin, end, replacement) of each single change of an expression."""
    found = []
    for pattern, others in SWAPS:
        for m in re.finditer(pattern, text):
            found += [(m.start(), m.end(), other) for other in others]
    found += [(m.start(), m.end(), "") for m in re.finditer(TERM, text)]
    found += [(m.start(), m.end(), str(int(m[0]) + 1)) for m in re.finditer(NUMBER, text)]
    return found


def one_line(text):
    return re.sub(r"\s+", " ", re.sub(r"//[^\n]*", "", text)).strip()


class Source:
    def __init__(self, path, text):
        self.path, self.text, self.bare = path, text, blank(text)
        self.starts = [m.end() for m in re.finditer("\n", text)]
        self.mutants = []

    def line_of(self, at):
        return bisect.bisect_right(self.starts, at) + 1

    def add(self, begin, end, change, replacement):
        first, last = self.text.rfind("\n", 0, begin) + 1, self.text.find("\n", end)
        self.mutants.append(Mutant(self.path, begin, end, self.line_of(begin), self.line_of(end),
                                   one_line(self.text[first:last]), change, replacement))

    def expression(self, begin, end, site_begin, site_end, form):
        """Each change of [begin, end); form(changed, original) replaces the site."""
        while begin < end and self.bare[begin].isspace():
            begin += 1
        bare, text = self.bare[begin:end], self.text[begin:end]
        if not balanced(bare) or "{" in bare:
            return
        for a, b, other in changes(bare):
            changed = one_line(text[:a] + "\x00" + other + "\x01" + text[b:])
            was = one_line(text[max(0, a - 30):b + 20])
            told = f"{was}: '{text[a:b].strip()}' -> '{other}'"
            changed = changed.replace("\x00", "").replace("\x01", "")
            self.add(site_begin, site_end, told, form(changed, text))

    def condition(self, begin, end):
        if not re.search(r"(?<![=!<>])=(?!=)", self.bare[begin:end]):
            self.expression(begin, end, begin, end,
                            lambda new, old: f"(::patina::mutant(@) ? bool({new}) : bool({old}))")

    def statement(self, begin, end):
        """[begin, end) ends before its semicolon, which is part of the site."""
        while begin < end and self.bare[begin].isspace():
            begin += 1
        bare, text = self.bare[begin:end], self.text[begin:end]
        if not bare.strip() or not balanced(bare) or re.search(r"[{}]|\b(constexpr|static)\b", bare):
            return
        if re.match(r"assert\(|[\w.]+\.reserve\(", bare):  # compiled out; memory ahead of time
            return
        site = (begin, end + 1)
        drop = "{{ if (!::patina::mutant(@)) {0}; }}".format
        if re.fullmatch(r"break|continue|return", bare):
            self.add(*site, f"without '{text}'", drop(text))
        elif bare.startswith("return "):
            self.expression(begin + 7, end, *site, lambda new, old:
                            f"{{ if (::patina::mutant(@)) return {new}; return {old}; }}")
        elif m := re.match(r"((?:[\w:.]|->|\[[^]]*\]|\([^()]*\))+)\s*([-+*/|&]?=)(?!=)", bare):
            head = text[:m.end()]
            self.add(*site, f"without '{one_line(text)}'", drop(text))
            other = {"+=": "-=", "-=": "+=", "*=": "/=", "/=": "*="}.get(m[2])
            if other:
                turned = head[:-2] + other + text[m.end():]
                self.add(*site, f"{one_line(text)}: '{m[2]}' -> '{other}'",
                         f"{{ if (::patina::mutant(@)) {one_line(turned)}; else {text}; }}")
            self.expression(begin + m.end(), end, *site, lambda new, old:
                            f"{{ if (::patina::mutant(@)) {one_line(head)} {new}; else {text}; }}")
        elif m := re.match(r"(?:const )?([\w:]+(?:<[^=;]*?>)?) (?=\w+ = )", bare):
            if m[1] in ("using", "return", "auto"):
                kind = "" if m[1] == "auto" else None
            else:
                kind = m[1]
            if kind is None:
                return
            for a, b in split_top(bare[m.end():], ","):
                name = re.match(r"\s*\w+ = ", bare[m.end() + a:m.end() + b])
                if name:
                    first, last = begin + m.end() + a + name.end(), begin + m.end() + b
                    self.expression(first, last, first, last, lambda new, old:
                                    f"(::patina::mutant(@) ? {kind}({new}) : {kind}({old}))")
        elif re.fullmatch(r"[\w:]+(?:(?:\.|->)\w+|\[[^]]*\])*\(.*\)", bare, re.S):
            self.add(*site, f"without '{one_line(text)}'", drop(text))

    def segment(self, begin, end, ended_by):
        while True:
            while begin < end and self.bare[begin].isspace():
                begin += 1
            rest = self.bare[begin:end]
            if m := re.match(r"\[\[\w+\]\]|(?:case [^;?]*?[^:]|default):(?!:)|else\b|do\b", rest):
                begin += m.end()
            elif m := re.match(r"(if constexpr|if|while|for) \(", rest):
                close = closing(rest, m.end() - 1)
                if close < 0:
                    return
                a, b = begin + m.end(), begin + close
                parts = split_top(self.bare[a:b], ";")
                if m[1] in ("if", "while") and len(parts) == 1:
                    self.condition(a, b)
                elif m[1] == "for" and len(parts) == 3:
                    self.condition(a + parts[1][0], a + parts[1][1])
                begin = b + 1
            else:
                break
        if ended_by == ";":
            self.statement(begin, end)

    def scan(self):
        frames = [["scope", 0]]  # what it is, brackets open in it
        begin = 0
        for i, c in enumerate(self.bare):
            if c in "([":
                frames[-1][1] += 1
            elif c in ")]":
                frames[-1][1] -= 1
            elif c == "{":
                head = self.bare[begin:i].strip()
                if frames[-1][0] == "code":
                    self.segment(begin, i, "{")
                if re.match(r"(inline |template <.*> )?(namespace|class|struct|union|enum|extern)\b", head):
                    frames.append(["scope", 0])
                else:
                    frames.append(["code" if "(" in head else frames[-1][0], 0])
                begin = i + 1
            elif c == "}":
                if len(frames) > 1:
                    frames.pop()
                begin = i + 1
            elif c == ";" and frames[-1][1] == 0:
                if frames[-1][0] == "code":
                    self.segment(begin, i, ";")
                begin = i + 1
        return self.mutants


def mutants_of(path, text):
    return Source(path, text).scan()


def written(text, mutants, switch):
    """The source with all of these mutants in it, a switch each; sites must not overlap."""
    for m in sorted(mutants, key=lambda m: -m.begin):
        lines = text[m.begin:m.end].count("\n")
        new = m.text.replace("@", str(m.number))
        new += "\n" * (lines - new.count("\n"))
        text = text[:m.begin] + new + text[m.end:]
    return f'#include "{switch}"\n#line 1\n{text}'
