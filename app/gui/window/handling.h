// What the left button does in the 3D view.
#pragma once

namespace patina {

enum class Handling { navigate, feel, press, paint, pick };

} // namespace patina
