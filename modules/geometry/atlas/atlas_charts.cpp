#include "geometry/atlas/atlas_charts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

#include <tbb/parallel_for.h>

#include "geometry/mesh/adjacency.h"
#include "geometry/mesh/vertex_weld.h"

namespace patina {
namespace {

constexpr double kNeedle = 1e-10; // height over length; a thinner face counts as a line
constexpr float kSmallCosine = static_cast<float>(kMinCosine) + 1e-4f;
constexpr float kLargeCosine = 0.8f;

// Candidate planes of a growing chart: every direction is within 28 degrees of one.
constexpr std::size_t kPlanes = 26;
using Cone = std::array<float, kPlanes>; // smallest cosine between the faces and each plane

std::array<Eigen::Vector3f, kPlanes> planes() {
  std::array<Eigen::Vector3f, kPlanes> result;
  std::size_t count = 0;
  for (int corners = 1; corners <= 3; ++corners) // axes first: they label the faces
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          if (std::abs(x) + std::abs(y) + std::abs(z) == corners)
            result[count++] =
                Eigen::Vector3i(x, y, z).cast<float>() / std::sqrt(static_cast<float>(corners));
  return result;
}

std::int8_t axisOf(const Vec3& normal) {
  if (normal.isZero()) return kNone;
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return static_cast<std::int8_t>(2 * axis + (normal[axis] < 0 ? 1 : 0));
}

// Connected faces of one label, stored region after region.
struct Regions {
  std::vector<std::int32_t> of;        // region of each face, -1 without area
  std::vector<std::int32_t> faces;     // sorted by region
  std::vector<std::size_t> offsets{0}; // offset of each region in faces
  std::size_t count() const { return offsets.size() - 1; }
};

Regions regionsOf(const AtlasSurface& surface) {
  const std::size_t count = surface.triangles.size();
  std::vector<std::int8_t> label(count);
  tbb::parallel_for(std::size_t{0}, count,
                    [&](std::size_t f) { label[f] = axisOf(surface.normals[f]); });
  Regions regions;
  regions.of.assign(count, kNone);
  regions.faces.reserve(count);
  for (std::size_t seed = 0; seed < count; ++seed) {
    if (regions.of[seed] != kNone || label[seed] == kNone) continue;
    const auto region = static_cast<std::int32_t>(regions.count());
    const auto take = [&](std::size_t f) {
      regions.of[f] = region;
      regions.faces.push_back(static_cast<std::int32_t>(f));
    };
    take(seed);
    for (std::size_t k = regions.offsets.back(); k < regions.faces.size(); ++k)
      for (const std::int32_t next : surface.neighbours[index(regions.faces[k])])
        if (next != kNone && regions.of[index(next)] == kNone && label[index(next)] == label[seed])
          take(index(next));
    regions.offsets.push_back(regions.faces.size());
  }
  return regions;
}

// Joins regions, the smallest first, across their longest common boundary.
class Joiner {
 public:
  Joiner(const AtlasSurface& surface, const Regions& regions)
      : parent_(regions.count()), area_(regions.count(), 0), cone_(regions.count()),
        links_(regions.count()) {
    std::iota(parent_.begin(), parent_.end(), 0);
    const auto normals = planes();
    tbb::parallel_for(std::size_t{0}, regions.count(), [&](std::size_t r) {
      Cone& cone = cone_[r];
      cone.fill(1);
      for (std::size_t k = regions.offsets[r]; k < regions.offsets[r + 1]; ++k) {
        const std::size_t f = index(regions.faces[k]);
        const Eigen::Vector3f n = surface.normals[f].cast<float>();
        for (std::size_t p = 0; p < kPlanes; ++p) cone[p] = std::min(cone[p], n.dot(normals[p]));
        area_[r] += surface.areas[f];
        for (std::size_t e = 0; e < 3; ++e) {
          const std::int32_t next = surface.neighbours[f][e];
          if (next == kNone || regions.of[index(next)] == static_cast<std::int32_t>(r)) continue;
          const Triangle& t = surface.triangles[f];
          const double length =
              (surface.positions[index(t[(e + 1) % 3])] - surface.positions[index(t[e])]).norm();
          if (regions.of[index(next)] != kNone)
            links_[r].push_back({regions.of[index(next)], length});
        }
      }
      gather(links_[r]);
    });
  }

  void join(double small_area) {
    struct Next {
      double area;
      std::int32_t region;
      bool operator>(const Next& other) const {
        return std::tie(area, region) > std::tie(other.area, other.region);
      }
    };
    std::vector<Next> all;
    for (std::size_t r = 0; r < parent_.size(); ++r)
      all.push_back({area_[r], static_cast<std::int32_t>(r)});
    std::priority_queue<Next, std::vector<Next>, std::greater<>> queue({}, std::move(all));
    while (!queue.empty()) {
      const Next next = queue.top();
      queue.pop();
      // A region that has grown since has a later entry.
      if (parent_[index(next.region)] != next.region || area_[index(next.region)] != next.area)
        continue;
      const std::int32_t into = bestNeighbour(next.region, small_area);
      if (into == kNone) continue; // Final: the neighbours' cones only become narrower.
      queue.push({merge(next.region, into), find(into)});
    }
  }

