#include "acquisition/simulation/simulated_frames.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "acquisition/tracking/lens.h"

namespace patina {
namespace {

constexpr int kRays = 8; // along each side of a pixel on an edge

const Vec2 kNoRay(NAN, NAN); // ray outside the field of view of a fisheye lens

// A printed face at one moment, prepared for ray casting.
struct Face {
  const PrintedMarker* marker;
  Vec3 x, y, normal; // in the camera's frame, unit
  double u, v, far;  // its center along these
  double reach, light;
};

// Returns the distance from the center to the end of the margin [m].
double reachOf(const PrintedMarker& marker) {
  return marker.place.size * (0.5 + marker.margin / (marker.side + 2));
}

struct Scene {
  std::vector<std::vector<Face>> moments;
  int left, right, top, bottom; // pixels outside contain only the ground
};

constexpr double kGround = -1; // value of a ray that hits no marker

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

double trace(const std::vector<Face>& faces, const Vec2& ray, const FrameLook& look) {
  double grey = kGround, nearest = INFINITY;
  const Vec3 direction(ray.x(), ray.y(), 1);
  for (const Face& face : faces) {
    const double slope = face.normal.dot(direction);
    if (slope >= 0) continue; // back side
    const double far = face.far / slope;
    if (!(far > 0 && far < nearest)) continue;
    const double u = far * face.x.dot(direction) - face.u, v = far * face.y.dot(direction) - face.v;
    if (std::abs(u) > face.reach || std::abs(v) > face.reach) continue;
    nearest = far;
    grey = printAt(*face.marker, u, v, look) * face.light;
  }
  return grey;
}

// Adds both neighbours, which are `stride` apart.
void addPairs(const float* low, const float* high, float weight, float* to, int count) {
  for (int i = 0; i < count; ++i) to[i] += weight * (low[i] + high[i]);
}

// Blurs along rows and then along columns; border pixels are repeated.
void blur(std::vector<float>& grey, int width, int height, double sigma) {
  if (!(sigma > 0)) return;
  std::vector<float> half;
  double all = 0;
  for (int k = 0; k <= static_cast<int>(std::ceil(4 * sigma)); ++k) {
    half.push_back(static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma))));
    all += (k ? 2 : 1) * static_cast<double>(half.back());
  }
  for (float& weight : half) weight /= static_cast<float>(all);
  const int reach = static_cast<int>(half.size()) - 1;
  std::vector<float> other(grey.size()), line(index(width + 2 * reach));
  for (int y = 0; y < height; ++y) {
    const float* from = grey.data() + std::ptrdiff_t{y} * width;
    float* to = other.data() + std::ptrdiff_t{y} * width;
    std::fill_n(line.begin(), reach, from[0]);
    std::copy_n(from, width, line.begin() + reach);
    std::fill_n(line.end() - reach, reach, from[width - 1]);
    for (int i = 0; i < width; ++i) to[i] = half[0] * from[i];
    for (int k = 1; k <= reach; ++k)
      addPairs(line.data() + reach - k, line.data() + reach + k, half[index(k)], to, width);
  }
  const auto row = [&](int y) {
    return other.data() + std::ptrdiff_t{std::clamp(y, 0, height - 1)} * width;
  };
  for (int y = 0; y < height; ++y) {
    float* to = grey.data() + std::ptrdiff_t{y} * width;
    for (int i = 0; i < width; ++i) to[i] = half[0] * row(y)[i];
    for (int k = 1; k <= reach; ++k) addPairs(row(y - k), row(y + k), half[index(k)], to, width);
  }
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
      const double reach = reachOf(marker);
      const Vec3 x = face.linear().col(0), y = face.linear().col(1), normal = face.linear().col(2),
                 middle = face.translation();
      scene.moments.back().push_back({&marker, x, y, normal, x.dot(middle), y.dot(middle),
                                      normal.dot(middle), reach,
                                      1 - look.slope_shade * (1 - cosine)});
      for (const Vec2& corner : {Vec2(-1, -1), Vec2(1, -1), Vec2(-1, 1), Vec2(1, 1)}) {
        const Vec3 p = face * Vec3(reach * corner.x(), reach * corner.y(), 0);
        const Vec2 pixel = patina::pixelOf(camera, p);
        const int column = static_cast<int>(std::clamp(pixel.x(), -1e6, 1e6)),
                  row = static_cast<int>(std::clamp(pixel.y(), -1e6, 1e6));
        scene.left = std::min(scene.left, column - 8);
        scene.right = std::max(scene.right, column + 8);
        scene.top = std::min(scene.top, row - 8), scene.bottom = std::max(scene.bottom, row + 8);
      }
    }
  }
  return scene;
}

} // namespace

FrameRenderer::FrameRenderer(const Camera& camera, std::vector<PrintedMarker> markers)
    : camera_(camera), markers_(std::move(markers)) {
  rays_.reserve(index(camera.width + 1) * index(camera.height + 1));
  for (int y = 0; y <= camera.height; ++y)
    for (int x = 0; x <= camera.width; ++x) {
      // The neighbour's ray is a good start value.
      const bool next = x > 0 && rays_.back().allFinite();
      const auto ray =
          normalizedPoint(camera, Vec2(x - 0.5, y - 0.5), next ? &rays_.back() : nullptr);
      if (!ray && camera.lens != LensModel::fisheye)
        throw std::invalid_argument("a lens that shows one direction twice cannot be rendered");
      rays_.push_back(ray.value_or(kNoRay));
      if (x < camera.width && y < camera.height)
        ripples_.push_back(ray ? std::sin(40 * ray->x()) * std::sin(55 * ray->y()) : 0);
    }
}

