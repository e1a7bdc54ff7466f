// Tables of probes: those of `patina sample` and of a scene's pins.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "session/compile/probe.h"

namespace patina {

// Columns of probeRow(): x, y, z, phi, direction, face, closest point, in_band; with values also
// each channel of material, relief, the colour with its cover, and the texture's height or 0.
std::vector<std::string> probeColumns(bool has_values);
std::vector<double> probeRow(const Probe& probe, bool has_values);

// Returns a pin's name, and its distance where it is off the surface: "A 0.512 mm".
std::string pinLabel(const CompiledScene& scene, const Pin& pin);

// Returns a CSV of the scene's pins: their names and the columns with values. A closest point that
// is not known, beyond the band, is NaN, unless `probe` knows it.
using ProbeOf = std::function<Probe(const Vec3& position)>;
std::string pinTable(const CompiledScene& scene, const ProbeOf& probe = {});

} // namespace patina