  std::int32_t find(std::int32_t r) {
    while (parent_[index(r)] != r) {
      parent_[index(r)] = parent_[index(parent_[index(r)])];
      r = parent_[index(r)];
    }
    return r;
  }
  // Returns the plane with the least stretch and the smallest cosine there.
  std::pair<Vec3, double> plane(std::int32_t root) const {
    const Cone& cone = cone_[index(root)];
    const auto best = std::max_element(cone.begin(), cone.end());
    return {planes()[static_cast<std::size_t>(best - cone.begin())].cast<double>().normalized(),
            *best};
  }

 private:
  struct Link {
    std::int32_t region;
    double length;
  };

  static void gather(std::vector<Link>& links) {
    std::sort(links.begin(), links.end(), [](const Link& a, const Link& b) {
      return std::tie(a.region, a.length) < std::tie(b.region, b.length);
    });
    std::size_t count = 0;
    for (const Link& link : links)
      if (count > 0 && links[count - 1].region == link.region)
        links[count - 1].length += link.length;
      else
        links[count++] = link;
    links.resize(count);
  }

  std::int32_t bestNeighbour(std::int32_t region, double small_area) {
    std::vector<Link>& links = links_[index(region)];
    for (Link& link : links) link.region = find(link.region);
    std::erase_if(links, [&](const Link& link) { return link.region == region; });
    gather(links);
    const float least = area_[index(region)] < small_area ? kSmallCosine : kLargeCosine;
    const Link* best = nullptr;
    for (const Link& link : links) {
      if (best && link.length <= best->length) continue;
      const Cone &a = cone_[index(region)], &b = cone_[index(link.region)];
      float cosine = -1;
      for (std::size_t p = 0; p < kPlanes; ++p) cosine = std::max(cosine, std::min(a[p], b[p]));
      if (cosine >= least) best = &link;
    }
    return best ? best->region : kNone;
  }

  double merge(std::int32_t from, std::int32_t into) {
    if (links_[index(from)].size() > links_[index(into)].size()) std::swap(from, into);
    parent_[index(from)] = into;
    for (std::size_t p = 0; p < kPlanes; ++p)
      cone_[index(into)][p] = std::min(cone_[index(into)][p], cone_[index(from)][p]);
    auto& links = links_[index(into)];
    links.insert(links.end(), links_[index(from)].begin(), links_[index(from)].end());
    std::vector<Link>().swap(links_[index(from)]);
    return area_[index(into)] += area_[index(from)];
  }

  std::vector<std::int32_t> parent_;
  std::vector<double> area_;
  std::vector<Cone> cone_;
  std::vector<std::vector<Link>> links_;
};

// Replaces the plane's normal by the mean normal, which is exact for a flat or symmetric chart.
void refitPlane(const AtlasSurface& surface, Chart& chart, double cosine) {
  Vec3 mean = Vec3::Zero();
  for (const std::int32_t f : chart.faces)
    mean += surface.areas[index(f)] * surface.normals[index(f)];
  if (!(mean.norm() > 0)) return;
  mean.normalize();
  double least = 1;
  for (const std::int32_t f : chart.faces)
    least = std::min(least, mean.dot(surface.normals[index(f)]));
  if (least > cosine) chart.normal = mean;
}

// Layers of a mesh with duplicate faces: 0 for the first face of a set of duplicates, 1 for the
// first of opposite orientation, kDuplicate for the others.
constexpr std::int8_t kDuplicate = 2;
struct Layers {
  std::vector<std::int8_t> of; // layer of each face
  std::vector<AtlasSurface::Duplicate> duplicates;
  bool has_back = false; // a face is in layer 1
};

Layers layersOf(const std::vector<Triangle>& triangles) {
  struct Place {
    Triangle sorted;
    std::int32_t face;
    bool odd; // the face's corners are in odd permutation
    bool operator<(const Place& other) const {
      return std::tie(sorted, face) < std::tie(other.sorted, other.face);
    }
  };
  std::vector<Place> places;
  places.reserve(triangles.size());
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const Triangle& t = triangles[f];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    Place place{t, static_cast<std::int32_t>(f), ((t[0] > t[1]) != (t[1] > t[2])) != (t[0] > t[2])};
    std::sort(place.sorted.begin(), place.sorted.end());
    places.push_back(place);
  }
  std::sort(places.begin(), places.end());
  Layers layers;
  layers.of.assign(triangles.size(), 0);
  for (std::size_t first = 0, last = 0; first < places.size(); first = last) {
    const Place* back = nullptr;
    for (last = first + 1; last < places.size() && places[last].sorted == places[first].sorted;
         ++last) {
      const Place& next = places[last];
      const Place* same = next.odd == places[first].odd ? &places[first] : back;
      if (same)
        layers.duplicates.push_back({next.face, same->face});
      else
        back = &next;
      layers.of[index(next.face)] = same ? kDuplicate : 1;
    }
    layers.has_back = layers.has_back || back;
  }
  return layers;
}

// Finds neighbours within each layer, so that the back of a sheet is a surface of its own.
Adjacency adjacencyOf(const TriangleMesh& mesh, const Layers& layers) {
  if (layers.duplicates.empty() && !layers.has_back) return adjacency(mesh);
  const auto only = [&](std::int8_t layer) {
    TriangleMesh part{mesh.positions, mesh.triangles, {}};
    for (std::size_t f = 0; f < part.triangles.size(); ++f)
      if (layers.of[f] != layer) part.triangles[f].fill(mesh.triangles[f][0]);
    return adjacency(part);
  };
  Adjacency around = only(0);
  if (!layers.has_back) return around;
  const Adjacency back = only(1);
  for (std::size_t f = 0; f < layers.of.size(); ++f)
    if (layers.of[f] == 1) around.face_neighbours[f] = back.face_neighbours[f];
  return around;
}

} // namespace

