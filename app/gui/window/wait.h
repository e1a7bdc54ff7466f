// Waiting in the thread of the window, which goes on handling its events.
#pragma once

#include <functional>

namespace patina {

// False after the time is up. `done` is asked after each event and every few milliseconds; in
// between the thread sleeps, which leaves the processor to those it waits for.
bool waitUntil(const std::function<bool()>& done, int milliseconds);
void wait(int milliseconds);

} // namespace patina
