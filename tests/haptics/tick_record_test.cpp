#include "haptics/servo/tick_record.h"

#include <gtest/gtest.h>

#include "field/build/build_field.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

Contact someContact() {
  Contact contact;
  contact.tip = {1, 2, 3};
  contact.force = {4, 5, 6};
  contact.vcp = {7, 8, 9};
  contact.surface = {0.03, 0, 0};
  contact.normal = Vec3::UnitX();
  contact.depth = 10;
  contact.walls = 2;
  contact.deep = true;
  contact.fault = true;
  return contact;
}

TEST(TickRecord, SaysOfAContactAllThatTheTickFound) {
  for (const bool attracted : {false, true}) {
    Contact contact = someContact();
    (attracted ? contact.attracted : contact.touching) = true;
    ToolSample sample;
    record(contact, nullptr, sample);
    EXPECT_EQ(sample.tip, contact.tip);
    EXPECT_EQ(sample.force, contact.force);
    EXPECT_EQ(sample.vcp, contact.vcp);
    EXPECT_EQ(sample.surface, contact.surface);
    EXPECT_EQ(sample.normal, contact.normal);
    EXPECT_EQ(sample.depth, contact.depth);
    EXPECT_EQ(sample.contact, !attracted);
    EXPECT_EQ(sample.attracted, attracted);
    EXPECT_TRUE(sample.deep);
    EXPECT_TRUE(sample.fault);
    EXPECT_EQ(sample.face, -1);
    EXPECT_EQ(sample.held, attracted ? 0 : 2) << "walls that bear the load";
  }
}

TEST(TickRecord, OutOfContactThePointsAreTheTip) {
  ToolSample sample;
  record(someContact(), nullptr, sample);
  EXPECT_EQ(sample.tip, Vec3(1, 2, 3));
  EXPECT_EQ(sample.force, Vec3(4, 5, 6)); // a fault fades there
  EXPECT_EQ(sample.vcp, sample.tip);
  EXPECT_EQ(sample.surface, sample.tip);
  EXPECT_EQ(sample.normal, Vec3::Zero());
  EXPECT_EQ(sample.depth, 0);
  EXPECT_FALSE(sample.contact || sample.attracted);
  EXPECT_TRUE(sample.fault);
}

TEST(TickRecord, NamesTheFaceAtTheSurface) {
  Progress progress;
  const TriangleMesh mesh = icosphere(0.03, 1);
  const auto built =
      buildField(mesh, FieldSpec{.resolution = 60, .voxel = std::nullopt, .band = 6}, progress);
  const auto field = withSamples(built.field);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    Contact contact = someContact();
    contact.touching = true;
    contact.surface = (mesh.corner(f, 0) + mesh.corner(f, 1) + mesh.corner(f, 2)) / 3;
    ToolSample sample;
    record(contact, field.get(), sample);
    EXPECT_EQ(sample.face, static_cast<std::int32_t>(f));
  }
}

} // namespace
} // namespace patina
