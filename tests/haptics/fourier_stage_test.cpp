// Rendered Fourier textures (A22 to A25), against closed forms on a plane.
#include <array>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "geometry/tree/triangle_tree.h"
#include "haptics/law/painted_range.h"
#include "haptics/painted_fixture.h"
#include "support/constants.h"

namespace patina {
namespace {

using test::kPi;

FourierTexture waves(double length, const std::vector<double>& cosines,
                     std::optional<double> compliance = {}) {
  FourierTexture texture;
  texture.omega = 2 * kPi / length;
  texture.series.a = cosines;
  texture.series.b.assign(cosines.size(), 0);
  texture.low = minHeight(texture);
  texture.compliance = compliance;
  return texture;
}

// A slab whose top has this texture, except for the faces at its rim; x goes with the plane's x.
struct TexturedSlab {
  Slab slab_;
  TextureMappings laid;
  std::shared_ptr<const TexturePatches> patches;
  HapticObject object;

  TexturedSlab(const FourierTexture& texture, double inside, double voxel = 0.5e-3)
      : slab_(slab(voxel, 40, 14)) {
    const TriangleMesh& mesh = *slab_.mesh;
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      TexturedFace face;
      face.face = static_cast<std::int32_t>(f);
      face.texture = 5;
      bool top = true;
      for (int k = 0; k < 3; ++k) {
        const Vec3 p = mesh.corner(f, k);
        top = top && std::abs(p.z()) < 1e-9 && p.head<2>().cwiseAbs().maxCoeff() < inside;
        face.coords[static_cast<std::size_t>(k)] = p.head<2>();
      }
      if (top) laid.faces.push_back(face);
    }
    laid.library[5] = hapticTexture(texture);
    patches = std::make_shared<const TexturePatches>(mesh, laid);
    auto surface = std::make_shared<ReliefSurface>();
    surface->faces = reliefFaces(mesh, {});
    surface->textures = patches;
    object.relief = surface;
    object.highest = patches->highest();
    object.max_curvature = patches->maxCurvature();
  }
  HapticObject layered() const {
    HapticObject made = object;
    std::swap(made.relief, made.layer);
    return made;
  }
  std::shared_ptr<const HapticSnapshot> compiled(const Scene& scene) const {
    const HapticObject felt = scene.haptics.texture_gain ? layered() : object;
    return compileStages(scene, slab_.field, std::span(&felt, 1));
  }
};

Scene layerScene(double stiffness, double gain, ForceForm form = ForceForm::literal) {
  Scene scene = sceneOf(stiffness);
  scene.haptics.texture_gain = gain;
  scene.relief.form = form;
  return scene;
}

// T-A22a: a profile of 0.5 mm, pressed at its highest, flat point.
TEST(TextureLayer, IsPressedBesideTheSurface) {
  const TexturedSlab plate(waves(8e-3, {0.25e-3}), 0.015);
  for (const ForceForm form : {ForceForm::literal, ForceForm::conservative}) {
    const auto snapshot = plate.compiled(layerScene(500, 0.4, form));
    EXPECT_NEAR(touchOnce(*snapshot, Vec3(0, 0, 0.2e-3)).force.z(), 0.06, 2e-6);
    EXPECT_NEAR(touchOnce(*snapshot, Vec3(0, 0, -1e-3)).force.z(), 0.8, 2e-6);
    EXPECT_FALSE(touchOnce(*snapshot, Vec3(0, 0, 0.51e-3)).touching);
    // In the valley, which lies on the plane, only the plane acts.
    EXPECT_FALSE(touchOnce(*snapshot, Vec3(4e-3, 0, 0.01e-3)).touching);
    EXPECT_NEAR(touchOnce(*snapshot, Vec3(4e-3, 0, -1e-3)).force.z(), 0.7, 2e-6);
  }
}

// T-A22b
TEST(TextureLayer, ForceIsContinuousAndItsSlopeStepsAtTheSurface) {
  const TexturedSlab plate(waves(8e-3, {0.25e-3}), 0.015);
  const auto snapshot = plate.compiled(layerScene(500, 0.4));
  const double h = 0.5e-3, d = 1e-5;
  const auto forceAt = [&](double z) { return touchOnce(*snapshot, Vec3(0, 0, z)).force.z(); };
  EXPECT_NEAR(forceAt(h - 1e-8), 0, 1e-5);
  EXPECT_NEAR(forceAt(1e-8), forceAt(-1e-8), 2e-5);
  EXPECT_NEAR((forceAt(h / 2 - d) - forceAt(h / 2 + d)) / (2 * d), 0.4 * 500, 1);
  EXPECT_NEAR((forceAt(-h - d) - forceAt(-h + d)) / (2 * d), 1.4 * 500, 2);
}

// T-A22c: friction follows the sum of both forces.
TEST(TextureLayer, FrictionFollowsTheSumOfBothForces) {
  const TexturedSlab plate(waves(8e-3, {0.25e-3}), 0.015);
  const double mu = 0.3;
  Scene scene = withFriction(layerScene(500, 0.4), mu, mu);
  const auto snapshot = plate.compiled(scene);
  ContactMemory memory;
  Vec3 tip(-2e-3, 0, 0.3e-3);
  tick(*snapshot, memory, tip, 1e-3);
  Contact contact;
  tip.z() = -0.3e-3;
  for (int i = 0; i < 2000; ++i) contact = tick(*snapshot, memory, tip += Vec3(1e-6, 0, 0), 1e-3);
  const double h = 0.25e-3 * (1 + std::cos(2 * kPi * tip.x() / 8e-3));
  const double normal = 500 * 0.3e-3 + 0.4 * 500 * (0.3e-3 + h);
  const Vec3 pressed = 500 * (contact.frictionless_point - contact.tip),
             drag = contact.force - pressed;
  EXPECT_NEAR(pressed.norm(), normal, 1e-4 * normal);
  EXPECT_NEAR(drag.norm(), mu * pressed.norm(), 1e-12);
  EXPECT_LT((drag.normalized() + Vec3::UnitX()).norm(), 0.02); // the stuck point rode up the wave
  const Contact still = tick(*snapshot, memory, tip, 1e-3);    // v = 0
  EXPECT_TRUE(still.force.allFinite());
}

// T-A22e, F6: the tip goes in at a valley, out at a peak.
double workOfLoop(const HapticSnapshot& snapshot, double along, double depth) {
  return loopWork(snapshot, {Vec3(0, 0, -depth), Vec3(along, 0, -depth), Vec3(along, 0, 1.2e-3),
                             Vec3(0, 0, 1.2e-3)});
}

TEST(TextureLayer, OnlyTheConservativeFormDoesNoWorkRoundALoop) {
  const TexturedSlab plate(waves(8e-3, {0.25e-3}), 0.015);
  const double K = 500, gain = 0.4, dz = 1e-3;
  // The tip goes in at the peak (x = 0) and out at the valley. Below the plane: k_t K (h1 - h2) dz,
  // and above it the potential U = k_t K h^2 / 2.
  const double h = 0.5e-3, due = gain * K * (h * dz + 0.5 * h * h);
  EXPECT_NEAR(workOfLoop(*plate.compiled(layerScene(K, gain)), 4e-3, dz), -due, 0.01 * due);
  EXPECT_NEAR(workOfLoop(*plate.compiled(layerScene(K, gain, ForceForm::conservative)), 4e-3, dz),
              0, 0.01 * due);
}

// A relief texture deforms the surface: at depth d below it the force is K d along its normal, and
// a loop does no work.
TEST(TextureRelief, ChangesTheShapeOfTheSurface) {
  const TexturedSlab plate(waves(8e-3, {0.2e-3, 0, 0.02e-3}), 0.015);
  const auto snapshot = plate.compiled(sceneOf(500));
  for (double x = -6e-3; x < 6e-3; x += 0.29e-3) {
    const double w = 2 * kPi / 8e-3;
    const double h = 0.2e-3 * std::cos(w * x) + 0.02e-3 * std::cos(3 * w * x),
                 slope = -w * (0.2e-3 * std::sin(w * x) + 0.06e-3 * std::sin(3 * w * x));
    const double d = 0.4e-3;
    const Contact contact = touchOnce(*snapshot, Vec3(x, 1e-3, h - d));
    EXPECT_NEAR(contact.force.z(), 500 * d, 1e-4);
    EXPECT_NEAR(contact.force.x(), -500 * d * slope, 1e-4);
    EXPECT_FALSE(touchOnce(*snapshot, Vec3(x, 1e-3, h + 1e-5)).touching);
  }
  EXPECT_NEAR(workOfLoop(*snapshot, 4e-3, 1e-3), 0, 1e-6);
}

TEST(TextureRelief, HasTheStiffnessOfItsCompliance) {
  const TexturedSlab plate(waves(8e-3, {0.1e-3}, 1. / 1500), 0.012);
  const auto snapshot = plate.compiled(sceneOf(400));
  const double d = 0.3e-3;
  EXPECT_NEAR(touchOnce(*snapshot, Vec3(0, 0, 0.1e-3 - d)).force.z(), 1500 * d, 1e-3);
  EXPECT_NEAR(touchOnce(*snapshot, Vec3(0.017, 0.001, -d)).force.z(), 400 * d, 1e-3);
  // Stability depends on the largest stiffness.
  EXPECT_DOUBLE_EQ(
      paintedRange(baseMaterial(sceneOf(400).haptics), std::span(&plate.object, 1)).max.stiffness,
      1500);
  EXPECT_NEAR(workOfLoop(*snapshot, 0.0161, 0.5e-3), 0, 2e-6); // across the fade
}

// On faces where the texture fades, height and slope are continuous, and the slope is the height's
// derivative.
TEST(TexturePatches, FadeSmoothlyAndKeepTheHeightsGradient) {
  const TexturedSlab plate(waves(8e-3, {0.2e-3, 0.05e-3}), 0.0121);
  const TriangleTree tree(*plate.slab_.mesh);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-0.015, 0.015);
  double faded = 0, whole = 0, none = 0;
  const auto seen = [&](const Vec3& q) {
    return reliefAt(*plate.object.relief, q, tree.closestPoint(q).surface.face);
  };
  for (int i = 0; i < 4000; ++i) {
    const Vec3 p(any(random), any(random), 0);
    const ReliefAt here = seen(p);
    const double d = 1e-7;
    Vec3 slope = Vec3::Zero();
    for (int k = 0; k < 2; ++k)
      slope[k] =
          (seen(p + d * Vec3::Unit(k)).height - seen(p - d * Vec3::Unit(k)).height) / (2 * d);
    ASSERT_LT((slope - here.slope()).norm(), 2e-5) << p.transpose();
    (here.texture.weight == 1 ? whole : here.texture.weight > 0 ? faded : none) += 1;
  }
  EXPECT_GT(whole, 1000);
  EXPECT_GT(faded, 200);
  EXPECT_GT(none, 500);
  EXPECT_NEAR(seen(Vec3(1e-5, 2e-5, 0)).height, height(plate.laid.library.at(5)->value, 1e-5),
              1e-12);
}

