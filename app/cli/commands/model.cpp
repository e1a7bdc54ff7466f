#include <array>
#include <functional>
#include <map>

#include "app/cli/commands/commands.h"
#include "app/cli/output/mesh_output.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/numbers.h"
#include "field/surface/models.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/mesh_unit.h"
#include "geometry/mesh/shapes.h"

namespace patina::cli {

namespace {

// Sizes by name: metres or counts.
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

// Counts have a lower bound that keeps the model a closed surface, and an upper one that keeps it
// in memory.
bool isCount(const std::string& key) {
  return key == "frequency" || key == "around" || key == "across" || key == "along" ||
         key == "cells" || key == "resolution";
}

struct ModelOptions {
  std::string name;
  std::filesystem::path output;
  MeshUnit unit = MeshUnit::mm;
  Sizes sizes; // those given
};

std::string namesOf(const std::vector<std::pair<std::string, double>>& sizes) {
  std::string text;
  for (const auto& [key, value] : sizes) text += (text.empty() ? "--" : " --") + key;
  return text;
}

const Model& modelNamed(const std::string& name) {
  std::string known;
  for (const Model& model : models()) {
    if (model.name == name) return model;
    known += " " + model.name;
  }
  throw Error("model: there is no '" + name + "'; there are" + known);
}

int runModel(const ModelOptions& options, Console& console) {
  const Model& model = modelNamed(options.name);
  Sizes sizes(model.sizes.begin(), model.sizes.end());
  for (const auto& [key, value] : options.sizes) {
    if (!sizes.contains(key))
      throw Error("model: the " + model.name + " has no --" + key + "; it has " +
                  namesOf(model.sizes));
    sizes[key] = value;
  }
  requireMeshOutput(options.output, options.unit);
  const TriangleMesh mesh = model.make(sizes);
  console.progress().throwIfCancelled();
  const Box3 box = bounds(mesh);
  const MeshReport report = inspect(mesh);
  writeMeshIn(options.output, mesh, options.unit);

  Json json = Json::object();
  json.set("model", model.name);
  json.set("triangles", report.triangles);
  json.set("vertices", report.vertices);
  json.set("bounds", Json(Json::Array{vectorJson(box.min()), vectorJson(box.max())}));
  json.set("unit", std::string(name(options.unit)));
  json.set("watertight", report.watertight);
  console.report(json, aligned({{"model", model.name},
                                {"triangles", formatCount(report.triangles)},
                                {"watertight", report.watertight ? "yes" : "no"},
                                {"written in", std::string(name(options.unit))}}));
  return kDone;
}

} // namespace

Command modelCommand() {
  auto options = std::make_shared<ModelOptions>();
  Command command;
  command.name = "model";
  command.summary = "write one of the program's own test objects as a mesh";
  std::string list;
  std::map<std::string, std::string> users; // size -> "sphere 50 mm, torus 40 mm"
  for (const Model& model : models()) {
    list += (list.empty() ? "" : "; ") + model.name + " (" + model.what + ")";
    for (const auto& [key, value] : model.sizes)
      users[key] += (users[key].empty() ? "" : ", ") + model.name + " " +
                    (isCount(key) ? formatNumber(value) : formatLength(value));
  }
  command.description = "NAME is one of: " + list +
                        ".\nSizes that the model does not have are an error. The same words give "
                        "the same mesh.\nJSON: model, triangles, vertices, bounds [m], unit, "
                        "watertight.";
  command.examples = {"patina model vase -o vase.ply --height 120mm --wall 2mm",
                      "patina model sphere -o sphere.obj --radius 30mm --frequency 71"};
  command.arguments.push_back(
      {"NAME", "NAME", "Which model.", "", true, false, [options](const auto& text) {
         (void)modelNamed(text);
         options->name = text;
       }});
  command.output("MESH", "Mesh file (.obj .ply .stl).", options->output);
  for (const auto& [key, text] : users) {
    const bool counts = isCount(key);
    command.arguments.push_back(
        {"--" + key, counts ? "N" : "LENGTH", counts ? "How fine." : "Size [m].", text, false,
         false, [options, key, counts](const std::string& word) {
           double value = 0;
           if (counts) {
             const auto number = parseNumber(word);
             if (!number || *number != static_cast<int>(*number) || *number < 1 || *number > 2000)
               throw Error("'" + word + "' is not a whole number from 1 to 2000");
             value = *number;
           } else {
             value = parseLength(word);
             if (!(value > 0)) throw Error("'" + word + "' is not a positive length");
           }
           options->sizes[key] = value;
         }});
  }
  addUnitOfOutput(command, options->unit);
  command.run = [options](Console& console) { return runModel(*options, console); };
  return command;
}

} // namespace patina::cli
