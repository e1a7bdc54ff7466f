#include "core/version.h"

#include "core/built_from.h" // version.cmake writes it

namespace patina {

std::string_view programVersion() {
  return PATINA_VERSION;
}

std::string_view programCommit() {
  return PATINA_COMMIT;
}

std::string versionText() {
  const std::string commit(programCommit());
  const std::string text = commit == "unknown" ? "unknown commit" : "commit " + commit;
  return std::string(programVersion()) + " (" + text + ")";
}

Json programDescription() {
  Json json = Json::object();
  json.set("version", std::string(programVersion()));
  return json.set("commit", std::string(programCommit()));
}

} // namespace patina