// T-A17: a texture is the same on two meshes along equal paths, to the last digits; forces agree to
// the field's error.
// field's error.
TEST(TexturePatches, AreTheSameOnAnyMesh) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal(0, 1);
  FourierTexture texture = waves(20e-3, std::vector<double>(128, 0));
  for (std::size_t j = 0; j < 128; ++j) {
    texture.series.a[j] = 2e-5 * normal(random) / static_cast<double>(j + 1);
    texture.series.b[j] = 2e-5 * normal(random) / static_cast<double>(j + 1);
  }
  texture.low = minHeight(texture);
  const TexturedSlab coarse(texture, 0.0191);
  TriangleMesh fine = box(Vec3(0.04, 0.04, 0.012), 97);
  for (Vec3& p : fine.positions) p.z() -= 0.006;
  TextureMappings laid;
  for (std::size_t f = 0; f < fine.triangles.size(); ++f) {
    TexturedFace face;
    face.face = static_cast<std::int32_t>(f);
    face.texture = 1;
    bool top = true;
    for (int k = 0; k < 3; ++k) {
      top = top && std::abs(fine.corner(f, k).z()) < 1e-9;
      face.coords[static_cast<std::size_t>(k)] = fine.corner(f, k).head<2>();
    }
    if (top) laid.faces.push_back(face);
  }
  laid.library[1] = hapticTexture(texture);
  const TexturePatches other(fine, laid);
  const TriangleTree coarse_tree(*coarse.slab_.mesh), fine_tree(fine);
  const double rms = rmsHeight(texture);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(-0.017 + 1.7e-5 * i, 3e-3 * std::sin(0.01 * i), 0);
    const PatchAt a = coarse.patches->at(coarse_tree.closestPoint(p).surface.face, p),
                  b = other.at(fine_tree.closestPoint(p).surface.face, p);
    ASSERT_NEAR(a.height, b.height, 1e-12 + 1e-9 * rms);
    ASSERT_NEAR(a.height, height(texture, p.x()), 1e-11);
  }
}

