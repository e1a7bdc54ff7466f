#include "acquisition/filtering/contact.h"

#include <stdexcept>

namespace patina {

void markContact(std::vector<PathSample>& path, const ContactLimits& limits) {
  if (!(limits.off <= limits.on))
    throw std::invalid_argument("markContact: contact must end at no more than it begins at");
  bool touching = false;
  std::size_t since = 0; // first sample with the force beyond the limit that ends the present state
  bool beyond = false;
  for (std::size_t i = 0; i < path.size(); ++i) {
    path[i].touching = touching;
    const bool now = touching ? path[i].force < limits.off : path[i].force > limits.on;
    if (now && !beyond) since = i;
    beyond = now;
    if (!beyond || path[i].t - path[since].t < limits.shortest) continue;
    touching = !touching;
    for (std::size_t k = since; k <= i; ++k) path[k].touching = touching;
    beyond = false;
  }
}

std::vector<ContactInterval> contactIntervals(const std::vector<PathSample>& path,
                                              double longest_pause) {
  std::vector<ContactInterval> stretches;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!path[i].touching) continue;
    const bool goes_on = i > 0 && !stretches.empty() && stretches.back().end == i &&
                         path[i].t - path[i - 1].t <= longest_pause;
    if (goes_on)
      stretches.back().end = i + 1;
    else
      stretches.push_back({i, i + 1});
  }
  return stretches;
}

} // namespace patina
