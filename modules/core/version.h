// Which program this is: its release, and the commit that it was built from.
#pragma once

#include <string>
#include <string_view>

#include "core/json.h"

namespace patina {

std::string_view programVersion(); // the number of the release
// What `git describe` says of the source: "c5c750d622b3" or, after a tag, "TAG-3-gc5c750d622b3",
// with "-dirty" where a file differs from that commit; "unknown" where the source came with neither
// git nor its archive's mark.
std::string_view programCommit();
std::string versionText(); // both, for people: "NUMBER (commit c5c750d622b3)"

// Both for a file or a report: {"version", "commit"}.
Json programDescription();

} // namespace patina
