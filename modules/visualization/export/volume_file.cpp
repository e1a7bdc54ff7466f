#include "visualization/export/volume_file.h"

#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>
#include <string>

#include <vtkCommand.h>
#include <vtkXMLImageDataReader.h>

#include "core/error.h"
#include "core/numbers.h"
#include "visualization/export/quiet_log.h"

namespace patina {
namespace {

// Collects what VTK would print. Its first line is the cause; the rest is about our own caller.
class ErrorCatcher : public vtkCommand {
 public:
  static ErrorCatcher* New() { return new ErrorCatcher; }
  void Execute(vtkObject*, unsigned long, void* data) override {
    if (!cause.empty() || data == nullptr) return;
    cause = static_cast<const char*>(data);
    // "ERROR: In file, line n\nvtkClass (0x..): cause\n"
    if (const auto colon = cause.find("): "); colon != std::string::npos)
      cause = cause.substr(colon + 3);
    if (const auto end = cause.find('\n'); end != std::string::npos) cause.resize(end);
  }
  std::string cause = {};
};

std::string headOf(const std::filesystem::path& path) {
  std::error_code code;
  if (!std::filesystem::exists(path, code)) throw FileError(path.string(), 0, "no such file");
  if (std::filesystem::is_directory(path, code))
    throw FileError(path.string(), 0, "is a folder, not a .vti volume");
  if (!std::filesystem::is_regular_file(path, code))
    throw FileError(path.string(), 0, "is no file: a volume is not read from a pipe or device");
  std::ifstream stream(path, std::ios::binary);
  std::string head(8192, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  if (head.empty()) throw FileError(path.string(), 0, "is empty or cannot be read");
  if (head.find("<VTKFile") == std::string::npos || head.find("\"ImageData\"") == std::string::npos)
    throw FileError(path.string(), 0, "is not a VTK XML ImageData (.vti) file");
  return head;
}

// Three numbers of the header, which VTK takes for its own where they are none; absent: none.
void checkThree(const std::string& head, const std::string& name, bool positive,
                const std::filesystem::path& path) {
  const std::regex attribute("\\s" + name + "\\s*=\\s*([\"'])([^\"']*)\\1");
  std::smatch found;
  if (!std::regex_search(head, found, attribute)) return;
  std::istringstream words(found[2]);
  std::size_t count = 0;
  for (std::string word; words >> word; ++count)
    if (const auto number = parseNumber(word);
        !number || !std::isfinite(*number) || (positive && !(*number > 0)))
      throw FileError(path.string(), 0,
                      "has '" + word + "' in its " + name + ", which is no " +
                          (positive ? "positive " : "") + "number");
  if (count != 3)
    throw FileError(path.string(), 0,
                    "has " + std::to_string(count) + " numbers in its " + name + ", not three");
}

// The reader allocates whatever the header asks for, so the header is read first.
void checkHeader(const std::filesystem::path& path) {
  const std::string head = headOf(path);
  const auto at = head.find("WholeExtent=\"");
  if (at == std::string::npos) throw FileError(path.string(), 0, "has no WholeExtent");
  std::istringstream numbers(head.substr(at + 13, 200));
  double nodes = 1;
  for (int axis = 0; axis < 3; ++axis) {
    double low = 0, high = 0;
    if (!(numbers >> low >> high) || high < low)
      throw FileError(path.string(), 0, "has a WholeExtent that is not six ascending numbers");
    nodes *= high - low + 1;
  }
  checkThree(head, "Spacing", true, path);
  checkThree(head, "Origin", false, path);
  if (nodes > 1073741824.0)
    throw FileError(path.string(), 0, "has more than 2^30 nodes: resample it to a smaller grid");
}

// `read` with the reader's complaints as errors of the file.
template <typename Read>
void readQuietly(vtkXMLImageDataReader* reader, const std::filesystem::path& path,
                 const Read& read) {
  const QuietLog quiet;
  const vtkNew<ErrorCatcher> errors;
  reader->AddObserver(vtkCommand::ErrorEvent, errors);
  reader->AddObserver(vtkCommand::WarningEvent, errors);
  reader->SetFileName(path.c_str());
  try {
    // The XML parser is made inside; its complaints reach the reader's own error code.
    reader->SetReaderErrorObserver(errors);
    reader->SetParserErrorObserver(errors);
    read();
  } catch (const std::exception&) {
    throw FileError(path.string(), 0, "cannot be read: truncated or damaged");
  }
  if (!errors->cause.empty() || reader->GetErrorCode() != 0)
    throw FileError(path.string(), 0, "cannot be read: truncated or damaged");
}

} // namespace

vtkSmartPointer<vtkImageData> readVolume(const std::filesystem::path& path) {
  checkHeader(path);
  const vtkNew<vtkXMLImageDataReader> reader;
  readQuietly(reader, path, [&] { reader->Update(); });
  vtkSmartPointer<vtkImageData> image = reader->GetOutput();
  if (image == nullptr || image->GetNumberOfPoints() == 0)
    throw FileError(path.string(), 0, "cannot be read: truncated or damaged, or without nodes");
  return image;
}

void requireVolumeFile(const std::filesystem::path& path) {
  (void)headOf(path);
}

std::vector<std::string> pointArraysOf(const std::filesystem::path& path) {
  requireVolumeFile(path);
  const vtkNew<vtkXMLImageDataReader> reader;
  readQuietly(reader, path, [&] { reader->UpdateInformation(); });
  std::vector<std::string> names;
  for (int i = 0; i < reader->GetNumberOfPointArrays(); ++i)
    names.emplace_back(reader->GetPointArrayName(i));
  return names;
}

} // namespace patina
