#include <cmath>

#include "acquisition/files/scan_files.h"
#include "core/csv.h"
#include "core/error.h"

namespace patina {
namespace {

const std::vector<std::string> kProbeColumns = {"t [s]",       "force [N]",   "a1u [m/s^2]",
                                                "a1v [m/s^2]", "a2u [m/s^2]", "a2v [m/s^2]"};
const std::vector<std::string> kPathColumns = {"t [s]", "x [m]", "y [m]", "z [m]",     "qx",
                                               "qy",    "qz",    "qw",    "sigma [m]", "force [N]"};

// Rows of finite numbers, the first of them a time that increases.
template <class Take>
void readTimed(const std::filesystem::path& path, const std::vector<std::string>& columns,
               const Take& take) {
  CsvReader reader(path, columns);
  const std::string name = path.string();
  std::optional<double> last;
  for (std::vector<double> row; reader.next(row);) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (!std::isfinite(row[i]))
        throw FileError(name, reader.line(), columns[i] + " is not a finite number");
    if (last && !(row[0] > *last))
      throw FileError(name, reader.line(),
                      row[0] == *last ? "time repeats" : "time runs backwards");
    last = row[0];
    take(row, reader.line());
  }
  if (!last) throw FileError(name, 0, "there is no sample in it");
}

} // namespace

OnFile<ProbeSample> readProbeStream(const std::filesystem::path& path) {
  OnFile<ProbeSample> file;
  readTimed(path, kProbeColumns, [&](const std::vector<double>& row, std::size_t line) {
    file.values.push_back({row[0], row[1], {row[2], row[3], row[4], row[5]}});
    file.lines.push_back(line);
  });
  return file;
}

void writeProbeStream(const std::filesystem::path& path, const std::vector<ProbeSample>& samples) {
  CsvWriter writer(path, kProbeColumns);
  for (const ProbeSample& s : samples)
    writer.add(
        {s.t, s.force, s.acceleration[0], s.acceleration[1], s.acceleration[2], s.acceleration[3]});
  writer.commit();
}

std::vector<PathSample> readPath(const std::filesystem::path& path) {
  std::vector<PathSample> samples;
  readTimed(path, kPathColumns, [&](const std::vector<double>& row, std::size_t) {
    PathSample sample;
    sample.t = row[0];
    sample.position = {row[1], row[2], row[3]};
    sample.orientation = Eigen::Quaterniond(row[7], row[4], row[5], row[6]).normalized();
    sample.sigma = row[8];
    sample.force = row[9];
    samples.push_back(sample);
  });
  return samples;
}

void writePath(const std::filesystem::path& path, const std::vector<PathSample>& samples) {
  CsvWriter writer(path, kPathColumns);
  for (const PathSample& s : samples) {
    const auto& q = s.orientation;
    writer.add({s.t, s.position.x(), s.position.y(), s.position.z(), q.x(), q.y(), q.z(), q.w(),
                s.sigma, s.force});
  }
  writer.commit();
}

void writeHeights(const std::filesystem::path& path, const std::vector<ScanHeight>& heights) {
  CsvWriter writer(path, {"t [s]", "along [m]", "height [m]", "sigma [m]", "stretch"});
  for (const ScanHeight& h : heights)
    writer.add({h.t, h.point.along, h.point.height, h.point.sigma, static_cast<double>(h.stretch)});
  writer.commit();
}

} // namespace patina
