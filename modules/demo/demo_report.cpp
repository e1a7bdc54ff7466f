#include "demo/demo_report.h"

#include <cmath>

#include "core/numbers.h"
#include "core/version.h"

namespace patina {
namespace {

// Limits that `patina demo` guarantees.
constexpr double kRegistration = 0.2e-3, kLag = 0.3e-3; // [m]
constexpr double kWavelength = 0.01, kStiffness = 0.05, kTextureError = 0.3, kRelativeError = 0.1;
constexpr double kDecibels = 2;

double off(double value, double truth) {
  return std::abs(value / truth - 1);
}

double stiffnessOf(const DemoTexture& texture) {
  return 1 / texture.scanned.fitted.texture.compliance.value_or(INFINITY);
}

std::string row(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const std::string& cell : cells) text += " " + cell + " |";
  return text + "\n";
}

double millimetres(double length) {
  return std::round(length * 1e5) / 100;
}

} // namespace

std::string figureText(double value, const std::string& unit) {
  if (unit == "m") return formatLength(value);
  if (unit == "dB") return formatNumber(std::round(value * 100) / 100) + " dB";
  return formatNumber(std::round(value * 1000) / 10) + " %";
}

std::vector<DemoFigure> demoFigures(const Demo& demo) {
  std::vector<DemoFigure> figures;
  const std::size_t steps = demo.seconds.size();
  if (steps >= 4)
    figures.push_back(
        {"register", "registration", "", demo.registration_error, kRegistration, "m"});
  for (std::size_t i = 0; i < demo.textures.size(); ++i) {
    const DemoTexture& texture = demo.textures[i];
    const DemoMaterial& material = demo.object.materials[i];
    const SpectrumError& spectrum = texture.spectrum;
    const std::string& of = material.name;
    figures.push_back({"fit", "dominant wavelength", of,
                       off(spectrum.wavelength, spectrum.true_wavelength), kWavelength, ""});
    figures.push_back({"fit", "spectrum, worst harmonic", of, spectrum.decibels, kDecibels, "dB"});
    figures.push_back({"fit", "stiffness, scanned", of,
                       off(stiffnessOf(texture), material.stiffness), kStiffness, ""});
    if (steps < demoSteps().size()) continue;
    const ForceError& felt = texture.force_error;
    figures.push_back({"feel", "stiffness, felt against scanned", of,
                       off(texture.stiffness, stiffnessOf(texture)), kStiffness, ""});
    figures.push_back({"feel", "lag along the path", of, felt.spatial_lag, kLag, "m"});
    figures.push_back(
        {"feel", "variation of the force", of, felt.texture_error, kTextureError, ""});
    figures.push_back({"feel", "whole force", of, felt.relative_error, kRelativeError, ""});
  }
  return figures;
}

Json demoJson(const Demo& demo) {
  Json steps = Json::array(), scans = Json::array(), materials = Json::array(),
       figures = Json::array();
  for (std::size_t i = 0; i < demo.seconds.size(); ++i)
    steps.push(Json::object().set("step", demoSteps()[i].name).set("seconds", demo.seconds[i]));
  for (const DemoScan& scan : demo.scans)
    scans.push(Json::object()
                   .set("name", scan.name)
                   .set("seconds", scan.hand.seconds())
                   .set("frames", scan.frames)
                   .set("poses", scan.streams.poses.size())
                   .set("tip_error", scan.tip_error)
                   .set("path_error", scan.path_error.rms)
                   .set("path_nees", scan.path_error.nees));
  for (std::size_t i = 0; i < demo.textures.size(); ++i) {
    const DemoTexture& texture = demo.textures[i];
    const DemoMaterial& material = demo.object.materials[i];
    Json json = Json::object();
    json.set("name", material.name).set("stiffness", material.stiffness);
    json.set("stiffness_found", stiffnessOf(texture)).set("stiffness_felt", texture.stiffness);
    json.set("length", texture.scanned.fitted.length).set("noise", texture.scanned.fitted.noise);
    json.set("wavelength", texture.spectrum.true_wavelength)
        .set("wavelength_found", texture.spectrum.wavelength);
    json.set("amplitude", texture.spectrum.true_amplitude)
        .set("amplitude_found", texture.spectrum.amplitude);
    json.set("harmonics_compared", texture.spectrum.harmonic_count);
    json.set("worst_harmonic_stretched", texture.spectrum.with_scale_error);
    json.set("faces", texture.scanned.laid.faces.size());
    json.set("true_variation", texture.force_error.true_variation);
    materials.push(json);
  }
  bool all = true;
  for (const DemoFigure& figure : demoFigures(demo)) {
    all = all && figure.passes();
    figures.push(Json::object()
                     .set("step", figure.step)
                     .set("what", figure.what)
                     .set("of", figure.of)
                     .set("value", figure.value)
                     .set("most", figure.limit)
                     .set("unit", figure.unit)
                     .set("holds", figure.passes()));
  }
  Json json = Json::object();
  json.set("program", programDescription());
  json.set("seed", static_cast<std::int64_t>(demo.seed)).set("steps", steps);
  json.set("scans", scans).set("materials", materials).set("figures", figures);
  return json.set("holds", all);
}

