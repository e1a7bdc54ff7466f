// Prints the figures of a contact method in the trials, one row per scene and iso.
//   contact_course [--scene NAME] [--iso MM] [--ticks N] [--loops N] [--resolution 150]
//                  [--contact ray] [--seed 1]
#include <algorithm>
#include <cstdio>
#include <exception>
#include <numeric>
#include <stdexcept>
#include <string>

#include "app/studies/contact/contact_trials.h"
#include "core/percentiles.h"
#include "support/judged_scenes.h"

namespace patina::test {
namespace {

struct Options {
  std::string scene, contact;
  double iso = -1; // [m]; negative: all
  long ticks = 2000;
  int loops = 10, resolution = 150;
  unsigned seed = 1;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; i += 2) {
    const std::string key = argv[i];
    if (i + 1 == argc) throw std::invalid_argument(key + " needs a value");
    const std::string value = argv[i + 1];
    if (key == "--scene")
      options.scene = value;
    else if (key == "--contact")
      options.contact = value;
    else if (key == "--iso")
      options.iso = 1e-3 * std::stod(value);
    else if (key == "--ticks")
      options.ticks = std::stol(value);
    else if (key == "--loops")
      options.loops = std::stoi(value);
    else if (key == "--resolution")
      options.resolution = std::stoi(value);
    else if (key == "--seed")
      options.seed = static_cast<unsigned>(std::stoul(value));
    else
      throw std::invalid_argument("unknown option " + key);
  }
  return options;
}

void printRow(const std::string& name, double iso, const TrialReport& r, double generated_energy) {
  const Percentiles e = percentiles(r.error), f = percentiles(r.free_error),
                    ran = percentiles(r.relocation_error), ns = percentiles(r.ns);
  const double samples = std::accumulate(r.samples.begin(), r.samples.end(), 0.0) /
                         std::max<double>(1, static_cast<double>(r.samples.size()));
  std::printf(
      "%-9s %3.1f %8ld %7ld %7ld %6ld %7.2f %7ld %5.1f%% %5.3f %5.3f %5.3f | %5.3f %5.3f "
      "%5.3f | %5.3f %5.3f %5.3f %7.4f %5.2f %5.0f %5.0f %6.0f %ld\n",
      name.c_str(), 1e3 * iso, r.contacts, r.lost, r.pulls, r.faults, r.worst_excess, r.excesses,
      100.0 * static_cast<double>(r.relocations) / static_cast<double>(std::max(1L, r.contacts)),
      e.p50, e.p99, e.p999, ran.p50, ran.p99, ran.p999, f.p50, f.p99, f.p999,
      1e3 * generated_energy, samples, ns.p50, ns.p99, ns.p999, r.unverified);
  std::fflush(stdout);
}

void run(const Options& options) {
  std::printf("%-9s %3s %8s %7s %7s %6s %7s %7s %6s %-17s | %-17s | %-17s %7s %5s %-18s unjudged\n",
              "scene", "iso", "contacts", "lost", "pulls", "faults", "step N", "steps", "snap",
              "error p50/99/99.9", "of snaps", "free running", "mJ loop", "reads",
              "ns p50/99/99.9");
  TrialReport total;
  double generated_energy = 0;
  bool known = options.scene.empty();
  for (const ContactScene& scene : judgedScenes()) {
    if (!options.scene.empty() && options.scene != scene.name) continue;
    known = true;
    const ExactSurface surface(scene.meshes);
    for (const double iso : scene.isos) {
      if (options.iso >= 0 && std::abs(iso - options.iso) > 1e-9) continue;
      const unsigned seed = trialSeed(scene, iso, options.seed);
      const auto snapshot =
          contactSnapshot(contactField(scene, iso, options.resolution), iso, options.contact);
      const TrialReport report = runTrials(methodOf(*snapshot), surface, iso, options.ticks, seed);
      const LoopReport loops =
          runLoops(methodOf(*snapshot), surface, iso, options.loops, seed + 1000);
      printRow(scene.name, iso, report, loops.generated_energy);
      total.add(report);
      generated_energy = std::max(generated_energy, loops.generated_energy);
    }
  }
  if (!known) contactScene(options.scene); // throws, naming those there are
  printRow("total", 0, total, generated_energy);
}

} // namespace
} // namespace patina::test

int main(int argc, char** argv) {
  try {
    patina::test::run(patina::test::parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "contact_course: %s\n", error.what());
    return 2;
  }
}
