// Relief baked into the field while the user paints (K20, K21): the whole image within a picture's
// time, one dab within a few milliseconds on any mesh. One thread is measured; sharing the whole
// image among threads is tested separately. The measured ratio stands beside each limit.
#include <gtest/gtest.h>

#include <cstdio>
#include <ctime>

#include <tbb/task_arena.h>

#include "authoring/relief_shapes.h"
#include "geometry/atlas/texel_map.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh/mesh_unit.h"
#include "support/least_time.h"
#include "support/one_thread.h"
#include "support/shared_data.h"

namespace patina {
namespace {

constexpr int kImage = 512;

struct Painted {
  TriangleMesh mesh;
  std::shared_ptr<const SurfaceField> field;
  std::vector<ReliefInput> sources;
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

// Share of the work done by the calling thread itself.
double shareOfCaller(const std::function<void()>& work) {
  double least = 1;
  for (int i = 0; i < 12; ++i) {
    const double all = test::secondsOn(CLOCK_PROCESS_CPUTIME_ID), own = test::threadSeconds();
    work();
    least = std::min(least, (test::threadSeconds() - own) /
                                (test::secondsOn(CLOCK_PROCESS_CPUTIME_ID) - all));
  }
  return least;
}

void wholeImage(const char* name, TriangleMesh mesh) {
  const Painted shape = painted(std::move(mesh), waves());
  Progress progress;
  const ReliefBake bake(shape.field, shape.mesh, shape.sources, progress);
  std::shared_ptr<const SurfaceField> result; // the last field stays alive, like that of the servo
  const test::Work work = [&] { result = bake.baked(shape.sources); };
  test::Reference reference;
  std::vector<double> seconds;
  {
    const test::OneThread alone;
    seconds = test::minSeconds({work, [&] { reference.bake(); }});
  }
  const double share = shareOfCaller(work);
  std::printf("%s: %zu blocks, %zu faces; %.1f MB beside %.1f MB of field; the caller does %.0f %% "
              "of the work\n",
              name, shape.field->blockCount(), shape.mesh.triangles.size(),
              static_cast<double>(bake.bytes()) * 1e-6, static_cast<double>(result->bytes()) * 1e-6,
              100 * share);
  // 9 alone, up to 13 beside compilers, which drive the field out of the caches.
  EXPECT_TRUE(test::within("whole image baked", seconds[0], seconds[1], 18));
  if (tbb::this_task_arena::max_concurrency() > 1) { // processors that this process may use
    EXPECT_LT(share, 0.8);
  }
}

PATINA_TIMED_TEST(BakeTiming, WholeImageOnASphere) {
  wholeImage("sphere", icosphere(0.05, 22));
}

PATINA_TIMED_TEST(BakeTiming, WholeImageOnAScannedHead) {
  const auto path = test::sharedData("meshes/goathead.obj");
  PATINA_SKIP_WITHOUT(path);
  wholeImage("goathead", inMetres(readMesh(path), MeshUnit::fit).mesh);
}

// A dab of 5 % of the object on a whole painted image: every texel whose face has a corner there.
struct DabTime {
  double dab, reference; // [s]
};
DabTime dabTime(const char* name, TriangleMesh mesh) {
  const test::OneThread alone;
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
  std::vector<ReliefInput> after = shape.sources;
  after[0].image = dabbed;
  const auto before = bake.baked(shape.sources);
  std::shared_ptr<const SurfaceField> result;
  test::Reference reference;
  const std::vector<double> seconds =
      test::minSeconds({[&] { result = bake.updateBaked(*before, shape.sources, after); },
                        [&] { reference.bake(); }});
  std::size_t moved = 0, sampled = 0;
  for (std::size_t slot = 0; slot < result->blockCount(); ++slot) {
    moved += result->distance[slot] != before->distance[slot];
    sampled += result->sample[slot] != before->sample[slot];
  }
  std::printf("%s: %zu faces, dab of %zu texels: %zu of %zu blocks moved, %zu sampled\n", name,
              shape.mesh.triangles.size(), count, moved, result->blockCount(), sampled);
  return {seconds[0], seconds[1]};
}

PATINA_TIMED_TEST(BakeTiming, OneDabOnAThousandAndOnAMillionFaces) {
  const DabTime few = dabTime("1k", icosphere(0.05, 7));
  const DabTime many = dabTime("1M", icosphere(0.05, 224));
  EXPECT_TRUE(test::within("dab on 1k faces", few.dab, few.reference, 0.9));   // 0.32
  EXPECT_TRUE(test::within("dab on 1M faces", many.dab, many.reference, 0.9)); // 0.22
  EXPECT_TRUE(test::within("  1M against 1k", many.dab, few.dab, 2)); // the field is as large
}

} // namespace
} // namespace patina
