#include <algorithm>

#include "app/cli/commands/commands.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/file.h"
#include "core/staged_folder.h"
#include "demo/demo_pictures.h"
#include "demo/demo_report.h"
#include "visualization/view/display.h"

namespace patina::cli {

namespace {

struct DemoOptions {
  std::filesystem::path output = "patina-demo";
  std::uint32_t seed = 1;
};

const Keys kDemoKeys = {
    {"seed", "", "seed", "", Shown::never},
    {"steps", "", "steps", "", Shown::never, {{"step", "", ""}, {"seconds", "s", ""}}},
    {"scans", "", "scans", "", Shown::never},
    {"materials", "", "materials", "", Shown::never},
    {"figures",
     "",
     "figures",
     "errors against the truth, and what each may be at most",
     Shown::never,
     {{"step", "", ""},
      {"what", "", ""},
      {"of", "", ""},
      {"value", "", ""},
      {"most", "", ""},
      {"unit", "", ""},
      {"holds", "", ""}}},
    {"holds", "", "all hold"},
    {"pictures", "", "pictures", "", Shown::if_any},
    {"folder", "", "folder"}};

std::vector<std::string> pictures(const Demo& demo, Console& console) {
  try {
    requireDisplay();
  } catch (const Error& error) {
    console.warn("no pictures: " + std::string(error.what()));
    return {};
  }
  return drawDemo(demo);
}

int runDemo(const DemoOptions& options, Console& console) {
  if (std::filesystem::is_directory(options.output))
    requireWritable(options.output / "report.json", {}, FileKind::json);
  StagedFolder staged(options.output, "report.json");
  Demo demo(staged.path(), options.seed);
  while (!isDone(demo)) {
    const std::size_t step = demo.seconds.size();
    const DemoStep& next = demoSteps()[step];
    const double all = static_cast<double>(demoSteps().size());
    Progress part(console.progress(), [&](double fraction, std::string_view) {
      console.progress().report((static_cast<double>(step) + fraction) / all, next.name);
    });
    console.progress().report(static_cast<double>(step) / all, next.name);
    runNext(demo, part);
  }
  const std::vector<std::string> drawn = pictures(demo, console);
  const Json found = demoJson(demo);
  writeFileAtomically(demo.folder / "report.json", found.dump() + "\n");
  writeFileAtomically(demo.folder / "report.md", demoMarkdown(demo, drawn));
  console.progress().throwIfCancelled();
  staged.commit();
  Report report(kDemoKeys);
  for (const char* key : {"seed", "steps", "scans", "materials", "figures"})
    report.set(key, found.at(key));
  for (std::size_t i = 0; i < demo.seconds.size(); ++i)
    report.tell(demoSteps()[i].name, rounded(demo.seconds[i]) + " s: " + demoSteps()[i].about);
  for (const DemoFigure& figure : demoFigures(demo))
    report.tell(figure.what + (figure.of.empty() ? "" : ", " + figure.of),
                figureText(figure.value, figure.unit) + ", at most " +
                    figureText(figure.limit, figure.unit) + (figure.passes() ? "" : ": MISSED"));
  report.set("holds", found.at("holds")).set("pictures", jsonOf(drawn), joined(drawn));
  report.set("folder", options.output.string(),
             options.output.string() + "; report.md describes each step");
  return console.report(report, found.at("holds").asBool() ? kDone : kNotSolved);
}

} // namespace

Command demoCommand() {
  auto options = std::make_shared<DemoOptions>();
  return {
      .name = "demo",
      .summary = "from a scan to a feel: both papers on a toy, judged by the truth",
      .description =
          "A simulated hand scans three materials on a toy dinosaur and a simulated camera films "
          "it. The frames are tracked, the path filtered and registered, its heights fitted by "
          "harmonics and laid onto the mesh, paint is put beside them, and a tip feels the "
          "result. FOLDER gets every step's files, a workspace, pictures, and report.md and "
          "report.json with the error of each step: forces are compared with those of the true "
          "surface. Exit code 1 where an error is larger than it may be.\n"
          "Pictures need a display; on a machine without one: xvfb-run -a patina demo ...",
      .examples = {"patina demo", "patina demo -o demo --seed 7 --json"},
      .keys = kDemoKeys,
      .arguments = {{"-o,--output", "FOLDER", "", "patina-demo", "Made if it is missing.",
                     outInto(options->output), Times::at_most_once, true},
                    {"--seed", "N", "", "1", "Another hand, another noise.",
                     numberInto(0, 1e6, options->seed, NumberKind::whole)}},
      .run = [options](Console& console) { return runDemo(*options, console); }};
}

} // namespace patina::cli
