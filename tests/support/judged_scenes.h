// All scenes for the comparison of contact methods: generated ones, and shared meshes if present.
#pragma once

#include <filesystem>
#include <utility>

#include "app/studies/contact/scenes.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/mesh_unit.h"
#include "support/shared_data.h"

namespace patina::test {

inline std::vector<ContactScene> judgedScenes() {
  std::vector<ContactScene> scenes = contactScenes();
  const auto add = [&](const std::string& name, std::vector<double> isos) {
    const std::filesystem::path path = sharedData("meshes/" + name + ".obj");
    if (std::filesystem::exists(path))
      scenes.push_back(
          {name, {inMetres(cleaned(readMesh(path)).mesh, MeshUnit::fit).mesh}, std::move(isos)});
  };
  add("goathead", {0, 1e-3, 2e-3});
  add("boat", {1e-3, 2e-3}); // masts and hull are thinner than a voxel
  return scenes;
}

} // namespace patina::test
