#include "acquisition/files/registered_file.h"

#include "core/csv.h"

namespace patina {

void writeRegisteredPath(const std::filesystem::path& path, const std::vector<PathSample>& samples,
                         const Registration& registration) {
  CsvWriter writer(path, {"t [s]", "x [m]", "y [m]", "z [m]", "qx", "qy", "qz", "qw", "sigma [m]",
                          "force [N]", "face", "b0", "b1", "b2", "distance [m]"});
  const Pose& mesh_from_path = registration.mesh_from_path;
  const Eigen::Quaterniond turn(mesh_from_path.linear());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!registration.counts[i]) continue;
    const Vec3 p = mesh_from_path * samples[i].position;
    const Eigen::Quaterniond q = turn * samples[i].orientation;
    const Miss& miss = registration.misses[i];
    const Vec3& b = miss.foot.barycentric;
    writer.add({samples[i].t, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(), samples[i].sigma,
                samples[i].force, static_cast<double>(miss.foot.face), b[0], b[1], b[2],
                miss.distance});
  }
  writer.commit();
}

} // namespace patina
