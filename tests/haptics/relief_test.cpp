// Rendering of pulled relief: T-K21a, T-K21f, F6, F8.
#include <cstdio>

#include <gtest/gtest.h>

#include "haptics/neutral_stages.h"
#include "haptics/painted_fixture.h"
#include "haptics/servo/cross_fade.h"
#include "support/constants.h"

namespace patina {
namespace {

using test::kPi;

constexpr double kSide = Slab::kSide;

std::shared_ptr<const HapticSnapshot> compiledRelief(const Scene& scene, const HapticObject& object,
                                                     const Field& field) {
  return compileStages(scene, field, std::span(&object, 1));
}

// T-K21a: a constant gray of 1, s = 1 mm, on a sphere; also engraved, and with both forms.
TEST(PulledRelief, ConstantImageMovesTheSphereByItsHeight) {
  const double R = 0.03, K = 500;
  const TriangleMesh mesh = icosphere(R, 50);
  FieldSpec spec;
  spec.resolution = 80;
  Progress progress;
  const Field sphere = withSamples(buildField(mesh, spec, progress).field);
  const auto faces = reliefFaces(mesh, CornerUvs(mesh.triangles.size()));
  const auto white = reliefImage(64, [](double, double) { return 1; });
  const double h = sphere->grid.voxel;
  for (const double s : {1e-3, -1e-3})
    for (const ForceForm form : {ForceForm::conservative, ForceForm::literal}) {
      Scene scene = sceneOf(K);
      scene.relief.form = form;
      const auto snapshot = compiledRelief(scene, hapticRelief(faces, white, s), sphere);
      std::mt19937 random(1);
      for (int i = 0; i < 300; ++i) {
        const Vec3 n = randomDirection(random);
        const double d = 1.2e-3;
        const Contact contact = touchOnce(*snapshot, (R + s - d) * n);
        ASSERT_TRUE(contact.touching);
        // The facets of the mesh lie up to 4 um inside the sphere.
        ASSERT_NEAR(contact.force.norm() / K, d, h * h / (4 * R) + 5e-6);
        ASSERT_LT((contact.force.normalized() - n).norm(), 5e-3);
        const Contact off = touchOnce(*snapshot, (R + s + 1e-5) * n);
        ASSERT_FALSE(off.touching);
        ASSERT_TRUE(off.force.isZero(0));
        ASSERT_EQ(off.walls, 0);
      }
    }
}

// A zero image gives the same bits as no image, if the shell is the surface itself.
TEST(PulledRelief, ChangesNoBitIfItHasNoHeight) {
  const Slab& plane = fineSlab();
  const Scene scene = withFriction(sceneOf(500), 0.5, 0.3);
  const HapticObject black =
      hapticRelief(plane.faces, std::make_shared<TiledImage>(64, 64, 1), 1e-3, 0);
  const auto without = compileStages(scene, plane.field);
  const auto with = compiledRelief(scene, black, plane.field);
  EXPECT_EQ(with->stages.size(), without->stages.size());
  const auto all = withNeutralStages(scene, plane.field, std::span(&black, 1));
  ContactMemory a, b;
  std::mt19937 random(2);
  Vec3 tip(0, 0, 1e-3);
  for (int i = 0; i < 5000; ++i) {
    tip += 1e-4 * randomDirection(random);
    if (tip.cwiseAbs().maxCoeff() > 2e-3) tip *= 0.5;
    const Contact one = tick(*without, a, tip, 1e-3), other = tick(*all, b, tip, 1e-3);
    ASSERT_EQ(one.force, other.force) << i;
    ASSERT_EQ(one.vcp, other.vcp) << i;
  }
}

// If other objects are raised and the image is 0, the forces agree to the ray's tolerance.
TEST(PulledRelief, ForceEqualsTheBareSurfacesWhereTheImageIsZero) {
  const Slab& plane = fineSlab();
  const Scene scene = sceneOf(500);
  const HapticObject part = hapticRelief(
      plane.faces, reliefImage(128, [](double u, double) { return u > 0.7 ? 1 : 0; }), 1e-3);
  const auto without = compileStages(scene, plane.field);
  const auto with = compiledRelief(scene, part, plane.field);
  for (double x = -8e-3; x < 6e-3; x += 0.37e-3)
    for (double z = 0.4e-3; z > -2e-3; z -= 0.11e-3) {
      const Vec3 tip(x, 1e-3, z);
      EXPECT_LT((touchOnce(*with, tip).force - touchOnce(*without, tip).force).norm(), 1e-6)
          << x << z;
    }
}

// T-K21f: on the flank of a ramp of slope a, tilt_normal rotates the force by atan(a); the papers'
// form does not.
TEST(PulledRelief, ForceEqualsTheTexturedSurfaces) {
  const Slab& plane = fineSlab();
  for (const double a : {0.1, 0.5}) {
    const double s = a * kSide;
    const HapticObject ramp = hapticRelief(
        plane.faces, reliefImage(64, [](double u, double) { return u - 0.5; }), s, 0.1);
    for (const ForceForm form : {ForceForm::conservative, ForceForm::literal}) {
      Scene scene = sceneOf(500);
      scene.relief.form = form;
      const auto snapshot = compiledRelief(scene, ramp, plane.field);
      const double x = 1.3e-3, d = 0.5e-3;
      const Contact contact = touchOnce(*snapshot, Vec3(x, 0.7e-3, a * x - d));
      const double lean = std::atan2(-contact.force.x(), contact.force.z());
      EXPECT_NEAR(lean, form == ForceForm::literal ? 0 : std::atan(a), 1e-5);
      EXPECT_NEAR(contact.force.z(), 500 * d, 1e-5);
      EXPECT_NEAR(contact.force.y(), 0, 1e-6);
      // The contact point bears the spring's force; the surface point is the unraised one.
      EXPECT_LT((500 * (contact.vcp - contact.tip) - contact.force).norm(), 1e-12);
      EXPECT_LT((contact.surface - Vec3(x, 0.7e-3, 0)).norm(), 1e-6);
    }
  }
}

// F8: 2.5 voxels, at least 22 texels a wavelength. The height is at the zero of the force.
double heightFelt(const HapticSnapshot& snapshot, double x, double y, double most, double K) {
  const Contact contact = touchOnce(snapshot, Vec3(x, y, -3 * most));
  return contact.force.z() / K - 3 * most;
}

TEST(PulledRelief, HasItsFullHeightAtAWavelengthOfTwoAndAHalfVoxels) {
  const Slab& plane = fineSlab();
  const double wavelength = 2.5 * plane.field->grid.voxel, A = 0.1e-3, K = 500;
  const int size = 736; // 23 texels a wavelength
  const double k = 2 * kPi / wavelength;
  const HapticObject object = hapticRelief(
      plane.faces,
      reliefImage(size, [&](double u, double) { return std::cos(k * kSide * (u - 0.5)); }), A);
  const auto snapshot = compiledRelief(sceneOf(K), object, plane.field);
  // Amplitude by projection onto the wave, and the extremes.
  const int count = 2000;
  double amplitude = 0, highest = -1, lowest = 1, slope = 0;
  for (int i = 0; i < count; ++i) {
    const double x = wavelength * (3.0 * i / count - 1.5);
    const double h = heightFelt(*snapshot, x, 0.3e-3, A, K);
    amplitude += 2.0 / count * h * std::cos(k * x);
    highest = std::max(highest, h);
    lowest = std::min(lowest, h);
    const Contact contact = touchOnce(*snapshot, Vec3(x, 0.3e-3, -3 * A));
    slope += 2.0 / count * contact.force.x() / contact.force.z() * std::sin(k * x);
  }
  std::printf("2.5 voxels: amplitude %.4f, peak to peak %.4f, slope %.4f of what was painted\n",
              amplitude / A, (highest - lowest) / (2 * A), slope / (A * k));
  EXPECT_NEAR(amplitude, A, 0.01 * A);
  EXPECT_NEAR(highest - lowest, 2 * A, 0.01 * 2 * A);
  EXPECT_NEAR(slope, A * k, 0.01 * A * k);
}

// F6: pressed in by dz at a valley, released at a peak: K (h1 - h2) dz from the form of the papers.
TEST(PulledRelief, OnlyTheLiteralFormDoesWorkRoundALoop) {
  const Slab& plane = fineSlab();
  const double A = 0.25e-3, wavelength = 2e-3, K = 500, dz = 1e-3, k = 2 * kPi / wavelength;
  const HapticObject object = hapticRelief(
      plane.faces,
      reliefImage(1024, [&](double u, double) { return std::cos(k * kSide * (u - 0.5)); }), A);
  const double valley = 0.5 * wavelength, peak = 0;
  const std::vector<Vec3> path{Vec3(valley, 1e-4, -1e-3 - dz), Vec3(peak, 1e-4, -1e-3 - dz),
                               Vec3(peak, 1e-4, -1e-3), Vec3(valley, 1e-4, -1e-3)};
  const double theory = K * 2 * A * dz;
  Scene scene = sceneOf(K);
  scene.relief.form = ForceForm::literal;
  const double literal = loopWork(*compiledRelief(scene, object, plane.field), path, 3000);
  scene.relief.form = ForceForm::conservative;
  const double conservative = loopWork(*compiledRelief(scene, object, plane.field), path, 3000);
  std::printf("literal %.5g J of %.5g J a loop, conservative %.2g of it\n", literal, theory,
              conservative / theory);
  EXPECT_NEAR(literal, theory, 0.002 * theory);
  EXPECT_LT(std::abs(conservative), 0.01 * theory);
}

// On a sphere the closest point moves by R / r of the tip's motion: J^T, K12.
TEST(PulledRelief, ConservativeFormDoesNoWorkOnASphere) {
  const double R = 0.012, K = 500, s = 1.2e-3;
  const TriangleMesh mesh = icosphere(R, 60);
  FieldSpec spec;
  spec.resolution = 90;
  spec.band = 14;
  Progress progress;
  const Field sphere = withSamples(buildField(mesh, spec, progress).field);
  CornerUvs uvs(mesh.triangles.size());
  for (std::size_t f = 0; f < uvs.size(); ++f)
    for (int c = 0; c < 3; ++c)
      uvs[f][static_cast<std::size_t>(c)] = Vec2(mesh.corner(f, c).x() / (2.2 * R) + 0.5, 0.5);
  const auto faces = reliefFaces(mesh, uvs);
  const HapticObject object =
      hapticRelief(faces, reliefImage(256, [](double u, double) { return std::sin(12 * u); }), s);
  const auto at = [&](double angle, double r) {
    return Vec3(r * std::sin(angle), 2e-4, r * std::cos(angle));
  };
  Scene scene = sceneOf(K);
  std::vector<Vec3> path;
  const double low = R - 3e-3, high = R - 1.5e-3;
  for (int i = -10; i <= 10; ++i) path.push_back(at(0.03 * i, low));
  for (int i = 10; i >= -10; --i) path.push_back(at(0.03 * i, high));
  const auto height = [&](double angle) {
    return s * std::sin(12 * (R * std::sin(angle) / (2.2 * R) + 0.5));
  };
  const double theory = std::abs(K * (height(0.3) - height(-0.3)) * (high - low));
  scene.relief.form = ForceForm::literal;
  const double literal = loopWork(*compiledRelief(scene, object, sphere), path, 150);
  scene.relief.form = ForceForm::conservative;
  const double conservative = loopWork(*compiledRelief(scene, object, sphere), path, 150);
  std::printf("sphere: literal %.4g J of %.4g J, conservative %.2g of it\n", literal, theory,
              conservative / theory);
  EXPECT_NEAR(std::abs(literal), theory, 0.02 * theory);
  EXPECT_LT(std::abs(conservative), 0.01 * theory);
}

// The force is continuous from texel to texel, unlike the slope of a bilinear surface.
TEST(PulledRelief, ForceDoesNotStepFromTexelToTexel) {
  const Slab& plane = fineSlab();
  const double A = 0.2e-3, wavelength = 2e-3, k = 2 * kPi / wavelength; // 6.4 texels
  const HapticObject object = hapticRelief(
      plane.faces,
      reliefImage(128, [&](double u, double) { return std::cos(k * kSide * (u - 0.5)); }), A);
  const auto snapshot = compiledRelief(sceneOf(500), object, plane.field);
  ContactMemory memory;
  const double d = 1e-3, step = 1e-6;
  Vec3 last = tick(*snapshot, memory, Vec3(-2e-3, 0, -d), 1e-3).force;
  double worst = 0;
  for (double x = -2e-3 + step; x < 2e-3; x += step) {
    const Vec3 force = tick(*snapshot, memory, Vec3(x, 0, -d), 1e-3).force;
    worst = std::max(worst, (force - last).norm() / step);
    last = force;
  }
  // at most the smooth surface's stiffness plus its P h''
  EXPECT_LT(worst, 1.5 * 500 * (1 + (A * k) * (A * k) + (d + A) * A * k * k));
}

// Friction over relief: the tip sticks and slides on it, and detaches where the relief falls away.
TEST(PulledRelief, FrictionFollowsTheForceAlongTheNormal) {
  const Slab& plane = fineSlab();
  const double mu = 0.4;
  const HapticObject flat =
      hapticRelief(plane.faces, reliefImage(64, [](double, double) { return 0.5; }), 1e-3);
  const auto snapshot = compiledRelief(withFriction(sceneOf(500), mu, mu), flat, plane.field);
  ContactMemory memory;
  const double d = 0.8e-3;
  glide(*snapshot, memory, Vec3(0, 0, 1.5e-3));
  glide(*snapshot, memory, Vec3(0, 0, 0.5e-3 - d));
  const Contact slid = glide(*snapshot, memory, Vec3(4e-3, 0, 0.5e-3 - d), 1e-5);
  EXPECT_NEAR(slid.force.z(), 500 * d, 1e-4);
  EXPECT_NEAR(slid.force.x(), -mu * 500 * d, 1e-4);
  const Contact off = glide(*snapshot, memory, Vec3(4e-3, 0, 0.51e-3));
  EXPECT_FALSE(off.touching);
  EXPECT_FALSE(memory.friction.stick);
  EXPECT_TRUE(off.force.isZero(0));
  EXPECT_EQ(off.vcp, off.tip);
}

TEST(PulledRelief, MagnetPullsTowardsTheRelief) {
  const Slab& plane = fineSlab();
  Scene scene = sceneOf(500);
  scene.haptics.magnet = Magnet{1e-3, 300, false};
  const HapticObject flat =
      hapticRelief(plane.faces, reliefImage(64, [](double, double) { return 0.5; }), 2e-3);
  const auto snapshot = compiledRelief(scene, flat, plane.field);
  for (const double above : {0.2e-3, 0.7e-3}) {
    const Contact contact = touchOnce(*snapshot, Vec3(1e-3, 0, 1e-3 + above));
    EXPECT_TRUE(contact.attracted);
    EXPECT_NEAR(contact.force.z(), -300 * above, 1e-5);
  }
  EXPECT_FALSE(touchOnce(*snapshot, Vec3(1e-3, 0, 2.05e-3)).attracted);
}

// A tip that is pulled over paint without touching is damped by the scene's value, whichever stage
// detects that there is no contact.
TEST(PulledRelief, PaintBelowDoesNotDampAMagnet) {
  const Slab& plane = fineSlab();
  Scene scene = sceneOf(500);
  scene.haptics.magnet = Magnet{1e-3, 300, false};
  scene.haptics.damping = 1;
  const HapticObject flat =
      hapticRelief(plane.faces, reliefImage(64, [](double, double) { return 0.5; }), 2e-3);
  for (const bool rough : {false, true}) {
    const auto map = coveredMap(plane.field->grid.voxel, cube(6e-3), MaterialChannel::damping,
                                [](const Vec3&) { return 8; });
    if (rough)
      coveredMap(
          plane.field->grid.voxel, cube(6e-3), MaterialChannel::roughness,
          [](const Vec3&) { return 2e-4; }, map);
    HapticObject object = rough ? HapticObject{} : flat;
    object.material = hapticMaterial(*map, scene).material;
    const auto snapshot = compiledRelief(scene, object, plane.field);
    const double foot = rough ? 0 : 1e-3; // the relief's height; the magnet ignores roughness
    ContactMemory memory;
    glide(*snapshot, memory, Vec3(1e-3, 0, foot + 0.9e-3));
    glide(*snapshot, memory, Vec3(1e-3, 0, foot + 0.4e-3));
    const Contact contact = tick(*snapshot, memory, Vec3(1e-3, 0, foot + 0.5e-3), 1e-3);
    EXPECT_TRUE(contact.attracted);
    EXPECT_NEAR(contact.force.z(), -300 * 0.5e-3 - 1 * 0.1, 5e-3);
  }
}

TEST(PulledRelief, IsRefusedWithTheRemedyIfHigherThanTheBand) {
  const Slab& plane = fineSlab();
  const HapticObject object =
      hapticRelief(plane.faces, reliefImage(64, [](double, double) { return 1; }), 8e-3);
  try {
    compiledRelief(sceneOf(500), object, plane.field);
    FAIL() << "accepted";
  } catch (const std::exception& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("relief"), std::string::npos) << text;
    EXPECT_NE(text.find("set band to 19"), std::string::npos) << text;
  }
}

// T-RAMP over relief: it is applied, raised and removed under a pressed tip, at 30 Hz; every edit
// moves the shell of contact.
TEST(PulledRelief, EditsUnderAPressedTipRamp) {
  const Slab& plane = fineSlab();
  const Scene scene = withFriction(sceneOf(500), 0.4, 0.3);
  std::vector<std::shared_ptr<const HapticSnapshot>> versions{compileStages(scene, plane.field)};
  for (const double s : {0.2e-3, 1e-3, 3e-3, -1e-3, 0.5e-3})
    for (const double k : {30.0, 200.0})
      versions.push_back(compiledRelief(scene,
                                        hapticRelief(plane.faces,
                                                     reliefImage(256,
                                                                 [=](double u, double v) {
                                                                   return std::sin(k * u) *
                                                                          std::cos(k * v);
                                                                 }),
                                                     s),
                                        plane.field));
  versions.push_back(versions.front());
  CrossFade law;
  law.fadeTo(versions.front().get());
  Vec3 tip(0.3e-3, 0, 1e-3);
  for (int i = 0; i < 100; ++i) law.tick(tip += Vec3(1e-5, 0, -2.5e-5), 1e-3);
  Vec3 last = law.tick(tip, 1e-3).force;
  double worst = 0;
  std::size_t next = 1;
  for (int i = 0; next < versions.size() || law.fading(); ++i) {
    if (i % 33 == 0 && !law.fading()) law.fadeTo(versions[next++].get());
    const Contact contact = law.tick(tip, 1e-3);
    ASSERT_FALSE(contact.fault) << next;
    worst = std::max(worst, (contact.force - last).norm());
    last = contact.force;
  }
  EXPECT_LE(worst, 0.05);
  EXPECT_GT(worst, 0.01);
}

// Two objects, one of them raised: each keeps its own relief.
TEST(PulledRelief, BelongsToTheTouchedObject) {
  TriangleMesh left = box(Vec3(0.02, 0.02, 0.012), 1), right = left;
  for (Vec3& p : left.positions) p += Vec3(-0.015, 0, -0.006);
  for (Vec3& p : right.positions) p += Vec3(0.015, 0, -0.006);
  FieldSpec spec;
  spec.voxel = 0.5e-3;
  Progress progress;
  const TriangleMesh both = joined(left, right);
  const Field field = withSamples(buildField(both, spec, progress).field);
  const auto white = reliefImage(64, [](double, double) { return 1; });
  const Scene scene = sceneOf(500);
  std::vector<HapticObject> objects{
      hapticRelief(reliefFaces(left, CornerUvs(left.triangles.size())), white, 0.5e-3),
      hapticRelief(reliefFaces(right, CornerUvs(right.triangles.size())), white, 1.5e-3)};
  objects[1].first_face = static_cast<std::int32_t>(left.triangles.size());
  objects[1].material = hapticMaterial(*coveredMap(0.5e-3, cube(0.03), MaterialChannel::stiffness,
                                                   [](const Vec3&) { return 800; }),
                                       scene)
                            .material;
  const auto snapshot = compileStages(scene, field, objects);
  ContactMemory memory;
  for (int round = 0; round < 3; ++round)
    for (const double x : {-0.015, 0.015}) {
      glide(*snapshot, memory, Vec3(memory.tip.last->x(), 1e-3, 6e-3));
      glide(*snapshot, memory, Vec3(x, 1e-3, 6e-3));
      const double top = x < 0 ? 0.5e-3 : 1.5e-3;
      EXPECT_FALSE(glide(*snapshot, memory, Vec3(x, 1e-3, top + 1e-5)).touching);
      const Contact contact = glide(*snapshot, memory, Vec3(x, 1e-3, top - 1e-3));
      EXPECT_NEAR(contact.force.z(), x < 0 ? 0.5 : 0.8, 1e-4);
      EXPECT_EQ(contact.object, x < 0 ? 0 : 1);
    }
}

} // namespace
} // namespace patina
