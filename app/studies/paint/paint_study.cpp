#include "app/studies/framework/studies.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include "app/studies/framework/query_timing.h"
#include "app/studies/paint/paint_shapes.h"
#include "geometry/mesh/shapes.h"
#include "session/compile/compile_scene.h"
#include "session/open/session.h"
#include "session/store/replay.h"

namespace patina {
namespace {

constexpr double kSide = 0.04;      // side of the slab [m]
constexpr double kThickness = 0.01; // [m]
constexpr double kPeriod = 1e-3;    // [s]
constexpr double kPi = std::numbers::pi;

double secondsSince(const std::chrono::steady_clock::time_point& start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// --- K17: coverage of a brush

struct WeightForm {
  BrushShape shape;
  const char* name;
  double (*share)(double falloff); // integral of w over the disc, divided by pi r^2
};

constexpr WeightForm kForms[]{
    {BrushShape::power, "power", [](double f) { return f / (f + 2); }},
    {BrushShape::cone, "cone", [](double f) { return 2 / ((f + 1) * (f + 2)); }},
    {BrushShape::smooth, "smooth", [](double f) { return 1 / (f + 1); }}};

double covered(const ObjectPaint& paint) {
  const TiledImage& image = *paint.color;
  double sum = 0;
  for (int j = 0; j < image.height(); ++j)
    for (int i = 0; i < image.width(); ++i) sum += static_cast<double>(image.at(i, j, 3));
  return sum * kSide * kSide / (image.width() * image.height());
}

WorkPrecisionTable coverage(const std::vector<int>& sizes, int dabs, Progress& progress) {
  WorkPrecisionTable table = tableOf(
      "Area under one dab against T-K17's integrals; a hard rim on a lattice: order 1.5", "%");
  OrderFit order;
  for (const int size : sizes) {
    Scene scene = slabScene(kSide, kThickness, 60);
    layEmptyColor(scene, size);
    const auto compiled = compile(scene, progress);
    const auto surface = paintSurfaceOf(*compiled, compiled->scene, nullptr, true, progress);
    for (const WeightForm& form : kForms) {
      for (const double falloff : {1.0, 3.0, 1e5}) {
        if (falloff > 3 && form.shape != BrushShape::power) continue; // the hard brush
        progress.throwIfCancelled();
        Stroke stroke;
        stroke.brush.radius = 0.004;
        stroke.brush.falloff = falloff;
        stroke.brush.shape = form.shape;
        const double truth = form.share(falloff) * kPi * stroke.brush.radius * stroke.brush.radius;
        std::mt19937 random(3);
        std::uniform_real_distribution<double> place(-0.3 * kSide, 0.3 * kSide);
        WorkPrecisionRow row;
        row.settings = {{"image", size}, {"shape", form.name}, {"falloff", falloff}};
        PaintReport report;
        double took = 0;
        for (int i = 0; i < dabs; ++i) {
          stroke.samples.clear();
          stroke.samples.push_back({0, Vec3(place(random), place(random), 0), 1, {}});
          const auto start = std::chrono::steady_clock::now();
          const Scene after = painted(surface, scene, stroke, &report);
          took += secondsSince(start);
          const double error = 100 * (covered(*after.objects[0].paint) / truth - 1);
          row.error += error * error / dabs;
          row.error_max = std::max(row.error_max, std::abs(error));
          row.bytes = static_cast<double>(bytes(*after.objects[0].paint));
        }
        row.error = std::sqrt(row.error);
        row.ns = 1e9 * took / dabs;
        row.more = {{"texels a dab", static_cast<double>(report.texels)}};
        if (falloff > 3) order.add(kSide / size, row.error);
        table.rows.push_back(std::move(row));
      }
    }
  }
  order.into(table, 1.5);
  return table;
}

// --- F8: height and slope of a cosine

struct Felt {
  double height_rms = 0, height_max = 0; // fractions of the amplitude
  double crest = 0;                      // max loss of height at crests, fraction of the amplitude
  double slope_rms = 0;                  // fraction of the max slope
  double ns = 0;
};

// Height at which a descending tip touches [m].
double touchedAt(const HapticSnapshot& snapshot, double x, double y, double reach) {
  double low = -reach, high = reach;
  for (int i = 0; i < 40; ++i) {
    const double z = 0.5 * (low + high);
    ContactMemory memory;
    (tick(snapshot, memory, Vec3(x, y, z), kPeriod).touching ? low : high) = z;
  }
  return 0.5 * (low + high);
}

Felt felt(const HapticSnapshot& snapshot, double amplitude, double wavelength, int points) {
  const double k = 2 * kPi / wavelength;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-0.3 * kSide, 0.3 * kSide);
  Felt result;
  std::vector<Vec3> tips;
  for (int i = 0; i < points; ++i) {
    // Every fourth point is on a crest.
    double x = place(random);
    const bool crest = i % 4 == 0;
    if (crest) x = wavelength * std::round(x / wavelength);
    const double y = place(random);
    const double z = touchedAt(snapshot, x, y, 4 * amplitude);
    const double truth = amplitude * std::cos(k * x);
    const double error = std::abs(z - truth) / amplitude;
    result.height_rms += error * error / points;
    result.height_max = std::max(result.height_max, error);
    if (crest) {
      result.crest = std::max(result.crest, 1 - z / amplitude);
    }
    const Vec3 tip(x, y, z - 0.02 * amplitude);
    ContactMemory memory;
    const Vec3 force = tick(snapshot, memory, tip, kPeriod).force;
    const double slope = force.z() > 0 ? -force.x() / force.z() : 0;
    const double off = (slope + amplitude * k * std::sin(k * x)) / (amplitude * k);
    result.slope_rms += off * off / points;
    tips.push_back(tip);
  }
  result.height_rms = std::sqrt(result.height_rms);
  result.slope_rms = std::sqrt(result.slope_rms);
  result.ns = nsPerQuery(tips, [&](const Vec3& tip) {
    ContactMemory memory;
    return tick(snapshot, memory, tip, kPeriod).depth;
  });
  return result;
}

WorkPrecisionRow reliefRow(const Felt& result, const CompiledScene& compiled) {
  WorkPrecisionRow row;
  row.error = 100 * result.height_rms;
  row.error_max = 100 * result.height_max;
  row.ns = result.ns;
  row.bytes = static_cast<double>(compiled.built.field->bytes() + compiled.paint.bytes() +
                                  compiled.scene.objects[0].paint->relief->bytes());
  row.more = {{"crest lost [%]", 100 * result.crest}, {"slope error [%]", 100 * result.slope_rms}};
  return row;
}

struct Reading {
  const char* name;
  ReliefMode mode;
  Sampler sampler;
  int texels; // min texels per wavelength
};

// A cosine by its wavelength. The baked image's texels are so fine that only the grid's error
// remains.
WorkPrecisionTable wavelengths(const Reading& reading, const std::vector<double>& voxels,
                               int resolution, int points, Progress& progress) {
  const bool kim = reading.mode == ReliefMode::baked && reading.sampler == Sampler::kim;
  WorkPrecisionTable table =
      tableOf(std::string("Relief ") + reading.name + ": a cosine by its wavelength" +
                  (kim ? "; at most 1 - cos(pi h / lambda) is lost (F8), order 2" : ""),
              "%");
  OrderFit order;
  for (const double count : voxels) {
    progress.throwIfCancelled();
    Scene scene = slabScene(kSide, kThickness, resolution);
    scene.sampler = reading.sampler;
    scene.field.voxel = kSide / (resolution - 2 * scene.field.band);
    const double wavelength = count * *scene.field.voxel;
    const double amplitude = 0.02 * wavelength;
    int size = 64;
    while (size < reading.texels * kSide / wavelength && size < kMaxImage) size *= 2;
    layRelief(scene, kSide, size,
              [&](double x, double) { return std::cos(2 * kPi * x / wavelength); });
    scene.relief.height = amplitude;
    scene.relief.mode = reading.mode;
    const auto compiled = compile(scene, progress);
    WorkPrecisionRow row =
        reliefRow(felt(*compiled->snapshot, amplitude, wavelength, points), *compiled);
    row.settings = {{"relief", reading.name},
                    {"voxels a wavelength", count},
                    {"texels a wavelength", size * wavelength / kSide}};
    if (kim) {
      row.more.emplace_back("lost by theory [%]", 100 * (1 - std::cos(kPi / count)));
      if (count >= 8) order.add(1 / count, row.error);
    }
    table.rows.push_back(std::move(row));
  }
  if (kim) order.into(table, 2);
  return table;
}

WorkPrecisionTable texels(const std::vector<int>& sizes, int points, Progress& progress) {
  WorkPrecisionTable table =
      tableOf("Relief pulled, by its image: cubics, order 3, whatever the voxel", "%");
  OrderFit order;
  const double wavelength = kSide / 10, amplitude = 0.02 * wavelength;
  for (const int size : sizes) {
    progress.throwIfCancelled();
    Scene scene = slabScene(kSide, kThickness, 60);
    layRelief(scene, kSide, size,
              [&](double x, double) { return std::cos(2 * kPi * x / wavelength); });
    scene.relief.height = amplitude;
    const auto compiled = compile(scene, progress);
    WorkPrecisionRow row =
        reliefRow(felt(*compiled->snapshot, amplitude, wavelength, points), *compiled);
    row.settings = {{"texels a wavelength", size * wavelength / kSide}};
    order.add(1.0 / size, row.error);
    table.rows.push_back(std::move(row));
  }
  order.into(table, 3);
  return table;
}

// --- T-K21a: a raised sphere, fully baked

WorkPrecisionTable raised(const std::vector<int>& resolutions, int points, Progress& progress) {
  constexpr double kRadius = 0.03, kHeight = 1e-3;
  WorkPrecisionTable table = tableOf(
      "A sphere raised by 1 mm, baked (T-K21a): radius felt; ns of baking the whole image", "m");
  for (const int resolution : resolutions) {
    for (const int size : {128, 512}) {
      progress.throwIfCancelled();
      Scene scene = sceneOf(icosphere(kRadius, 60), "ball");
      scene.field.resolution = resolution;
      scene.relief.mode = ReliefMode::baked;
      scene.relief.height = kHeight;
      auto image = std::make_shared<TiledImage>(size, size, 1);
      for (std::size_t t = 0; t < image->tileCount(); ++t)
        std::fill_n(image->writable(t), kTileSide * kTileSide, 1.0f);
      ObjectPaint paint;
      paint.layout = textureLayout(*scene.objects[0].mesh, size);
      paint.relief = image;
      scene.objects[0].paint = std::make_shared<const ObjectPaint>(std::move(paint));
      const auto compiled = compile(scene, progress);
      WorkPrecisionRow row;
      row.settings = {{"resolution", resolution}, {"image", size}};
      std::mt19937 random(11);
      std::normal_distribution<double> normal;
      for (int i = 0; i < points; ++i) {
        const Vec3 n = Vec3(normal(random), normal(random), normal(random)).normalized();
        double low = kRadius, high = kRadius + 2 * kHeight;
        for (int step = 0; step < 40; ++step) {
          const double r = 0.5 * (low + high);
          ContactMemory memory;
          (tick(*compiled->snapshot, memory, r * n, kPeriod).touching ? low : high) = r;
        }
        const double error = std::abs(low - kRadius - kHeight);
        row.error += error / points;
        row.error_max = std::max(row.error_max, error);
      }
      const ReliefInput source{0, static_cast<std::int32_t>(compiled->mesh->triangles.size()),
                               scene.objects[0].paint->layout.uvs, image, kHeight};
      double best = std::numeric_limits<double>::infinity();
      for (int pass = 0; pass < 5; ++pass) {
        const auto start = std::chrono::steady_clock::now();
        (void)compiled->paint.bake->baked(std::span(&source, 1));
        best = std::min(best, secondsSince(start));
      }
      row.ns = 1e9 * best;
      row.bytes = static_cast<double>(compiled->paint.field->bytes() + compiled->paint.bytes());
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

} // namespace

std::vector<WorkPrecisionTable> paintStudy(const StudyOptions& options, Progress& progress) {
  const bool quick = options.quick;
  const int points = quick ? 400 : 2000, resolution = quick ? 80 : 150;
  const std::vector<int> images = quick ? std::vector{128, 512} : std::vector{128, 256, 512, 1024};
  const std::vector<int> texel_counts =
      quick ? std::vector{128, 256} : std::vector{64, 128, 256, 512};
  const std::vector<int> grids = quick ? std::vector{64} : std::vector{64, 100, 150};
  const std::vector<double> waves =
      quick ? std::vector<double>{2.5, 8, 12, 16} : std::vector<double>{2.5, 4, 6, 8, 12, 16};
  std::vector<StudyPart> parts = {{0, "coverage", [&] { return coverage(images, 40, progress); }}};
  for (const Reading& reading : {Reading{"baked (kim)", ReliefMode::baked, Sampler::kim, 96},
                                 Reading{"baked (high)", ReliefMode::baked, Sampler::high, 96},
                                 Reading{"pulled", ReliefMode::pulled, Sampler::high, 22}})
    parts.push_back({0.15 * static_cast<double>(1 + parts.size()), reading.name, [&, reading] {
                       return wavelengths(reading, waves, resolution, points, progress);
                     }});
  parts.push_back(
      {0.7, "relief by texels", [&] { return texels(texel_counts, points, progress); }});
  parts.push_back({0.8, "raised sphere", [&] { return raised(grids, points / 4, progress); }});
  return tablesOf(parts, progress);
}

} // namespace patina