// T-A25: faces without a texture, or with an unknown one, change no bit.
TEST(TexturePatches, SkipUnknownTextures) {
  TexturedSlab plate(waves(8e-3, {0.2e-3}), 0.015);
  TextureMappings unknown = plate.laid;
  unknown.library.clear();
  const TexturePatches none(*plate.slab_.mesh, unknown);
  EXPECT_EQ(none.highest(), 0);
  EXPECT_EQ(none.maxCurvature(), 0);
  for (std::int32_t f = 0; f < 100; ++f) EXPECT_EQ(none.at(f, Vec3::Zero()).texture.weight, 0);
}

// A seam between inconsistent coordinates is no step: the texture fades out there.
TEST(TexturePatches, FadeAtASeam) {
  TexturedSlab plate(waves(8e-3, {0.2e-3}), 0.015);
  TextureMappings laid = plate.laid;
  for (TexturedFace& face : laid.faces) {
    double middle = 0;
    for (int k = 0; k < 3; ++k)
      middle += plate.slab_.mesh->corner(static_cast<std::size_t>(face.face), k).x();
    if (middle < 0)
      for (Vec2& at : face.coords) at.x() += 3e-3; // not a whole period
  }
  const TexturePatches patches(*plate.slab_.mesh, laid);
  const TriangleTree tree(*plate.slab_.mesh);
  double most = 0;
  for (double y = -8e-3; y < 8e-3; y += 0.13e-3) {
    const Vec3 left(-1e-7, y, 0), right(1e-7, y, 0);
    const double a = patches.at(tree.closestPoint(left).surface.face, left).height,
                 b = patches.at(tree.closestPoint(right).surface.face, right).height;
    most = std::max(most, std::abs(a - b));
  }
  EXPECT_LT(most, 1e-9);
}

