// Describes a fit in a line for the panel.
#pragma once

#include <QString>

#include "scan/register_scans.h"

namespace patina {

// Returns why the pose may be wrong; empty: it is reliable.
QString warningText(const Registration& found);
QString fitWords(const Registration& found);

} // namespace patina
