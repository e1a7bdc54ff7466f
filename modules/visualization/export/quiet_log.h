// VTK's pipeline and decompressor print on stderr beside what they tell their observers.
#pragma once

#include <vtkLogger.h>

namespace patina {

// Nothing is printed while it lives.
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
