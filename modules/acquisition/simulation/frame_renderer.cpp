#include "acquisition/simulation/frame_renderer.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace patina {
namespace {

constexpr int kRays = 8; // along each side of a pixel that an edge crosses

// The pixel of a point of the plane z = 1, and how it moves with it: Brown's lens.
struct Seen {
  Vec2 pixel;
  Eigen::Matrix2d slope;
};

Seen throughLens(const Camera& c, const Vec2& p) {
  const auto& d = c.distortion;
  const double x = p.x(), y = p.y(), rr = x * x + y * y;
  const double m = 1 + d[0] * rr + d[1] * rr * rr + d[4] * rr * rr * rr;
  const double dm = 2 * (d[0] + 2 * d[1] * rr + 3 * d[4] * rr * rr); // by rr, times two
  Seen seen;
  seen.pixel = {c.cx + c.fx * (x * m + 2 * d[2] * x * y + d[3] * (rr + 2 * x * x)),
                c.cy + c.fy * (y * m + d[2] * (rr + 2 * y * y) + 2 * d[3] * x * y)};
  const double mixed = x * y * dm + 2 * d[2] * x + 2 * d[3] * y;
  seen.slope << c.fx * (m + x * x * dm + 2 * d[2] * y + 6 * d[3] * x), c.fx * mixed, c.fy * mixed,
      c.fy * (m + y * y * dm + 6 * d[2] * y + 2 * d[3] * x);
  return seen;
}

// Newton's method, from the neighbour's ray.
Vec2 rayOf(const Camera& camera, const Vec2& pixel, Vec2 ray) {
  for (int i = 0; i < 50; ++i) {
    const Seen seen = throughLens(camera, ray);
    if (!(seen.slope.determinant() > 0)) break;
    const Vec2 step = seen.slope.inverse() * (pixel - seen.pixel);
    ray += step;
    if (step.squaredNorm() < 1e-24) return ray;
  }
  throw std::invalid_argument("a lens that shows one direction twice cannot be rendered");
}

// A printed face at one moment, ready to be met by rays.
struct Face {
  const PrintedMarker* marker;
  Vec3 x, y, normal, middle; // in the camera's frame, unit
  double light;
};

// From its middle to the end of its margin [m].
double reachOf(const PrintedMarker& marker) {
  return marker.place.size * (0.5 + marker.margin / (marker.side + 2));
}

struct Scene {
  std::vector<std::vector<Face>> moments;
  int left, right, top, bottom; // pixels outside show the ground only

  bool near(int x, int y) const { return x >= left && x <= right && y >= top && y <= bottom; }
};

// The albedo that a ray meets: -1 for the ground.
struct Hit {
  double albedo = -1, light = 1;
};

double printAt(const PrintedMarker& marker, double u, double v, const FrameLook& look) {
  const double cell = marker.place.size / (marker.side + 2), half = marker.place.size / 2;
  const double across = (u + half) / cell - 1, down = (half - v) / cell - 1;
  const int column = static_cast<int>(std::floor(across)), row = static_cast<int>(std::floor(down));
  const auto within = [&](int low, int high) {
    return column >= low && column < high && row >= low && row < high;
  };
  if (!within(-1, marker.side + 1)) return look.white;
  if (!within(0, marker.side)) return look.black;
  const int bit = marker.side * marker.side - 1 - (row * marker.side + column);
  return (marker.code >> bit & 1) ? look.white : look.black;
}

Hit trace(const std::vector<Face>& faces, const Vec2& ray, const FrameLook& look) {
  Hit hit;
  double nearest = INFINITY;
  const Vec3 direction(ray.x(), ray.y(), 1);
  for (const Face& face : faces) {
    const double slope = face.normal.dot(direction);
    if (slope >= 0) continue; // seen from behind
    const double far = face.normal.dot(face.middle) / slope;
    if (!(far > 0 && far < nearest)) continue;
    const Vec3 at = far * direction - face.middle;
    const double u = face.x.dot(at), v = face.y.dot(at);
    const double reach = reachOf(*face.marker);
    if (std::abs(u) > reach || std::abs(v) > reach) continue;
    nearest = far;
    hit = {printAt(*face.marker, u, v, look), face.light};
  }
  return hit;
}

void blurLine(const float* from, float* to, int count, std::ptrdiff_t stride,
              const std::vector<float>& half) {
  const int reach = static_cast<int>(half.size()) - 1;
  for (int i = 0; i < count; ++i) {
    float sum = half[0] * from[i * stride];
    for (int k = 1; k <= reach; ++k)
      sum += half[static_cast<std::size_t>(k)] *
             (from[std::max(i - k, 0) * stride] + from[std::min(i + k, count - 1) * stride]);
    to[i * stride] = sum;
  }
}

void blur(std::vector<float>& grey, int width, int height, double sigma) {
  if (!(sigma > 0)) return;
  std::vector<float> half;
  double all = 0;
  for (int k = 0; k <= static_cast<int>(std::ceil(4 * sigma)); ++k) {
    half.push_back(static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma))));
    all += (k ? 2 : 1) * static_cast<double>(half.back());
  }
  for (float& weight : half) weight /= static_cast<float>(all);
  std::vector<float> other(grey.size());
  for (int y = 0; y < height; ++y)
    blurLine(grey.data() + std::ptrdiff_t{y} * width, other.data() + std::ptrdiff_t{y} * width,
             width, 1, half);
  for (int x = 0; x < width; ++x) blurLine(other.data() + x, grey.data() + x, height, width, half);
}