// The lateral coupling calms a texture that is too stiff along the surface for the loop (F7), for
// images and harmonics: its curvature is computed.
TEST(TexturePatches, ComputeTheirMaxCurvature) {
  const double length = 1e-3, amplitude = 0.1e-3;
  const TexturedSlab plate(waves(length, {amplitude}), 0.015);
  const double due = amplitude * std::pow(2 * kPi / length, 2);
  EXPECT_GT(plate.patches->maxCurvature(), due);
  EXPECT_LT(plate.patches->maxCurvature(), 2.5 * due); // includes the fading faces
  Eigen::Matrix3d bend;
  const TriangleTree tree(*plate.slab_.mesh);
  const Vec3 p(0.13e-3, 0.2e-3, 0);
  plate.patches->at(tree.closestPoint(p).surface.face, p, &bend);
  EXPECT_NEAR(bend(0, 0), -due * std::cos(2 * kPi * p.x() / length), 1e-3 * due);
  EXPECT_NEAR(bend(1, 1), 0, 1e-6 * due);
}

// T-A22d: pressed together, layer and surface are as hard for the loop as K (1 + k_t). The default
// device needs a coupling above half of its K* = 1000.8 N/m.
TEST(TextureLayer, CouplingIncludesLayerAndSurface) {
  const TexturedSlab plate(waves(8e-3, {0.2e-3}), 0.015);
  const HapticObject layered = plate.layered();
  Scene scene;
  scene.haptics.stiffness = 400;
  scene.device_model = DeviceModel{};
  scene.relief.form = ForceForm::literal;
  for (const auto& [gain, needed] : {std::pair{0.24, false}, {0.26, true}}) {
    scene.haptics.texture_gain = gain;
    EXPECT_EQ(planOf(scene, std::span(&layered, 1)).coupling.has_value(), needed) << gain;
    EXPECT_FALSE(planOf(scene).coupling) << "where no layer lies";
  }
}

