// Layers and views of a picture: the words of `patina render --show` and `--view`.
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
  mesh,      // the mesh as read
  iso,       // the field's iso-surface
  slice,     // a plane through the field, coloured by distance, with its scalar bar
  band,      // offset or magnet: a shell (not with stability) and a tint of the slice
  extent,    // the box of the grid
  tip,       // the tool, its true tip, the contact point and the force
  nodes,     // the field's nodes near the tip (K26)
  stability, // K*/K as colour on the surface instead of the mesh; see stability_layer.h
  wireframe, // edges of the mesh and of the iso-surface
  scale,     // scale bar of a round length
  // Paint on the surface and (material) on the slice. The last one that is on is shown, unless
  // stability is on.
  color,        // in the objects' colours, with shaded relief
  relief,       // height as colour
  first_channel // then the other kChannels: rendered values, paint over the scene's own
};

// Parses "mesh,slice,band". Throws Error naming the choices.
std::set<Layer> parseLayers(std::string_view text);
std::string_view name(Layer layer);
const std::vector<Layer>& allLayers();

// Paint of a layer; nullopt for a layer without paint.
std::optional<PaintQuantity> paintOf(Layer layer);
Layer layerOf(PaintQuantity quantity);

enum class ViewPreset : std::uint8_t { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z, iso };

// Parses "+x" (the camera is on the +x side and looks along -x) ... "iso". Throws Error naming the
// choices.
ViewPreset parseView(std::string_view text);
std::string_view name(ViewPreset view);
const std::vector<ViewPreset>& allViews();

} // namespace patina