// Whether a pixel's corners look like its middle, all through the exposure.
template <class GreyOf> bool even(double middle, std::size_t moments, const GreyOf& greyOf) {
  for (std::size_t moment = 0; moment < moments; ++moment)
    for (const Vec2& corner : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)})
      if (std::abs(greyOf(corner.x(), corner.y(), moment) - middle) > 1e-3) return false;
  return true;
}

Scene sceneOf(const Camera& camera, const std::vector<PrintedMarker>& markers,
              const std::vector<Pose>& poses, const FrameLook& look) {
  Scene scene{{}, camera.width, 0, camera.height, 0};
  for (const Pose& pose : poses) {
    scene.moments.emplace_back();
    for (const PrintedMarker& marker : markers) {
      const Pose face = pose * marker.place.probe_from_marker;
      const double cosine = -face.translation().normalized().dot(face.linear().col(2));
      if (face.translation().z() <= 0 || cosine <= 0) continue;
      scene.moments.back().push_back({&marker, face.linear().col(0), face.linear().col(1),
                                      face.linear().col(2), face.translation(),
                                      1 - look.slope_shade * (1 - cosine)});
      const double reach = reachOf(marker);
      for (const Vec2& corner : {Vec2(-1, -1), Vec2(1, -1), Vec2(-1, 1), Vec2(1, 1)}) {
        const Vec3 p = face * Vec3(reach * corner.x(), reach * corner.y(), 0);
        const Vec2 pixel = throughLens(camera, p.hnormalized()).pixel;
        const int x = static_cast<int>(std::clamp(pixel.x(), -1e6, 1e6)),
                  y = static_cast<int>(std::clamp(pixel.y(), -1e6, 1e6));
        scene.left = std::min(scene.left, x - 8), scene.right = std::max(scene.right, x + 8);
        scene.top = std::min(scene.top, y - 8), scene.bottom = std::max(scene.bottom, y + 8);
      }
    }
  }
  return scene;
}

} // namespace

FrameRenderer::FrameRenderer(const Camera& camera, std::vector<PrintedMarker> markers)
    : camera_(camera), markers_(std::move(markers)) {
  rays_.reserve(index(camera.width + 1) * index(camera.height + 1));
  // From the middle outwards would be safest; along rows is close enough with a start from above.
  Vec2 row_start((-0.5 - camera.cx) / camera.fx, (-0.5 - camera.cy) / camera.fy);
  for (int y = 0; y <= camera.height; ++y) {
    Vec2 ray = row_start;
    for (int x = 0; x <= camera.width; ++x) {
      ray = rayOf(camera, Vec2(x - 0.5, y - 0.5), ray);
      if (x == 0) row_start = ray;
      rays_.push_back(ray);
    }
  }
}

Vec2 FrameRenderer::pixelOf(const Vec3& in_camera) const {
  return throughLens(camera_, in_camera.hnormalized()).pixel;
}

GreyFrame FrameRenderer::render(const std::vector<Pose>& camera_from_probe, const FrameLook& look,
                                std::uint32_t seed) const {
  if (camera_from_probe.empty()) throw std::invalid_argument("a frame without a pose");
  const int width = camera_.width, height = camera_.height;
  const Scene scene = sceneOf(camera_, markers_, camera_from_probe, look);
  const Vec2 fall(std::cos(look.shade_angle) / width, std::sin(look.shade_angle) / height);
  std::vector<float> grey;
  grey.reserve(index(width) * index(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Vec2* corner = rays_.data() + std::ptrdiff_t{y} * (width + 1) + x;
      const auto rayAt = [&](double a, double b) -> Vec2 {
        return (1 - b) * ((1 - a) * corner[0] + a * corner[1]) +
               b * ((1 - a) * corner[width + 1] + a * corner[width + 2]);
      };
      const double ground =
          look.ground * (1 + look.waves * std::sin(40 * corner->x()) * std::sin(55 * corner->y()));
      const auto greyOf = [&](double a, double b, std::size_t moment) {
        const Vec2 at(x - 0.5 + a, y - 0.5 + b);
        for (const Occluder& disc : look.occluders)
          if ((at - disc.middle).squaredNorm() < disc.radius * disc.radius) return disc.grey;
        const Hit hit = trace(scene.moments[moment], rayAt(a, b), look);
        return hit.albedo >= 0 ? hit.albedo * hit.light : ground;
      };
      double mean = ground;
      if (!look.occluders.empty() || scene.near(x, y)) {
        mean = greyOf(0.5, 0.5, 0);
        if (!even(mean, scene.moments.size(), greyOf)) {
          mean = 0;
          // Their shadows on rows and on columns are evenly spaced, each moment on a diagonal.
          for (int i = 0; i < kRays; ++i)
            for (int j = 0; j < kRays; ++j)
              mean += greyOf((i + (j + 0.5) / kRays) / kRays, (j + (i + 0.5) / kRays) / kRays,
                             index(i + j) % scene.moments.size());
          mean /= kRays * kRays;
        }
      }
      const double light = 1 - look.shade * (fall.dot(Vec2(x - width / 2., y - height / 2.)) + 0.5);
      grey.push_back(static_cast<float>(255 * light * mean));
    }
  blur(grey, width, height, look.blur);
  GreyFrame image{width, height, {}};
  image.pixel.reserve(grey.size());
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, static_cast<float>(look.noise));
  for (const float value : grey) {
    const float noisy = look.noise > 0 ? value + normal(random) : value;
    image.pixel.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(noisy, 0.f, 255.f))));
  }
  return image;
}

} // namespace patina
