// Visible contact point if the tip touches an offset surface (K12).
#include <gtest/gtest.h>

#include "visualization/layers/tool_layer.h"

namespace patina {
namespace {

// A plane z = 0, touched at z = reach by a tip `depth` below that.
ToolSample pressed(double reach, double depth) {
  ToolSample sample;
  sample.contact = true;
  sample.normal = Vec3::UnitZ();
  sample.tip = Vec3(0.01, 0.02, reach - depth);
  sample.vcp = Vec3(0.01, 0.02, reach);
  sample.surface = Vec3(0.01, 0.02, 0);
  sample.depth = depth;
  return sample;
}

TEST(SeenContact, IsOnTheOriginalSurfaceForEveryOffset) {
  for (const double reach : {0.0, 0.5e-3, 3e-3})
    for (const double depth : {0.1e-3, 1e-3, 5e-3}) {
      const ToolSample sample = pressed(reach, depth);
      EXPECT_LT((seenContact(sample) - sample.surface).norm(), 1e-15);
    }
}

TEST(SeenContact, LagsByFrictionLikeTheContactPoint) {
  ToolSample sample = pressed(2e-3, 1e-3);
  const Vec3 back(-0.4e-3, 0.3e-3, 0); // shift of the contact point along the surface
  sample.vcp += back;
  EXPECT_LT((seenContact(sample) - (sample.surface + back)).norm(), 1e-15);
}

TEST(SeenContact, IsTheNearestPointWhereAMagnetPulls) {
  ToolSample sample = pressed(0, 0);
  sample.contact = false;
  sample.attracted = true;
  sample.tip = sample.vcp = Vec3(0, 0, 1e-3);
  EXPECT_EQ(seenContact(sample), sample.surface);
}

} // namespace
} // namespace patina