Vec2 FrameRenderer::pixelOf(const Vec3& in_camera) const {
  return patina::pixelOf(camera_, in_camera);
}

GreyFrame FrameRenderer::render(const std::vector<Pose>& camera_from_probe, const FrameLook& look,
                                std::uint32_t seed) const {
  if (camera_from_probe.empty()) throw std::invalid_argument("a frame without a pose");
  const int width = camera_.width, height = camera_.height;
  Scene scene = sceneOf(camera_, markers_, camera_from_probe, look);
  if (!look.occluders.empty())
    scene.left = scene.top = 0, scene.right = width, scene.bottom = height;
  scene.left = std::max(scene.left, 0), scene.right = std::min(scene.right, width - 1);
  const std::size_t moments = scene.moments.size();
  const auto greyAt = [&](const Vec2& pixel, const Vec2& ray, std::size_t moment) {
    for (const Occluder& disc : look.occluders)
      if ((pixel - disc.middle).squaredNorm() < disc.radius * disc.radius) return disc.grey;
    return trace(scene.moments[moment], ray, look);
  };
  // Rays at the corners of a row of pixels; each serves four of them.
  std::vector<double> above(moments * index(width + 1)), below(above.size());
  const auto look_along = [&](int y, std::vector<double>& corners) {
    for (int x = scene.left; x <= scene.right + 1; ++x)
      for (std::size_t k = 0; k < moments; ++k)
        corners[index(x) * moments + k] =
            greyAt({x - 0.5, y - 0.5}, rays_[index(y) * index(width + 1) + index(x)], k);
  };
  const Vec2 fall(std::cos(look.shade_angle) / width, std::sin(look.shade_angle) / height);
  std::vector<float> grey;
  grey.reserve(index(width) * index(height));
  for (int y = 0; y < height; ++y) {
    const bool near = y >= scene.top && y <= scene.bottom;
    if (near && (y == 0 || y == scene.top)) look_along(y, above);
    if (near) look_along(y + 1, below);
    for (int x = 0; x < width; ++x) {
      const double ground = look.ground * (1 + look.waves * ripples_[grey.size()]);
      double mean = ground;
      if (near && x >= scene.left && x <= scene.right) {
        const Vec2* corner = rays_.data() + std::ptrdiff_t{y} * (width + 1) + x;
        const auto greyOf = [&](double a, double b, std::size_t moment) {
          const Vec2 ray = (1 - b) * ((1 - a) * corner[0] + a * corner[1]) +
                           b * ((1 - a) * corner[width + 1] + a * corner[width + 2]);
          const double seen = greyAt({x - 0.5 + a, y - 0.5 + b}, ray, moment);
          return seen == kGround ? ground : seen;
        };
        mean = greyOf(0.5, 0.5, 0);
        // The pixel is uniform if its corners equal its center during the whole exposure.
        const auto like = [&](double seen) {
          return std::abs((seen == kGround ? ground : seen) - mean) <= 1e-3;
        };
        const auto first = std::ptrdiff_t{x} * static_cast<std::ptrdiff_t>(moments);
        const auto ends = first + 2 * static_cast<std::ptrdiff_t>(moments);
        if (!std::all_of(above.begin() + first, above.begin() + ends, like) ||
            !std::all_of(below.begin() + first, below.begin() + ends, like)) {
          mean = 0;
          // Samples are evenly distributed over rows and columns; each moment has a diagonal.
          for (int i = 0; i < kRays; ++i)
            for (int j = 0; j < kRays; ++j)
              mean += greyOf((i + (j + 0.5) / kRays) / kRays, (j + (i + 0.5) / kRays) / kRays,
                             index(i + j) % moments);
          mean /= kRays * kRays;
        }
      }
      const double light = 1 - look.shade * (fall.dot(Vec2(x - width / 2., y - height / 2.)) + 0.5);
      grey.push_back(static_cast<float>(255 * light * mean));
    }
    if (near) std::swap(above, below);
  }
  blur(grey, width, height, look.blur);
  GreyFrame image{width, height, {}};
  image.pixel.reserve(grey.size());
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, static_cast<float>(look.noise));
  for (const float value : grey) {
    const float noisy = look.noise > 0 ? value + normal(random) : value;
    image.pixel.push_back(static_cast<std::uint8_t>(double{std::clamp(noisy, 0.f, 255.f)} + 0.5));
  }
  return image;
}

namespace {

constexpr int kMoments = 4; // per exposure

} // namespace

ProbeMotion motionOf(const SimulatedHand& hand, const ProbeModel& probe,
                     const Pose& camera_from_world) {
  return [course = HandCourse(hand), tip = probe.tip, camera_from_world](double t) {
    const HandState state = handAt(course, t);
    Pose world_from_probe = Pose::Identity();
    world_from_probe.linear() = state.orientation.toRotationMatrix();
    world_from_probe.translation() = state.tip - state.orientation * tip;
    return camera_from_world * world_from_probe;
  };
}

GreyFrame frameAt(const FrameRenderer& renderer, const ProbeMotion& camera_from_probe,
                  const CaptureSettings& course, int i) {
  const double t = i / course.rate;
  std::vector<Pose> poses;
  for (int k = 0; k < kMoments; ++k)
    poses.push_back(camera_from_probe(t + course.exposure * ((k + 0.5) / kMoments - 0.5)));
  FrameLook look = course.look;
  const bool covered = std::any_of(course.occlusions.begin(), course.occlusions.end(),
                                   [&](const Gap& gap) { return t >= gap.from && t < gap.to; });
  if (covered) look.occluders.push_back({renderer.pixelOf(poses[0].translation()), 1e3});
  return renderer.render(poses, look, course.seed * 100003u + static_cast<std::uint32_t>(i));
}

} // namespace patina
