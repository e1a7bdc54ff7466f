#include "core/error.h"
#include "scene/scene.h"
#include "scene/scene_values.h"

namespace patina {
namespace {

using List = std::vector<std::pair<std::string, std::string>>;

List withEverything() {
  return {{"stiffness", "800"},
          {"damping", "1.5"},
          {"damping.cutoff", "300"},
          {"friction.static", "0.5"},
          {"friction.dynamic", "0.3"},
          {"friction.depth", "2"},
          {"friction.slip", "displacement"},
          {"magnet.range", "0.002"},
          {"magnet.strength", "250"},
          {"magnet.fades", "on"},
          {"contact", "ray"},
          {"tip.radius", "0.0015"},
          {"force.limit", "5"},
          {"voxel", "0.001"},
          {"band", "6"},
          {"sampler", "kim"},
          {"surface.sides", "two"},
          {"merge.redistance", "on"},
          {"relief.mode", "baked"},
          {"relief.source", "color"},
          {"relief.height", "-5e-04"},
          {"relief.force", "literal"},
          {"relief.smoothing", "2e-04"},
          {"material.force", "literal"},
          {"paint.size", "1024"},
          {"stabiliser", "coupling,passivity"},
          {"device.mass", "0.2"},
          {"device.damping", "1"},
          {"device.coulomb", "0.03"},
          {"device.encoder", "3e-05"},
          {"device.rate", "4000"},
          {"device.delay", "2"},
          {"device", "simulated"}};
}

TEST(SceneValues, EveryKeyIsSetAndListed) {
  Scene scene;
  for (const auto& [key, value] : withEverything()) setValue(scene, key, value);
  EXPECT_EQ(values(scene), withEverything());
  EXPECT_EQ(scene.haptics.friction->dynamic_coefficient, 0.3);
  EXPECT_EQ(scene.sampler, Sampler::kim);
  EXPECT_EQ(scene.field.voxel, 0.001);
}

TEST(SceneValues, ListedValuesMakeTheSameScene) {
  for (const List& list : {List{}, withEverything(), List{{"resolution", "99"}, {"band", "4"}},
                           List{{"friction.static", "0.5"}, {"friction.dynamic", "0"}}}) {
    Scene scene, again;
    setValues(scene, list);
    setValues(again, values(scene));
    EXPECT_EQ(values(again), values(scene));
  }
}

TEST(SceneValues, AbsentFeaturesAreNotListed) {
  const List list = values(Scene{});
  for (const auto& [key, value] : list) {
    EXPECT_FALSE(key.starts_with("friction")) << key;
    EXPECT_NE(key, "damping");
    EXPECT_NE(key, "tip.radius");
    EXPECT_NE(key, "voxel");
  }
}

TEST(SceneValues, NoneRemovesAFeature) {
  Scene scene;
  setValues(scene, withEverything());
  setValue(scene, "surface.sides", "auto");
  for (const char* key : {"damping", "friction.static", "tip.radius", "voxel"})
    setValue(scene, key, "none");
  EXPECT_FALSE(scene.haptics.damping);
  EXPECT_FALSE(scene.haptics.friction);
  EXPECT_FALSE(scene.haptics.tip_radius);
  EXPECT_FALSE(scene.field.voxel);
  for (const char* key : {"stiffness", "force.limit", "resolution", "band", "sampler"})
    EXPECT_THROW(setValue(scene, key, "none"), Error) << key;
}

TEST(SceneValues, OffsetAndMagnetExcludeEachOther) {
  Scene scene;
  setValue(scene, "offset", "2mm");
  EXPECT_DOUBLE_EQ(*scene.haptics.offset, 0.002);
  EXPECT_THROW(setValues(scene, {{"magnet.range", "1mm"}, {"magnet.strength", "300"}}), Error);
  EXPECT_FALSE(scene.haptics.magnet);
  setValues(scene, {{"offset", "none"}, {"magnet.range", "1mm"}, {"magnet.strength", "300"}});
  EXPECT_EQ(scene.haptics.magnet, (Magnet{0.001, 300, false}));
  setValue(scene, "magnet.range", "none");
  EXPECT_FALSE(scene.haptics.magnet);
}

TEST(SceneValues, BadValuesOfTheLoopAreRefused) {
  Scene scene;
  for (const auto& [key, value] : List{{"contact", "maybe"},
                                       {"stabiliser", "naive"},
                                       {"device.delay", "1.5"},
                                       {"device.mass", "0"},
                                       {"device.rate", "50"},
                                       {"magnet.strength", "-1"},
                                       {"offset", "-1mm"},
                                       {"damping.cutoff", "0"}}) {
    EXPECT_THROW(setValue(scene, key, value), Error) << key;
    EXPECT_EQ(values(scene), values(Scene{})) << key;
  }
}

TEST(SceneValues, BadValuesOfPaintAreRefused) {
  Scene scene;
  for (const auto& [key, value] : List{{"relief.mode", "pushed"},
                                       {"relief.height", "1"}, // m
                                       {"relief.force", "strong"},
                                       {"relief.smoothing", "-1mm"},
                                       {"material.force", "paper"},
                                       {"paint.size", "500"},
                                       {"paint.size", "8192"},
                                       {"paint.size", "512.5"}}) {
    EXPECT_THROW(setValue(scene, key, value), Error) << key;
    EXPECT_EQ(values(scene), values(Scene{})) << key;
  }
}

TEST(SceneValues, TwoSidesNeedATipOrAnOffset) {
  for (const List& list :
       {List{{"surface.sides", "two"}}, List{{"surface.sides", "two"}, {"tip.radius", "0"}},
        List{{"surface.sides", "both"}, {"tip.radius", "1mm"}}}) {
    Scene scene;
    EXPECT_THROW(setValues(scene, list), Error);
    EXPECT_EQ(scene.field.sides, OpenSides::automatic);
  }
  for (const char* size : {"tip.radius", "offset"}) {
    Scene scene;
    setValues(scene, {{"surface.sides", "two"}, {size, "1mm"}});
    EXPECT_EQ(scene.field.sides, OpenSides::two);
    EXPECT_THROW(setValue(scene, size, "none"), Error);
  }
}

TEST(SceneValues, LengthsTakeUnits) {
  Scene scene;
  setValue(scene, "tip.radius", "0.5mm");
  EXPECT_DOUBLE_EQ(*scene.haptics.tip_radius, 0.0005);
  setValue(scene, "voxel", "20um");
  EXPECT_DOUBLE_EQ(*scene.field.voxel, 2e-5);
}

TEST(SceneValues, LastOfResolutionAndVoxelApplies) {
  Scene scene;
  setValue(scene, "voxel", "1mm");
  setValue(scene, "resolution", "80");
  EXPECT_FALSE(scene.field.voxel);
  EXPECT_EQ(scene.field.resolution, 80);
}

TEST(SceneValues, OneCoefficientIsPlainCoulombFriction) {
  Scene scene;
  setValue(scene, "friction.dynamic", "0.4");
  EXPECT_EQ(scene.haptics.friction->static_coefficient, 0.4);
  EXPECT_EQ(scene.haptics.friction->dynamic_coefficient, 0.4);
}

TEST(SceneValues, OrderOfSeveralDoesNotMatter) {
  for (const List& pair : {List{{"friction.static", "0.5"}, {"friction.dynamic", "0.3"}},
                           List{{"friction.static", "0.5"}, {"friction.dynamic", "0"}},
                           List{{"resolution", "12"}, {"band", "4"}}}) {
    Scene forward, backward;
    setValues(forward, pair);
    setValues(backward, {pair.rbegin(), pair.rend()});
    EXPECT_EQ(values(forward), values(backward));
  }
}

TEST(SceneValues, RejectedValueLeavesTheSceneUnchanged) {
  Scene scene;
  setValues(scene, withEverything());
  for (const auto& [key, value] : List{{"stiffness", "-1"},
                                       {"stiffness", "many"},
                                       {"stiffness", "1,5"},
                                       {"stiffness", ""},
                                       {"damping", "nan"},
                                       {"friction.dynamic", "0.6"},
                                       {"friction.slip", "sideways"},
                                       {"tip.radius", "5kg"},
                                       {"resolution", "10.5"},
                                       {"resolution", "1e9"},
                                       {"band", "0"},
                                       {"sampler", "best"},
                                       {"colour", "red"},
                                       {"", "1"}}) {
    EXPECT_THROW(setValue(scene, key, value), Error) << key << "=" << value;
    EXPECT_EQ(values(scene), withEverything());
  }
  EXPECT_THROW(setValues(scene, {{"stiffness", "100"}, {"band", "0"}}), Error);
  EXPECT_EQ(values(scene), withEverything());
}

TEST(SceneValues, DefaultOfEveryKeyIsThatOfANewScene) {
  const List fresh = values(Scene{});
  for (const auto& [key, value] : fresh) EXPECT_EQ(sceneKey(key).default_value, value) << key;
  for (const char* key : {"contact", "surface.sides", "merge.redistance", "relief.mode",
                          "relief.height", "relief.force", "material.force", "paint.size",
                          "stabiliser", "damping", "voxel", "device.mass"}) {
    Scene scene;
    setValue(scene, key, sceneKey(key).default_value);
    EXPECT_EQ(values(scene), fresh) << key;
  }
}

// Words that journals contain.
TEST(SceneValues, WordForAnAbsentFeatureIsStable) {
  const List words{{"contact", "proxy"},
                   {"surface.sides", "auto"},
                   {"merge.redistance", "off"},
                   {"relief.mode", "pulled"},
                   {"relief.source", "none"},
                   {"relief.height", "0.001"},
                   {"relief.smoothing", "none"},
                   {"relief.force", "conservative"},
                   {"material.force", "conservative"},
                   {"paint.size", "512"},
                   {"stabiliser", "auto"},
                   {"friction.slip", "none"},
                   {"magnet.fades", "none"},
                   {"device.delay", "none"}};
  for (const auto& [key, word] : words) EXPECT_EQ(sceneKey(key).default_value, word) << key;
  EXPECT_THROW(sceneKey("stifness"), std::out_of_range);
}

TEST(SceneValues, UnknownKeyListsTheKnownKeys) {
  Scene scene;
  try {
    setValue(scene, "stifness", "5");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(
        std::string(error.what()),
        "unknown key 'stifness'; known are: stiffness damping damping.cutoff friction.static "
        "friction.dynamic friction.depth friction.slip offset magnet.range magnet.strength "
        "magnet.fades texture.gain contact tip.radius force.limit resolution voxel band sampler "
        "surface.sides merge.redistance relief.mode relief.source relief.height relief.force "
        "relief.smoothing material.force paint.size stabiliser device.mass device.damping "
        "device.coulomb "
        "device.encoder device.rate device.delay device pins colors.slice colors.iso colors.mesh "
        "colors.error colors.relief colors.stiffness colors.friction.static "
        "colors.friction.dynamic colors.damping colors.roughness slice slice2 slice3");
  }
}

} // namespace
} // namespace patina
