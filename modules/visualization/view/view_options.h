// What a picture shows and from where: the words of `patina render --show` and `--view`.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "visualization/values/paint_quantity.h"

namespace patina {

enum class Layer : std::uint8_t {
  mesh,      // the surface as it was read
  iso,       // the iso-surface of the field
  slice,     // a plane through the field, coloured by distance, with its scalar bar
  band,      // where offset or magnet act: a shell (not over stability), a tint of the slice
  extent,    // the box of the grid
  tip,       // the tool, its true tip, the contact point and the force
  nodes,     // the field's nodes near the tip (K26)
  stability, // K*/K as colour on the surface, in the place of mesh; see stability_layer.h
  wireframe, // edges of the mesh and of the iso-surface
  scale,     // a bar of a round length
  // What was painted, on the surface and (material) on the slice. One is shown at a time: the last
  // of these that is on, under stability.
  color,        // in the objects' colours; with relief seen as relief
  relief,       // its height as colour
  first_channel // and the others of kChannels after it: as felt, paint over the scene's own
};

// "mesh,slice,band". Throws Error naming the choices.
std::set<Layer> parseLayers(std::string_view text);
std::string_view name(Layer layer);
const std::vector<Layer>& allLayers();

// The paint that a layer shows; nullopt for those that show none.
std::optional<PaintQuantity> paintOf(Layer layer);
Layer layerOf(PaintQuantity quantity);

enum class ViewPreset : std::uint8_t { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z, iso };

// "+x" (the camera stands on the +x side and looks along -x) ... "iso". Throws Error naming the
// choices.
ViewPreset parseView(std::string_view text);
std::string_view name(ViewPreset view);
const std::vector<ViewPreset>& allViews();

} // namespace patina
