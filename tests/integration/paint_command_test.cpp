// patina paint: painted values are rendered, and the input stays unchanged.
#include <fcntl.h>
#include <signal.h>
#include <thread>

#include "integration/painted.h"
#include "session/edit/editor.h"

namespace patina::test {
namespace {

constexpr int kForceX = 4, kForceZ = 6, kDepth = 8;

class Paint : public Painted {};

TEST_F(Paint, KeepsTheInputByteForByteIfTheOutputDiffers) {
  const std::string before = fingerprint(workspace);
  const Json report = runJson({"paint", workspace, "--strokes", three(), "-o", folder / "painted"});
  EXPECT_EQ(fingerprint(workspace), before);
  EXPECT_EQ(report.at("strokes").asInteger(), 3);
  EXPECT_EQ(report.at("edits").asInteger(), 3);
  EXPECT_EQ(report.at("history").asInteger(), 3);
  EXPECT_GE(report.at("dabs").asInteger(), 4);
  EXPECT_GT(report.at("faces").asInteger(), 0);
  EXPECT_GT(report.at("texels").asInteger(), 100);
  EXPECT_GT(report.at("blocks").asInteger(), 0);
  EXPECT_GT(report.at("seconds").asNumber(), 0);
  for (const char* key : {"p50", "p99", "max"})
    EXPECT_GT(report.at("dab_ms").at(key).asNumber(), 0);
  const Scene scene = loadWorkspace(folder / "painted");
  ASSERT_TRUE(scene.objects[0].paint);
  EXPECT_TRUE(scene.objects[0].paint->color);
  EXPECT_TRUE(scene.objects[0].paint->relief);
  EXPECT_TRUE(scene.objects[0].paint->material);
}

// Rendered stiffness within 1 % of what was painted, with a hard brush that covers the cell.
TEST_F(Paint, RendersPaintedStiffness) {
  const std::string strokes = script("k.json", {stroke(Tool::material(MaterialChannel::stiffness),
                                                       900, 0.008, {{0.0003, 0.0004, kTop}})});
  ASSERT_EQ(run({"paint", workspace, "--strokes", strokes, "-o", workspace}).exit, 0);
  const std::string press = pressAt(0.0003, 0.0004, 1e-3);
  const std::vector<double> felt = hapticLast(workspace, press);
  EXPECT_NEAR(felt[kForceZ] / felt[kDepth], 900, 9);
  const std::vector<double> beside = hapticLast(workspace, pressAt(0.02, 0.0004, 1e-3));
  EXPECT_NEAR(beside[kForceZ] / beside[kDepth], 500, 5);
  // `patina sample` gives the same value.
  const std::string points =
      folder.write("p.csv", "x [m],y [m],z [m]\n0.0003,0.0004,0.021\n0.02,0.0004,0.021\n");
  ASSERT_EQ(run({"sample", workspace, "--points", points, "-o", folder / "s.csv"}).exit, 0);
  const CsvTable table = readCsv(folder / "s.csv", {"x [m]"});
  EXPECT_NEAR(table.rows[0][12], 900, 1e-3);
  EXPECT_NEAR(table.rows[1][12], 500, 1e-3);
}

// Coulomb: while it slides, the tangential force is mu_d times the normal one.
TEST_F(Paint, RendersPaintedFriction) {
  const std::vector<Vec3> way{{-0.015, 0, kTop}, {0.015, 0, kTop}};
  const std::string strokes = script(
      "mu.json", {stroke(Tool::material(MaterialChannel::static_friction), 0.6, 0.008, way),
                  stroke(Tool::material(MaterialChannel::dynamic_friction), 0.4, 0.008, way)});
  ASSERT_EQ(run({"paint", workspace, "--strokes", strokes, "-o", workspace}).exit, 0);
  std::string text = "t [s],x [m],y [m],z [m]\n";
  for (int i = 0; i < 1000; ++i)
    text += std::to_string(0.001 * i) + "," + std::to_string(-0.01 + 2e-5 * i) + ",0.0003," +
            std::to_string(kTop - 1e-5 * std::min(i, 100)) + "\n";
  const std::string drag = folder.write("drag.csv", text);
  const std::vector<double> felt = hapticLast(workspace, drag);
  EXPECT_NEAR(-felt[kForceX] / felt[kForceZ], 0.4, 0.004);
  const std::string points = folder.write("p.csv", "x [m],y [m],z [m]\n0,0,0.02\n");
  ASSERT_EQ(run({"sample", workspace, "--points", points, "-o", folder / "s.csv"}).exit, 0);
  const CsvTable table = readCsv(folder / "s.csv", {"x [m]"});
  EXPECT_NEAR(table.rows[0][13], 0.6, 1e-6);
  EXPECT_NEAR(table.rows[0][14], 0.4, 1e-6);
}

// K21: the surface is higher by the painted height, in both forms.
TEST_F(Paint, RendersPaintedReliefHeight) {
  const std::string strokes =
      script("r.json", {stroke(Tool::relief, 5e-4, 0.012, {{0.0003, 0.0004, kTop}})});
  ASSERT_EQ(run({"paint", workspace, "--strokes", strokes, "-o", workspace}).exit, 0);
  const std::string press = pressAt(0.0003, 0.0004, 1e-3);
  for (const char* mode : {"pulled", "baked"}) {
    ASSERT_EQ(run({"scene", "-o", workspace, "--set", std::string("relief.mode=") + mode}).exit, 0);
    const std::vector<double> felt = hapticLast(workspace, press);
    EXPECT_NEAR(felt[kForceZ] / 500, 1.5e-3, 1.5e-5) << mode;
  }
  // A negative height engraves by the same depth.
  ASSERT_EQ(run({"scene", "-o", workspace, "--set", "relief.height=-1mm"}).exit, 0);
  EXPECT_NEAR(hapticLast(workspace, press)[kForceZ] / 500, 0.5e-3, 1e-5);
}

// Colour, stiffness and friction by one stroke: one edit, on disk as one record.
TEST_F(Paint, StrokeOnSeveralLayersIsOneEditAndReplaysToTheSameBits) {
  Stroke several =
      stroke(Tool::material(MaterialChannel::stiffness), 900, 0.008, {{0.0003, 0.0004, kTop}});
  several.brush.extra_layers = {{Tool::color, {0.2, 0.9, 0.4}, 0},
                                {Tool::material(MaterialChannel::static_friction), {}, 0.6}};
  several.brush.anchor = DabAnchor::segment;
  several.samples[0].tip = Vec3(0.0003, 0.0004, kTop - 1e-3);
  const std::string strokes = script("several.json", {several});
  const Json report = runJson({"paint", workspace, "--strokes", strokes, "-o", folder / "a"});
  EXPECT_EQ(report.at("edits").asInteger(), 1);
  EXPECT_EQ(report.at("history").asInteger(), 1);
  const Scene painted = loadWorkspace(folder / "a");
  ASSERT_TRUE(painted.objects[0].paint && painted.objects[0].paint->color);
  EXPECT_TRUE(painted.objects[0].paint->material->has(MaterialChannel::static_friction));
  const std::vector<double> felt = hapticLast(folder / "a", pressAt(0.0003, 0.0004, 1e-3));
  EXPECT_NEAR(felt[kForceZ] / felt[kDepth], 900, 9);
  const std::string journal = openWorkspace(folder / "a").journal_file.string();
  ASSERT_EQ(run({"paint", workspace, "--strokes", journal, "-o", folder / "b"}).exit, 0);
  EXPECT_TRUE(same(painted, loadWorkspace(folder / "b")));
  ASSERT_EQ(run({"undo", folder / "a"}).exit, 0);
  EXPECT_FALSE(loadWorkspace(folder / "a").objects[0].paint);
  ASSERT_EQ(run({"redo", folder / "a"}).exit, 0);
  EXPECT_TRUE(same(painted, loadWorkspace(folder / "a")));
  const Outcome bad =
      run({"paint", workspace, "--strokes", strokes, "--seed", "far", "-o", folder / "c"});
  EXPECT_EQ(bad.exit, 2);
  EXPECT_NE(bad.err.find("segment"), std::string::npos) << bad.err;
}

// K21: the grey value of the colour, rendered as height in both forms.
TEST_F(Paint, RendersColourAsReliefIfTheSceneSaysSo) {
  Stroke color = stroke(Tool::color, 0, 0.012, {{0.0003, 0.0004, kTop}});
  color.brush.color = {1, 1, 1};
  const std::string strokes = script("white.json", {color});
  ASSERT_EQ(run({"paint", workspace, "--strokes", strokes, "-o", workspace}).exit, 0);
  const std::string press = pressAt(0.0003, 0.0004, 1e-3);
  EXPECT_NEAR(hapticLast(workspace, press)[kForceZ] / 500, 1e-3, 1e-5);
  for (const char* mode : {"pulled", "baked"}) {
    ASSERT_EQ(run({"scene", "-o", workspace, "--set", "relief.source=color", "--set",
                   "relief.height=0.5mm", "--set", std::string("relief.mode=") + mode})
                  .exit,
              0);
    EXPECT_NEAR(hapticLast(workspace, press)[kForceZ] / 500, 1.5e-3, 1.5e-5) << mode;
  }
}

// A journal is a script.
TEST_F(Paint, ReplayOfAJournalGivesTheSameBits) {
  setenv("SOURCE_DATE_EPOCH", "1764000000", 1); // the only clock in it
  ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", folder / "a"}).exit, 0);
  ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", folder / "b"}).exit, 0);
  const Scene a = loadWorkspace(folder / "a");
  EXPECT_TRUE(same(a, loadWorkspace(folder / "b")));
  EXPECT_EQ(fingerprint(folder / "a"), fingerprint(folder / "b"));
  unsetenv("SOURCE_DATE_EPOCH");
  // An undone stroke is not in the journal's script.
  ASSERT_EQ(run({"paint", folder / "b", "--strokes",
                 script("more.json", {stroke(Tool::material(MaterialChannel::damping), 2, 0.006,
                                             {{0, 0, kTop}})}),
                 "-o", folder / "b"})
                .exit,
            0);
  ASSERT_EQ(run({"undo", folder / "b"}).exit, 0);
  const std::string journal = openWorkspace(folder / "b").journal_file.string();
  const Json report = runJson({"paint", workspace, "--strokes", journal, "-o", folder / "c"});
  EXPECT_EQ(report.at("strokes").asInteger(), 3);
  EXPECT_TRUE(same(a, loadWorkspace(folder / "c")));
}

// The result follows from the strokes, not from measurements or values set meanwhile.
TEST_F(Paint, DoesNotDependOnTheScenesEarlierOffset) {
  ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", folder / "a"}).exit, 0);
  ASSERT_EQ(run({"scene", "-o", workspace, "--set", "offset=7mm"}).exit, 0);
  ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", workspace}).exit, 0);
  ASSERT_EQ(run({"scene", "-o", workspace, "--set", "offset=none"}).exit, 0);
  EXPECT_TRUE(same(loadWorkspace(folder / "a"), loadWorkspace(workspace)));
}

TEST_F(Paint, MakesAWorkspaceOfAMesh) {
  const std::string out = folder / "new";
  ASSERT_EQ(run({"paint", box, "--strokes", three(), "-o", out}).exit, 0);
  EXPECT_TRUE(isWorkspace(out));
  EXPECT_EQ(runJson({"undo", out, "--list"}).at("edits").asArray().size(), 3U);
}

TEST_F(Paint, NamesAStrokeThatTouchedNothing) {
  std::vector<Stroke> strokes{
      stroke(Tool::relief, 1e-4, 0.004, {{0, 0, 0.5}}),
      stroke(Tool::material(MaterialChannel::stiffness), 900, 1e-4, {{0.0005, 0.0005, kTop}}),
      stroke(Tool::material(MaterialChannel::stiffness), 900, 0.0012, {{0, 0, kTop}}),
      stroke(Tool::material(MaterialChannel::stiffness), 900, 0.006, {{0, 0, kTop}})};
  const std::string before = fingerprint(workspace);
  const Outcome outcome = run(
      {"paint", workspace, "--strokes", script("s.json", strokes), "-o", folder / "p", "--json"});
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("stroke 1 touched nothing"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("stroke 2 painted nothing: no node"), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("stroke 3: a radius of 1.2 mm"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("stroke 4"), std::string::npos) << outcome.err;
  const Json report = parseJson(outcome.out, "stdout");
  EXPECT_EQ(report.at("strokes").asInteger(), 4);
  EXPECT_EQ(report.at("edits").asInteger(), 2);
}

TEST_F(Paint, BadStrokesChangeNothingOnDisk) {
  const std::string before = fingerprint(workspace);
  const std::string good = three();
  const std::pair<std::string, std::vector<std::string>> bad[] = {
      {R"({"version": 1, "strokes": [{"tool": "hammer", "value": 1, "samples": []}]})",
       {"bad.json", "stroke 1", "hammer"}},
      {R"({"version": 9, "strokes": []})", {"bad.json", "version 9"}},
      {R"({"version": 1, "strokes": [{"tool": "relief", "value": 1e-3, "radios": 1, "samples": []}]})",
       {"bad.json", "radios"}},
      {R"({"version": 1, "strokes": [{"tool": "relief", "value": NaN, "samples": []}]})",
       {"bad.json:1:"}},
      {R"({"version": 1, "strokes": [{"tool": "relief", "value": 1e-3, "radius": -1, "samples": []}]})",
       {"bad.json", "radius", "-1"}},
      {"{\"version\": 1,\n \"strokes\": [\n", {"bad.json:"}},
      {"{\"version\": 1, \"strokes\": [\n{\"tool\": \"relief\", \"value\": 1e-3, \"samples\": "
       "[]}]}",
       {"bad.json:2: stroke 1: 'samples' is empty"}},
      {"", {"bad.json"}}};
  for (const auto& [text, parts] : bad) {
    const std::string file = folder.write("bad.json", text);
    for (const std::string& out : {workspace, folder / "out"})
      expectOneLineError(run({"paint", workspace, "--strokes", good, "--strokes", file, "-o", out}),
                         parts);
  }
  expectOneLineError(run({"paint", workspace, "--strokes", folder / "none.json", "-o", workspace}),
                     {"none.json"});
  expectOneLineError(run({"paint", workspace, "-o", workspace}), {"--strokes"});
  EXPECT_EQ(fingerprint(workspace), before);
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  // A foreign folder is never overwritten.
  std::filesystem::create_directories(folder / "photos");
  folder.write("photos/cat.txt", "meow");
  expectOneLineError(run({"paint", workspace, "--strokes", good, "-o", folder / "photos"}),
                     {"photos", "not a workspace"});
  expectOneLineError(run({"paint", folder / "photos", "--strokes", good, "-o", folder / "out"}),
                     {"photos", "not a workspace"});
}

TEST_F(Paint, RefusesReliefWithoutAHeightBeforePainting) {
  ASSERT_EQ(run({"scene", "-o", workspace, "--set", "relief.height=0"}).exit, 0);
  const std::string before = fingerprint(workspace);
  expectOneLineError(run({"paint", workspace, "--strokes", three(), "-o", workspace}),
                     {"stroke 2", "relief.height"});
  EXPECT_EQ(fingerprint(workspace), before);
}

TEST_F(Paint, RefusesASecondProgramWhileTheJournalIsLocked) {
  ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", workspace}).exit, 0);
  Progress progress;
  const auto editor = Editor::open(workspace, {}, progress);
  const std::string before = fingerprint(workspace);
  expectOneLineError(run({"paint", workspace, "--strokes", three(), "-o", workspace}), {"journal"});
  expectOneLineError(run({"undo", workspace}), {"journal"});
  expectOneLineError(run({"scene", "-o", workspace, "--set", "stiffness=800"}), {"journal"});
  EXPECT_EQ(fingerprint(workspace), before);
  // Commands that only read may run.
  EXPECT_EQ(run({"info", workspace}).exit, 0);
  EXPECT_EQ(run({"paint", workspace, "--strokes", three(), "-o", folder / "copy"}).exit, 0);
}

// A program that was killed after a stroke leaves a journal with more edits than the saved scene.
TEST_F(Paint, NextCommandHasUnsavedStrokes) {
  ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", workspace}).exit, 0);
  const std::string torn = folder / "torn";
  Scene expected;
  {
    Progress progress;
    const auto editor = Editor::open(workspace, {}, progress);
    editor->apply(
        stroke(Tool::material(MaterialChannel::stiffness), 1200, 0.006, {{-0.01, 0.01, kTop}}),
        progress);
    editor->apply(stroke(Tool::relief, 3e-4, 0.006, {{0.01, -0.01, kTop}}), progress);
    expected = editor->scene();
    std::filesystem::copy(workspace, torn, std::filesystem::copy_options::recursive);
  }
  const std::string before = fingerprint(torn);
  const std::vector<double> felt = hapticLast(torn, pressAt(-0.01, 0.01, 1e-3));
  EXPECT_NEAR(felt[kForceZ] / felt[kDepth], 1200, 12);
  EXPECT_EQ(runJson({"info", torn}).at("history").at("undo").asInteger(), 5);
  EXPECT_EQ(fingerprint(torn), before); // reading leaves it unchanged
  const Json undone = runJson({"undo", torn});
  EXPECT_EQ(undone.at("history").asInteger(), 4);
  ASSERT_EQ(run({"redo", torn}).exit, 0);
  EXPECT_TRUE(same(loadWorkspace(torn), expected));
}

TEST_F(Paint, ChangesNothingIfInterrupted) {
  std::vector<Stroke> strokes;
  for (int i = 0; i < 400; ++i)
    strokes.push_back(stroke(Tool::material(MaterialChannel::stiffness), 600 + i, 0.008,
                             {{-0.02, 0, kTop}, {0.02, 0, kTop}}));
  const std::string many = script("many.json", strokes);
  ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", workspace}).exit, 0);
  const std::string before = fingerprint(workspace);
  for (const std::string& out : {folder / "out", workspace}) {
    Running painting({"paint", workspace, "--strokes", many, "-o", out}, programPath());
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    painting.signal(SIGINT);
    const Outcome outcome = painting.wait();
    ASSERT_EQ(outcome.exit, 130) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
    EXPECT_EQ(fingerprint(workspace), before);
  }
}

TEST_F(Paint, NamesStrokesThatChangedNothingAndAddsNoEdit) {
  const std::vector<Tool> tools{Tool::color, Tool::relief,
                                Tool::material(MaterialChannel::stiffness)};
  std::vector<Stroke> strokes;
  for (const Tool& tool : tools) {
    strokes.push_back(stroke(tool, 1e-3, 0.00613, {{0, 0, kTop}}));
    strokes.back().brush.falloff = 1e6; // what is half covered at the edge would get more
  }
  const std::string same = script("same.json", strokes);
  ASSERT_EQ(run({"paint", workspace, "--strokes", same, "-o", workspace}).exit, 0);
  const std::string before = fingerprint(workspace);
  const Outcome outcome = run({"paint", workspace, "--strokes", same, "-o", workspace, "--json"});
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  for (int i = 1; i <= 3; ++i)
    EXPECT_NE(outcome.err.find("stroke " + std::to_string(i) + " changed nothing"),
              std::string::npos)
        << outcome.err;
  EXPECT_EQ(parseJson(outcome.out, "stdout").at("edits").asInteger(), 0);
  EXPECT_EQ(fingerprint(workspace), before);
}

} // namespace
} // namespace patina::test
