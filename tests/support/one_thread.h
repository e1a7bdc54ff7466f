// Makes the calling thread do all the work itself while this lives, so that its own time covers all
// of it.
#pragma once

#include <tbb/global_control.h>

namespace patina::test {

class OneThread {
  tbb::global_control most_{tbb::global_control::max_allowed_parallelism, 1};
};

} // namespace patina::test
