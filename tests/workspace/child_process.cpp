#include "workspace/child_process.h"

#include <cstdlib>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "core/file.h"
#include "support/places.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

using Settings = std::vector<std::pair<std::string, std::string>>;

// In the child process.
[[noreturn]] void become(const std::vector<std::string>& words, const Settings& settings) {
  for (const auto& [name, value] : settings) ::setenv(name.c_str(), value.c_str(), 1);
  ::setenv("LD_PRELOAD", test::preloadable("fault_shim.so").c_str(), 1);
  // The sanitizers' runtime must be the first library.
  const char* options = std::getenv("ASAN_OPTIONS");
  const std::string with = std::string(options ? options : "") + ":verify_asan_link_order=0";
  ::setenv("ASAN_OPTIONS", with.c_str(), 1);
  std::vector<char*> pointers;
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  ::execv(pointers[0], pointers.data());
  ::_exit(127);
}

void redirect(int stream, const fs::path& to) {
  const int fd = ::open(to.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  ::dup2(fd, stream);
  ::close(fd);
}

const std::string kProgram = test::programFolder() / "workspace_child";

} // namespace

ChildEnd runChild(const std::string& command, const fs::path& folder, const ChildFault& fault) {
  const fs::path beside = folder.string() + "-child";
  const fs::path out = beside.string() + ".out", err = beside.string() + ".err",
                 mark = beside.string() + ".mark";
  fs::remove(mark);
  const pid_t child = ::fork();
  if (child == 0) {
    redirect(STDOUT_FILENO, out);
    redirect(STDERR_FILENO, err);
    become({kProgram, command, folder.string()}, {{"PATINA_FAULT", fault.kind},
                                                  {"PATINA_FAULT_AT", std::to_string(fault.at)},
                                                  {"PATINA_FAULT_UNDER", folder.string()},
                                                  {"PATINA_FAULT_MARK", mark.string()},
                                                  {"PATINA_NO_FLUSH", "1"}});
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  const int code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return {code, fs::exists(mark), readFile(out), readFile(err)};
}

StrokesChild startStrokes(const fs::path& folder, unsigned seed, bool flush) {
  int ends[2];
  if (::pipe(ends) != 0) return {};
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(ends[1], STDOUT_FILENO);
    ::close(ends[0]);
    ::close(ends[1]);
    become({kProgram, "strokes", folder.string(), std::to_string(seed)},
           {{"PATINA_NO_FLUSH", flush ? "" : "1"}});
  }
  ::close(ends[1]);
  return {child, ends[0]};
}

} // namespace patina
