#include <algorithm>
#include <functional>
#include <map>

#include "app/cli/commands/commands.h"
#include "app/cli/framework/suggestion.h"
#include "app/cli/output/mesh_output.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/numbers.h"
#include "field/surface/models.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/mesh_unit.h"
#include "geometry/mesh/shapes.h"

namespace patina::cli {

namespace {

using Sizes = std::map<std::string, double>;

struct Model {
  std::string name;
  std::string what;
  std::vector<std::pair<std::string, double>> sizes; // with their defaults
  std::function<TriangleMesh(const Sizes&)> make;
};

int count(const Sizes& sizes, const std::string& key) {
  return static_cast<int>(sizes.at(key));
}

const std::vector<Model>& models() {
  static const std::vector<Model> list = {
      {"sphere",
       "an icosphere of 20 frequency^2 triangles",
       {{"radius", 0.05}, {"frequency", 22}},
       [](const Sizes& s) { return icosphere(s.at("radius"), count(s, "frequency")); }},
      {"torus",
       "about the z axis",
       {{"radius", 0.04}, {"tube", 0.015}, {"around", 128}, {"across", 64}},
       [](const Sizes& s) {
         return torus(s.at("radius"), s.at("tube"), count(s, "around"), count(s, "across"));
       }},
      {"box",
       "centred",
       {{"width", 0.06}, {"depth", 0.05}, {"height", 0.04}, {"cells", 8}},
       [](const Sizes& s) {
         return box({s.at("width"), s.at("depth"), s.at("height")}, count(s, "cells"));
       }},
      {"plate",
       "a thin box",
       {{"width", 0.1}, {"depth", 0.1}, {"thickness", 0.001}, {"cells", 8}},
       [](const Sizes& s) {
         return box({s.at("width"), s.at("depth"), s.at("thickness")}, count(s, "cells"));
       }},
      {"vase",
       "thin-walled, closed",
       {{"height", 0.12}, {"wall", 0.004}, {"around", 48}, {"along", 25}},
       [](const Sizes& s) {
         return vase(s.at("height"), s.at("wall"), count(s, "around"), count(s, "along"));
       }},
      {"galleon",
       "a ship of thin sheets, open and non-manifold on purpose",
       {{"length", 0.1}},
       [](const Sizes& s) { return galleon(s.at("length")); }},
      {"dinosaur",
       "a toy, 100 mm long, a smooth union of capsules",
       {{"resolution", 200}},
       [](const Sizes& s) { return dinosaur(count(s, "resolution")); }},
  };
  return list;
}

// Counts have a lower bound that keeps the model closed, and an upper bound for memory.
bool isCount(const std::string& key) {
  return key == "frequency" || key == "around" || key == "across" || key == "along" ||
         key == "cells" || key == "resolution";
}

struct ModelOptions {
  std::string name;
  std::filesystem::path output;
  MeshUnit unit = MeshUnit::mm;
  Sizes sizes; // given sizes
};

const Model& modelNamed(const std::string& name) {
  const auto found = std::ranges::find(models(), name, &Model::name);
  if (found != models().end()) return *found;
  const std::vector<std::string> known = namesIn(models(), &Model::name);
  throw Error("unknown model '" + name + "'" + suggestion(name, known, ".") +
              " There are: " + joined(known));
}

const Keys kModelKeys = {{"model", "", "model"},
                         {"triangles", "", "triangles"},
                         {"vertices", "", "vertices", "", Shown::never},
                         {"bounds", "m", "bounds", "lowest and highest corner", Shown::never},
                         {"watertight", "", "watertight"},
                         {"unit", "", "written in"}};

int runModel(const ModelOptions& options, Console& console) {
  const Model& model = modelNamed(options.name);
  Sizes sizes(model.sizes.begin(), model.sizes.end());
  for (const auto& [key, value] : options.sizes) {
    if (!sizes.contains(key))
      throw Error("model: the " + model.name + " has no --" + key + "; it has --" +
                  joined(namesIn(model.sizes, [](const auto& size) { return size.first; }), " --"));
    sizes[key] = value;
  }
  requireMeshOutput(options.output, options.unit);
  const TriangleMesh mesh = model.make(sizes);
  console.progress().throwIfCancelled();
  const Box3 box = bounds(mesh);
  const MeshReport counts = inspect(mesh);
  writeMeshIn(options.output, mesh, options.unit);

  Report report(kModelKeys);
  report.set("model", model.name);
  report.set("triangles", counts.triangles).set("vertices", counts.vertices);
  report.set("bounds", Json(Json::Array{vectorJson(box.min()), vectorJson(box.max())}));
  report.set("watertight", counts.watertight).set("unit", std::string(name(options.unit)));
  return console.report(report);
}

Argument sizeArgument(const std::string& key, const std::string& users, Sizes& sizes) {
  const auto set = [&sizes, key](double value) { sizes[key] = value; };
  if (isCount(key))
    return {"--" + key, "N", "", users, "How fine.", inRange(1, 2000, set, NumberKind::whole)};
  return {"--" + key, "LENGTH", "m", users, "Size.", [set](const std::string& word) {
            const double value = parseLength(word);
            if (!(value >= 1e-9 && value <= 1e6))
              throw Error("'" + word + "' is no length from a nanometre to 1000 km");
            set(value);
          }};
}

} // namespace

Command modelCommand() {
  auto options = std::make_shared<ModelOptions>();
  std::vector<std::string> list;
  std::map<std::string, std::string> users; // size -> "sphere 50 mm, torus 40 mm"
  for (const Model& model : models()) {
    list.push_back(model.name + " (" + model.what + ")");
    for (const auto& [key, value] : model.sizes)
      users[key] += (users[key].empty() ? "" : ", ") + model.name + " " +
                    (isCount(key) ? formatNumber(value) : formatLength(value));
  }
  Command command{
      .name = "model",
      .summary = "write one of the program's own test objects as a mesh",
      .description =
          "NAME is one of: " + joined(list, "; ") +
          ".\n"
          "Sizes that the model does not have are an error. The same options give the same mesh.",
      .examples = {"patina model vase -o vase.ply --height 120mm --wall 2mm",
                   "patina model sphere -o sphere.obj --radius 30mm --frequency 71"},
      .keys = kModelKeys,
      .arguments = {input("NAME", "Which model.",
                          [options](const std::string& text) {
                            options->name = modelNamed(text).name;
                          }),
                    outputTo(options->output, "MESH", "Mesh file (.obj .ply .stl).")},
      .run = [options](Console& console) { return runModel(*options, console); }};
  for (const auto& [key, text] : users)
    command.arguments.push_back(sizeArgument(key, text, options->sizes));
  command.arguments.push_back(unitOfOutput(options->unit));
  return command;
}

} // namespace patina::cli
