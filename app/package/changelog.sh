#!/bin/sh
# Prints a CHANGELOG.md in the form that Debian packages have.
#   changelog.sh CHANGELOG.md 'MAINTAINER <ADDRESS>'
# A version begins with '## [0.2.0] - 2026-11-28'; a heading without a date is not released yet and
# is left out.
set -eu
LC_ALL=C awk -v file="$1" -v maintainer="$2" '
  # Prints the collected text as one entry, in lines of at most 78 characters.
  function print_entry(  words, count, i, line) {
    count = split(entry, words, " ")
    line = "  *"
    for (i = 1; i <= count; ++i) {
      if (length(line) + 1 + length(words[i]) > 78) {
        print line
        line = "   "
      }
      line = line " " words[i]
    }
    if (count > 0) print line
    entry = ""
  }
  function end_version() {
    print_entry()
    if (version != "") printf "\n -- %s  %s\n\n", maintainer, date
    version = ""
  }
  /^## / {
    end_version()
    gsub(/[][]/, "")
    if ($NF !~ /^[0-9][0-9][0-9][0-9]-[0-9][0-9]-[0-9][0-9]$/) next
    version = $2
    ("date -u -R -d " $NF) | getline date
    printf "patina (%s) unstable; urgency=medium\n\n", version
    headings = 0
    ++versions
    next
  }
  version == "" || /^\[[^]]*\]:/ { next }
  /^### / {
    print_entry()
    printf "%s  [ %s ]\n", (headings++ > 0 ? "\n" : ""), substr($0, 5)
    next
  }
  /^[-*] / { print_entry(); entry = substr($0, 3); next }
  /^[ \t]*$/ { print_entry(); next }
  { entry = entry " " $0 }
  END {
    end_version()
    if (versions == 0) {
      print file ": no version with a date; write ## [VERSION] - YYYY-MM-DD" > "/dev/stderr"
      exit 2
    }
  }' "$1"