// The bound holds for coordinates that are stretched and sheared.
TEST(TexturePatches, BoundTheCurvatureOfStretchedCoordinates) {
  for (const auto& [xx, xy, yx, yy] : {std::array{1., 0., 0., 1.},
                                       {1.5, 0.9, 0.9, 1.5},
                                       {0.4, 1.2, -0.3, 0.5},
                                       {1., 0.99, 0.99, 1.}}) {
    FourierTexture texture = waves(4e-3, {0.1e-3});
    texture.kind = TextureKind::products;
    texture.products.push_back({{0, {1}, {0}}, texture.series});
    texture.series = {};
    texture.low = minHeight(texture);
    TexturedSlab plate(texture, 0.015);
    TextureMappings laid = plate.laid;
    for (TexturedFace& face : laid.faces)
      for (Vec2& at : face.coords) at = Vec2(xx * at.x() + xy * at.y(), yx * at.x() + yy * at.y());
    const TexturePatches patches(*plate.slab_.mesh, laid);
    const TriangleTree tree(*plate.slab_.mesh);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-0.008, 0.008);
    double most = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3 p(any(random), any(random), 0);
      Eigen::Matrix3d bend;
      patches.at(tree.closestPoint(p).surface.face, p, &bend);
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(0.5 * (bend + bend.transpose()));
      most = std::max(most, eigen.eigenvalues().cwiseAbs().maxCoeff());
    }
    EXPECT_GT(patches.maxCurvature(), most) << xx << " " << xy;
    EXPECT_LT(patches.maxCurvature(), 12 * most) << "fades included";
  }
}

// A sliver at the rim does not stiffen the whole scene's lateral coupling more than other faces.
TEST(TexturePatches, SliverAtTheEdgeIsNoSharperThanAFaceHalfAsWide) {
  const TexturedSlab plate(waves(8e-3, {0.2e-3}), 0.015);
  TriangleMesh mesh = *plate.slab_.mesh;
  TextureMappings laid = plate.laid;
  // One face at the rim is split along an edge into a sliver and the rest.
  const double usual = TexturePatches(mesh, laid).maxCurvature();
  const TexturedFace first = laid.faces.front();
  const auto f = static_cast<std::size_t>(first.face);
  const Triangle corners = mesh.triangles[f];
  const Vec3 cut = mesh.corner(f, 0) + 1e-3 * (mesh.corner(f, 2) - mesh.corner(f, 0));
  const Vec2 cut_at = first.coords[0] + 1e-3 * (first.coords[2] - first.coords[0]);
  const auto added = static_cast<std::int32_t>(mesh.positions.size());
  mesh.positions.push_back(cut);
  mesh.triangles[f] = {added, corners[1], corners[2]};
  mesh.triangles.push_back({corners[0], corners[1], added});
  laid.faces.front().coords[0] = cut_at;
  laid.faces.push_back({static_cast<std::int32_t>(mesh.triangles.size()) - 1,
                        first.texture,
                        {first.coords[0], first.coords[1], cut_at}});
  EXPECT_LT(TexturePatches(mesh, laid).maxCurvature(), 5 * usual); // the fade's square, and room
}

// A mesh that is cut into pieces in memory is one surface to the probe.
TEST(TexturePatches, MergeVerticesAtOnePosition) {
  const TexturedSlab plate(waves(8e-3, {0.2e-3}), 0.015);
  TriangleMesh loose = *plate.slab_.mesh;
  std::vector<Vec3> positions;
  for (Triangle& triangle : loose.triangles)
    for (std::int32_t& vertex : triangle) {
      positions.push_back(plate.slab_.mesh->positions[static_cast<std::size_t>(vertex)]);
      vertex = static_cast<std::int32_t>(positions.size()) - 1;
    }
  loose.positions = positions;
  const TexturePatches whole(*plate.slab_.mesh, plate.laid), pieces(loose, plate.laid);
  const TriangleTree tree(*plate.slab_.mesh);
  double faded = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(-0.0149 + 1.5e-5 * i, 0.0149 * std::sin(0.02 * i), 0);
    const std::int32_t face = tree.closestPoint(p).surface.face;
    const PatchAt a = whole.at(face, p), b = pieces.at(face, p);
    ASSERT_EQ(a.height, b.height);
    ASSERT_EQ(a.texture.weight, b.texture.weight);
    faded += a.texture.weight > 0 && a.texture.weight < 1;
  }
  EXPECT_GT(faded, 20);
}

} // namespace
} // namespace patina
