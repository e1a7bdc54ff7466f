#include "acquisition/registration/path_course.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/decompose.h"
#include "core/percentiles.h"

namespace patina {
namespace {

constexpr std::size_t kCourseWindow = 20, kCourseLeast = 10; // samples to either side
constexpr double kCoursePause = 5; // median steps of time: beyond it another stretch begins

} // namespace

std::vector<Course> coursesOf(const std::vector<PathSample>& path) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < path.size(); ++i) steps.push_back(path[i].t - path[i - 1].t);
  const double pause = steps.empty() ? 0 : kCoursePause * percentiles(steps).p50;
  std::vector<Course> courses(path.size());
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= path.size(); ++i) {
    const double step = i < path.size() ? path[i].t - path[i - 1].t : -1;
    if (step > 0 && step <= pause) continue;
    const std::size_t least = std::min(kCourseLeast, (i - begin - 1) / 2);
    for (std::size_t k = begin; k < i; ++k) {
      courses[k].begin = begin;
      courses[k].end = i;
      courses[k].force = path[k].force;
      if (least < 2) continue;
      // Of as many samples towards either end, that the middle's error does not lean; what is too
      // near an end for that goes as the nearest parabola does.
      const std::size_t middle = std::clamp(k, begin + least, i - 1 - least);
      const std::size_t half = std::min({middle - begin, i - 1 - middle, kCourseWindow});
      const std::size_t low = middle - half, high = middle + half;
      Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
      Eigen::Matrix<double, 3, 4> right = Eigen::Matrix<double, 3, 4>::Zero();
      const double scale = path[high].t - path[low].t;
      for (std::size_t j = low; j <= high; ++j) {
        const double u = (path[j].t - path[k].t) / scale;
        const Vec3 terms(1, u, u * u);
        Eigen::RowVector4d values;
        values << (path[j].position - path[k].position).transpose(), path[j].force;
        normal += terms * terms.transpose();
        right += terms * values;
      }
      const Eigen::Matrix3d inverse = SymmetricSolver(normal).inverse();
      const Eigen::Matrix<double, 3, 4> parabola = inverse * right;
      courses[k].blur = inverse(1, 1) / (scale * scale);
      courses[k].speed = parabola.row(1).head<3>().transpose() / scale;
      courses[k].bend = 2 * parabola.row(2).head<3>().transpose() / (scale * scale);
      courses[k].force = parabola(0, 3);
      courses[k].rise = parabola(1, 3) / scale;
      courses[k].curve = 2 * parabola(2, 3) / (scale * scale);
      const Eigen::AngleAxisd turn(path[high].orientation * path[low].orientation.conjugate());
      courses[k].spin = turn.angle() / scale * turn.axis();
    }
    begin = i;
  }
  return courses;
}

SmoothForce forceBefore(const std::vector<PathSample>& path, const std::vector<Course>& courses,
                        std::size_t sample, double earlier) {
  const double t = path[sample].t - earlier;
  // Samples lie about as far apart as at this one: few steps lead to the nearest.
  std::size_t near = sample;
  while (near > courses[sample].begin && path[near - 1].t + path[near].t > 2 * t) --near;
  while (near + 1 < courses[sample].end && path[near].t + path[near + 1].t < 2 * t) ++near;
  const Course& there = courses[near];
  const double off = t - path[near].t;
  const bool beyond =
      off < 0 ? near == courses[sample].begin : off > 0 && near + 1 == courses[sample].end;
  if (beyond) return {there.force, 0};
  return {there.force + off * (there.rise + 0.5 * off * there.curve),
          there.rise + off * there.curve};
}

} // namespace patina
