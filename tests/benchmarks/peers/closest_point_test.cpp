// Time of closest points, one by one on one thread, against Embree's tree with a triangle's
// distance in float. Ours are exact in double. Both in this run, turn by turn.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <random>
#include <string>
#include <vector>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <gtest/gtest.h>

#include "geometry/mesh/shapes.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {
namespace {

using Vec3f = Eigen::Vector3f;

double cpuSeconds() {
  std::timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Closest point by the Voronoi regions of corners and edges.
Vec3f closestInFloat(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  const Vec3f ab = b - a, ac = c - a;
  const float ab_a = ab.dot(p - a), ac_a = ac.dot(p - a);
  if (ab_a <= 0 && ac_a <= 0) return a;
  const float ab_b = ab.dot(p - b), ac_b = ac.dot(p - b);
  if (ab_b >= 0 && ac_b <= ab_b) return b;
  const float ab_c = ab.dot(p - c), ac_c = ac.dot(p - c);
  if (ac_c >= 0 && ab_c <= ac_c) return c;
  const float wc = ab_a * ac_b - ab_b * ac_a;
  if (wc <= 0 && ab_a >= 0 && ab_b <= 0) return a + ab_a / (ab_a - ab_b) * ab;
  const float wb = ab_c * ac_a - ab_a * ac_c;
  if (wb <= 0 && ac_a >= 0 && ac_c <= 0) return a + ac_a / (ac_a - ac_c) * ac;
  const float wa = ab_b * ac_c - ab_c * ac_b;
  const float to_b = ac_b - ab_b, to_c = ab_c - ac_c;
  if (wa <= 0 && to_b >= 0 && to_c >= 0) return b + to_b / (to_b + to_c) * (c - b);
  return a + (wb * ab + wc * ac) / (wa + wb + wc);
}

class EmbreeTree {
 public:
  explicit EmbreeTree(const TriangleMesh& mesh) : faces_(mesh.triangles) {
    for (const Vec3& p : mesh.positions) positions_.push_back(p.cast<float>());
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(Vec3f), positions_.size());
    std::copy(positions_.begin(), positions_.end(), static_cast<Vec3f*>(vertices));
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(Triangle), faces_.size());
    std::copy(faces_.begin(), faces_.end(), static_cast<Triangle*>(indices));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(scene_);
  }
  ~EmbreeTree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeTree(const EmbreeTree&) = delete;
  EmbreeTree& operator=(const EmbreeTree&) = delete;

  double distance(const Vec3& p) const {
    RTCPointQuery query{};
    query.x = static_cast<float>(p[0]);
    query.y = static_cast<float>(p[1]);
    query.z = static_cast<float>(p[2]);
    query.radius = std::numeric_limits<float>::infinity();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    // The callback gets it back unchanged and only reads it.
    rtcPointQuery(scene_, &query, &context, tryFace, const_cast<EmbreeTree*>(this));
    return static_cast<double>(query.radius);
  }

 private:
  static bool tryFace(RTCPointQueryFunctionArguments* arguments) {
    const auto& tree = *static_cast<const EmbreeTree*>(arguments->userPtr);
    const Triangle& t = tree.faces_[arguments->primID];
    const auto corner = [&](std::size_t i) -> const Vec3f& {
      return tree.positions_[static_cast<std::size_t>(t[i])];
    };
    RTCPointQuery& query = *arguments->query;
    const Vec3f p(query.x, query.y, query.z);
    const float distance = (closestInFloat(p, corner(0), corner(1), corner(2)) - p).norm();
    if (!(distance < query.radius)) return false;
    query.radius = distance;
    return true;
  }

  std::vector<Vec3f> positions_;
  std::vector<Triangle> faces_;
  RTCDevice device_ = rtcNewDevice("threads=1");
  RTCScene scene_ = rtcNewScene(device_);
};

// Points lie around the surface, up to a tenth of the unit away along each axis.
std::vector<Vec3> pointsNear(const TriangleMesh& mesh, int count) {
  std::mt19937 random(5);
  std::uniform_int_distribution<std::size_t> face(0, mesh.triangles.size() - 1);
  std::uniform_real_distribution<double> off(-0.1, 0.1);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i)
    points.push_back(mesh.corner(face(random), 0) + Vec3(off(random), off(random), off(random)));
  return points;
}

template <typename Distance>
double secondsOf(const std::vector<Vec3>& points, std::vector<double>& distances,
                 const Distance& distance) {
  const double start = cpuSeconds();
  for (std::size_t i = 0; i < points.size(); ++i) distances[i] = distance(points[i]);
  return cpuSeconds() - start;
}

void expectRatio(const std::string& name, const TriangleMesh& mesh, double most) {
  constexpr int kRuns = 5;
  const std::vector<Vec3> points = pointsNear(mesh, 200000);
  const TriangleTree tree(mesh);
  const EmbreeTree embree(mesh);
  std::vector<double> exact(points.size()), rounded(points.size());
  double ours = std::numeric_limits<double>::infinity(), theirs = ours;
  for (int run = 0; run < kRuns; ++run) {
    ours = std::min(ours, secondsOf(points, exact,
                                    [&](const Vec3& p) { return tree.closestPoint(p).distance; }));
    theirs = std::min(
        theirs, secondsOf(points, rounded, [&](const Vec3& p) { return embree.distance(p); }));
  }
  for (std::size_t i = 0; i < points.size(); ++i) ASSERT_NEAR(exact[i], rounded[i], 1e-5);
  const double each = 1e9 / static_cast<double>(points.size());
  std::printf("%-12s %7zu triangles: %5.0f ns, Embree %5.0f ns, ratio %.3f (at most %.2f)\n",
              name.c_str(), mesh.triangles.size(), ours * each, theirs * each, ours / theirs, most);
  std::fflush(stdout);
  EXPECT_LE(ours / theirs, most);
}

TEST(ClosestPointAgainstEmbree, RandomPointsNearASphere) {
  expectRatio("sphere", icosphere(1, 79), 0.55);
}

TEST(ClosestPointAgainstEmbree, RandomPointsNearATorus) {
  expectRatio("torus", torus(1, 0.35, 352, 176), 0.55);
}

TEST(ClosestPointAgainstEmbree, RandomPointsNearBumps) {
  TriangleMesh mesh = torus(1, 0.35, 352, 176);
  for (Vec3& p : mesh.positions)
    p *= 1 + 0.03 * std::sin(40 * p[0]) * std::sin(37 * p[1]) * std::cos(31 * p[2]);
  expectRatio("bumpy torus", mesh, 0.55);
}

} // namespace
} // namespace patina
