// The function of the left button in the 3D view.
#pragma once

namespace patina {

enum class InteractionMode { navigate, feel, press, paint, pick, measure, pin };

} // namespace patina
