// VTK's pipeline and decompressor print errors on stderr in addition to calling observers.
#pragma once

#include <vtkLogger.h>

namespace patina {

class QuietLog {
 public:
  QuietLog() { vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF); }
  ~QuietLog() { vtkLogger::SetStderrVerbosity(before_); }
  QuietLog(const QuietLog&) = delete;
  QuietLog& operator=(const QuietLog&) = delete;

 private:
  vtkLogger::Verbosity before_ = vtkLogger::GetCurrentVerbosityCutoff();
};

} // namespace patina
