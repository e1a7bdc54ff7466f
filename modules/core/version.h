// Release and commit of this program.
#pragma once

#include <string>
#include <string_view>

#include "core/json.h"

namespace patina {

std::string_view programVersion(); // release number
// Output of `git describe`: "c5c750d622b3" or, after a tag, "TAG-3-gc5c750d622b3", with "-dirty" if
// files differ from that commit; "unknown" if the source has neither git nor an archive's mark.
std::string_view programCommit();
std::string versionText(); // both: "NUMBER (commit c5c750d622b3)"

// Both as JSON: {"version", "commit"}.
Json programDescription();

} // namespace patina
