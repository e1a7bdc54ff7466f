#include "haptics/servo/tick_record.h"

#include <gtest/gtest.h>

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

TEST(TickRecord, ContainsAllResultsOfATickInContact) {
  for (const bool attracted : {false, true}) {
    Contact contact = someContact();
    (attracted ? contact.attracted : contact.touching) = true;
    ToolSample sample;
    record(contact, sample);
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
    EXPECT_EQ(sample.constraint_count, attracted ? 0 : 2) << "walls that bear the load";
  }
}

TEST(TickRecord, PointsEqualTheTipOutOfContact) {
  ToolSample sample;
  record(someContact(), sample);
  EXPECT_EQ(sample.tip, Vec3(1, 2, 3));
  EXPECT_EQ(sample.force, Vec3(4, 5, 6)); // a fault fades there
  EXPECT_EQ(sample.vcp, sample.tip);
  EXPECT_EQ(sample.surface, sample.tip);
  EXPECT_EQ(sample.normal, Vec3::Zero());
  EXPECT_EQ(sample.depth, 0);
  EXPECT_FALSE(sample.contact || sample.attracted);
  EXPECT_TRUE(sample.fault);
}

} // namespace
} // namespace patina
