// What a fit says of itself, in a line for the panel.
#pragma once

#include <QString>

#include "acquisition/registration/register_path.h"

namespace patina {

// Why the path may lie elsewhere; empty: it is sure.
QString doubtWords(const Registration& found);
QString fitWords(const Registration& found);

} // namespace patina