AtlasSurface atlasSurface(const TriangleMesh& mesh) {
  TriangleMesh welded;
  VertexWeld weld(mesh.positions.size());
  std::vector<std::int32_t> one(mesh.positions.size());
  for (std::size_t v = 0; v < one.size(); ++v) one[v] = weld.index(mesh.positions[v]);
  welded.positions = weld.takePoints();
  const Box3 box = bounds(mesh);
  if (!box.isEmpty())
    for (Vec3& p : welded.positions) p -= box.center();
  welded.triangles = mesh.triangles;
  for (Triangle& t : welded.triangles)
    for (std::int32_t& v : t) v = one[index(v)];

  AtlasSurface surface;
  Layers layers = layersOf(welded.triangles);
  Adjacency around = adjacencyOf(welded, layers);
  surface.neighbours = std::move(around.face_neighbours);
  surface.vertex_offsets = std::move(around.vertex_offsets);
  surface.vertex_faces = std::move(around.vertex_faces);
  surface.normals.resize(mesh.triangles.size());
  surface.areas.assign(mesh.triangles.size(), 0);
  const std::vector<Triangle>& triangles = welded.triangles;
  tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t f) {
    const Vec3 a = welded.corner(f, 0), b = welded.corner(f, 1), c = welded.corner(f, 2);
    const double longest2 =
        std::max({(b - a).squaredNorm(), (c - a).squaredNorm(), (c - b).squaredNorm()});
    const double doubled = (b - a).cross(c - a).norm();
    surface.normals[f] = Vec3::Zero();
    if (layers.of[f] != kDuplicate && doubled > kNeedle * longest2 &&
        doubled < std::numeric_limits<double>::infinity()) {
      surface.normals[f] = faceNormal(welded, f);
      surface.areas[f] = doubled / 2;
    }
    for (std::size_t e = 0; e < 3; ++e) {
      std::int32_t& next = surface.neighbours[f][e];
      if (next == kNone) continue;
      const Triangle& other = triangles[index(next)];
      const auto at = std::find(other.begin(), other.end(), triangles[f][(e + 1) % 3]);
      const std::size_t k = static_cast<std::size_t>(at - other.begin());
      if (k == 3 || other[(k + 1) % 3] != triangles[f][e]) next = kNone;
    }
  });
  surface.positions = std::move(welded.positions);
  surface.triangles = std::move(welded.triangles);
  surface.duplicates = std::move(layers.duplicates);
  return surface;
}

std::vector<Chart> grownCharts(const AtlasSurface& surface, double small_area) {
  const Regions regions = regionsOf(surface);
  Joiner joiner(surface, regions);
  joiner.join(small_area);
  std::vector<std::int32_t> chart_of(regions.count(), kNone);
  std::vector<Chart> charts;
  std::vector<double> cosines;
  for (std::size_t r = 0; r < regions.count(); ++r) {
    const std::int32_t root = joiner.find(static_cast<std::int32_t>(r));
    if (chart_of[index(root)] == kNone) {
      chart_of[index(root)] = static_cast<std::int32_t>(charts.size());
      const auto [normal, cosine] = joiner.plane(root);
      charts.push_back({{}, normal});
      cosines.push_back(cosine);
    }
    std::vector<std::int32_t>& faces = charts[index(chart_of[index(root)])].faces;
    const auto first = regions.faces.begin();
    faces.insert(faces.end(), first + static_cast<std::ptrdiff_t>(regions.offsets[r]),
                 first + static_cast<std::ptrdiff_t>(regions.offsets[r + 1]));
  }
  tbb::parallel_for(std::size_t{0}, charts.size(),
                    [&](std::size_t c) { refitPlane(surface, charts[c], cosines[c]); });
  return charts;
}

} // namespace patina
