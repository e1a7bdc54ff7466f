#include "visualization/layers/stability_layer.h"

#include <cmath>

#include <gtest/gtest.h>

#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>

#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

Vec3 colorOf(double ratio) {
  const auto table = stabilityColors();
  double color[3];
  table->GetColor(ratio, color);
  return {color[0], color[1], color[2]};
}

TEST(StabilityColors, ArePaleAtOneWarmBelowAndCoolAbove) {
  const Vec3 one = colorOf(1);
  EXPECT_LT(one.maxCoeff() - one.minCoeff(), 0.08);
  EXPECT_GT(one.minCoeff(), 0.8);
  EXPECT_GT(colorOf(0.5)[0], colorOf(0.5)[2] + 0.2);
  EXPECT_GT(colorOf(2)[2], colorOf(2)[0] + 0.2);
}

TEST(StabilityColors, AreEquallyFarFromOneAtHalfAndTwice) {
  const auto table = stabilityColors();
  const int one = static_cast<int>(table->GetIndex(1));
  EXPECT_EQ(one, 127);
  EXPECT_NEAR(static_cast<double>(one - table->GetIndex(0.5)),
              static_cast<double>(table->GetIndex(2) - one), 1.0);
}

TEST(StabilityColors, UnknownIsGreyAndDarkerThanAnyRatio) {
  const Vec3 unknown = colorOf(std::nan(""));
  EXPECT_LT(unknown.maxCoeff() - unknown.minCoeff(), 0.1);
  for (double ratio = 0.25; ratio <= 4; ratio *= 1.1)
    EXPECT_GT(colorOf(ratio).maxCoeff(), unknown.maxCoeff() + 0.1);
}

TEST(StabilityLayer, KeepsOneValueAVertexWithinTheShownRange) {
  const vtkNew<vtkRenderer> scene, overlay;
  StabilityLayer layer(*scene, *overlay);
  const TriangleMesh mesh = icosphere(0.03, 2);
  std::vector<float> ratio(mesh.positions.size(), 0.5F);
  ratio[1] = INFINITY;
  ratio[2] = 0;
  ratio[3] = NAN;
  EXPECT_FALSE(layer.hasTags());
  ratio[4] = kUnstable;
  ratio[5] = kNotTouchable;
  layer.update(mesh, ratio);
  auto* data = vtkPolyDataMapper::SafeDownCast(layer.surface().GetMapper())->GetInput();
  auto* values = data->GetPointData()->GetScalars();
  ASSERT_EQ(values->GetNumberOfTuples(), static_cast<vtkIdType>(ratio.size()));
  EXPECT_STREQ(values->GetName(), "stability [K*/K]");
  EXPECT_EQ(values->GetTuple1(0), 0.5);
  EXPECT_EQ(values->GetTuple1(1), kMaxRatioShown);
  EXPECT_EQ(values->GetTuple1(2), kMinRatioShown);
  EXPECT_TRUE(std::isnan(values->GetTuple1(3)));
  EXPECT_LT(values->GetTuple1(4), kMinRatioShown) << "a colour of its own";
  EXPECT_GT(values->GetTuple1(5), kMaxRatioShown) << "and another";
  EXPECT_TRUE(layer.hasTags());
  EXPECT_TRUE(layer.bar().GetDrawBelowRangeSwatch() && layer.bar().GetDrawAboveRangeSwatch());
  auto* normals = data->GetPointData()->GetNormals();
  const Vec3 outward(normals->GetTuple3(5));
  EXPECT_GT(outward.dot(mesh.positions[5].normalized()), 0.99);
  EXPECT_THROW(layer.update(mesh, {1, 2}), std::invalid_argument);
}

} // namespace
} // namespace patina
