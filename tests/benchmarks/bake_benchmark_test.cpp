// Relief baked into the field while a person paints (K20, K21): the whole image within a picture's
// time, one dab within a few milliseconds whatever the mesh. Least times of several runs.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <thread>

#include "authoring/relief_shapes.h"
#include "geometry/mesh_io.h"
#include "geometry/mesh_unit.h"
#include "geometry/texel_map.h"
#include "support/busy_machine.h"
#include "support/sanitized.h"
#include "support/shared_data.h"

namespace patina {
namespace {

using test::kSanitized;
using test::kSlowMachine;

constexpr int kImage = 512, kRepeats = 12;

double secondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class Work> double leastSeconds(const Work& work) {
  double least = 1e9;
  for (int i = 0; i < kRepeats; ++i) least = std::min(least, secondsOf(work));
  return least;
}

struct Painted {
  TriangleMesh mesh;
  std::shared_ptr<const SurfaceField> field;
  std::vector<ReliefSource> sources;
};

Painted painted(TriangleMesh mesh, const std::shared_ptr<const TiledImage>& image) {
  const TextureLayout layout = textureLayout(mesh, kImage);
  FieldSpec spec;
  spec.resolution = 150;
  Painted result{std::move(mesh), nullptr, {}};
  result.field = withSamples(test::fieldOf(result.mesh, spec));
  result.sources = {test::sourceOf(result.mesh, layout.uvs, image, 1e-3)};
  return result;
}

std::shared_ptr<const TiledImage> waves() {
  return test::reliefImage(kImage, [](double u, double v) {
    return 0.55 + 0.25 * std::sin(120 * u) + 0.2 * std::cos(90 * v);
  });
}

void expectWithin(double seconds, double limit) {
  EXPECT_LE(seconds, limit * kSlowMachine);
  if (seconds > limit)
    GTEST_SKIP() << limit * 1e3 << " ms do not hold on this machine now: see above";
}

void wholeImage(const char* name, TriangleMesh mesh) {
  const Painted shape = painted(std::move(mesh), waves());
  const test::StolenTime stolen;
  std::optional<ReliefBake> bake;
  Progress progress;
  const double made =
      secondsOf([&] { bake.emplace(shape.field, shape.mesh, shape.sources, progress); });
  std::shared_ptr<const SurfaceField> result; // the last one lives on, as that of the servo
  const double seconds = leastSeconds([&] { result = bake->baked(shape.sources); });
  std::printf("%s: %zu blocks, %s faces; whole image baked in %.1f ms; made in %.0f ms, %.1f MB "
              "beside %.1f MB of field\n",
              name, shape.field->blockCount(), std::to_string(shape.mesh.triangles.size()).c_str(),
              seconds * 1e3, made * 1e3, static_cast<double>(bake->bytes()) * 1e-6,
              static_cast<double>(result->bytes()) * 1e-6);
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "the row is for two cores";
  if (test::machineIsCrowded() || stolen.share() > 0.05) GTEST_SKIP() << "the machine is busy";
  expectWithin(seconds, 33e-3);
}

TEST(BakeTiming, WholeImageOnASphere) {
  if (kSanitized) GTEST_SKIP() << "times mean nothing under a sanitizer";
  wholeImage("sphere", icosphere(0.05, 22));
}

TEST(BakeTiming, WholeImageOnAScannedHead) {
  if (kSanitized) GTEST_SKIP() << "times mean nothing under a sanitizer";
  const auto path = test::sharedData("meshes/goathead.obj");
  PATINA_SKIP_WITHOUT(path);
  wholeImage("goathead", inMetres(readMesh(path), MeshUnit::fit).mesh);
}

// A dab of 5 % of the object on a whole painted image: every texel whose face has a corner there.
double dabSeconds(const char* name, TriangleMesh mesh) {
  const Painted shape = painted(std::move(mesh), waves());
  Progress progress;
  const ReliefBake bake(shape.field, shape.mesh, shape.sources, progress);
  const Vec3 centre = Vec3(0.3, 0.5, 0.8).normalized() * 0.05;
  const TexelMap texels = texelMap(*shape.sources[0].uvs, kImage, kImage);
  auto dabbed = std::make_shared<TiledImage>(*shape.sources[0].image);
  std::size_t count = 0;
  for (int j = 0; j < kImage; ++j)
    for (int i = 0; i < kImage; ++i) {
      const std::int32_t face = texels.ownerAt(i, j);
      if (face < 0) continue;
      const Vec3 w = texelBarycentric((*shape.sources[0].uvs)[static_cast<std::size_t>(face)],
                                      (i + 0.5) / kImage, (j + 0.5) / kImage);
      if ((position(shape.mesh, {face, w}) - centre).norm() > 5e-3) continue;
      dabbed->writable(dabbed->tileOf(i, j))[dabbed->offsetOf(i, j)] += 0.1F;
      ++count;
    }
  std::vector<ReliefSource> after = shape.sources;
  after[0].image = dabbed;
  const auto before = bake.baked(shape.sources);
  std::shared_ptr<const SurfaceField> result;
  const double seconds =
      leastSeconds([&] { result = bake.rebaked(*before, shape.sources, after); });
  std::size_t moved = 0, sampled = 0;
  for (std::size_t slot = 0; slot < result->blockCount(); ++slot) {
    moved += result->distance[slot] != before->distance[slot];
    sampled += result->sample[slot] != before->sample[slot];
  }
  std::printf("%s: %zu faces, dab of %zu texels: %zu of %zu blocks moved, %zu sampled, %.2f ms\n",
              name, shape.mesh.triangles.size(), count, moved, result->blockCount(), sampled,
              seconds * 1e3);
  return seconds;
}

TEST(BakeTiming, OneDabOnAThousandAndOnAMillionFaces) {
  if (kSanitized) GTEST_SKIP() << "times mean nothing under a sanitizer";
  const double few = dabSeconds("1k", icosphere(0.05, 7));
  const double many = dabSeconds("1M", icosphere(0.05, 224));
  if (test::machineIsCrowded()) GTEST_SKIP() << "the machine is busy";
  EXPECT_LE(many, 2 * few + 1e-3); // the field is as large
  expectWithin(std::max(few, many), 4e-3);
}

} // namespace
} // namespace patina