std::string demoMarkdown(const Demo& demo, const std::vector<std::string>& pictures) {
  std::string text = "# From a scan to a feel\n\n"
                     "A toy dinosaur of 200 mm with three materials, scanned by a simulated hand. "
                     "Every figure is an error\nagainst the simulation's ground truth; forces are "
                     "compared with a reference computed from the\ntrue heights, without our "
                     "field, contact or textures.\n\nMade by patina " +
                     versionText() + ", seed " + std::to_string(demo.seed) + ".\n\n## Steps\n\n";
  text += row({"step", "", "time [s]"}) + "|---|---|---|\n";
  for (std::size_t i = 0; i < demo.seconds.size(); ++i)
    text += row({demoSteps()[i].name, demoSteps()[i].about,
                 formatNumber(std::round(demo.seconds[i] * 100) / 100)});
  text += "\n## Scans\n\n" +
          row({"scan", "lasts [s]", "frames with a pose", "tip of the poses", "tip of the path",
               "NEES"}) +
          "|---|---|---|---|---|---|\n";
  for (const DemoScan& scan : demo.scans)
    text += row({scan.name, formatNumber(std::round(scan.hand.seconds() * 10) / 10),
                 std::to_string(scan.streams.poses.size()) + " of " + std::to_string(scan.frames),
                 formatLength(scan.tip_error), formatLength(scan.path_error.rms),
                 formatNumber(std::round(scan.path_error.nees * 100) / 100)});
  text += "\nNEES is the squared error of a sample over its stated variance, on the "
          "mean: 1 if the\nvariance is right.\n";
  text += "\n## Materials\n\n" +
          row({"material", "path [mm]", "wavelength [mm]", "found", "amplitude", "found",
               "stiffness [N/m]", "found", "faces"}) +
          "|---|---|---|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < demo.textures.size(); ++i) {
    const DemoTexture& texture = demo.textures[i];
    const SpectrumError& spectrum = texture.spectrum;
    text += row(
        {demo.object.materials[i].name, formatNumber(millimetres(texture.scanned.fitted.length)),
         formatNumber(millimetres(spectrum.true_wavelength)),
         formatNumber(millimetres(spectrum.wavelength)), formatLength(spectrum.true_amplitude),
         formatLength(spectrum.amplitude), formatNumber(demo.object.materials[i].stiffness),
         formatNumber(std::round(stiffnessOf(texture))),
         std::to_string(texture.scanned.laid.faces.size())});
  }
  text += "\nNoise grows as the square of the wavelength. The strongest true harmonic is compared, "
          "and those\nabove 5 um at 1 mm, a limit that grows as the square.\n\n## Errors\n\n" +
          row({"step", "error of", "material", "found", "at most", ""}) +
          "|---|---|---|---|---|---|\n";
  for (const DemoFigure& figure : demoFigures(demo))
    text += row({figure.step, figure.what, figure.of, figureText(figure.value, figure.unit),
                 figureText(figure.limit, figure.unit), figure.passes() ? "holds" : "**missed**"});
  text += "\nThe variation of the force is compared after the removal of one lag per 10 mm, "
          "which has a row of its own.\n\n## Pictures\n";
  if (pictures.empty())
    text += "\nThere was no display for the pictures; `xvfb-run -a patina demo` provides one.\n";
  for (const std::string& picture : pictures)
    text += "\n![" + picture.substr(0, picture.find('.')) + "](" + picture + ")\n";
  text += "\n## The same by commands\n\n"
          "Each scan is a folder that every command and the window's Scan desk open. All steps at "
          "once, with the same\nresult to the last bit:\n\n"
          "    patina scan scan-ribs scan-weave scan-grain scan-survey --mesh toy.obj -o mine\n\n"
          "and one by one:\n\n"
          "    patina track scan-ribs -o scan-ribs/poses.tum\n"
          "    patina filter scan-ribs -o path-ribs.csv\n"
          "    patina register toy.obj path-ribs.csv --with path-weave.csv --with path-grain.csv "
          "\\\n        --with path-survey.csv -o registered.csv --report r.json\n"
          "    patina filter scan-ribs -o path.csv --heights heights.csv --reference-mesh toy.obj "
          "--registration r.json\n"
          "    patina fit-texture heights.csv -o texture.json --registration r.json --name ribs\n"
          "    patina map-texture toy.obj registered.csv -o mine.obj --heights heights.csv\n"
          "    patina feel mine.obj --texture 1=texture.json --path tip-ribs.csv -o forces.csv\n"
          "    patina gui workspace\n";
  return text;
}

} // namespace patina
