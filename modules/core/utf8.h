// Text as people of any language write it.
#pragma once

#include <string_view>

namespace patina {

// Whether the bytes are well-formed UTF-8 without control characters.
bool isUtf8(std::string_view text);

} // namespace patina
