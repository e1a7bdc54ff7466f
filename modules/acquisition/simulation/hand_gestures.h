// Motions of a hand beside the strokes of a scan: slow, fast, turning, tapping and stopping. They
// are in closed form, so that streams and truth follow from them without a filter.
#pragma once

#include "acquisition/simulation/simulated_hand.h"

namespace patina {

enum class HandGesture {
  slow,    // sways of 40 mm below 0.4 Hz
  fast,    // sways of 60 mm up to 2 Hz, which turn by 0.4 rad
  turning, // turns of about a radian in a quarter of a second, with pauses
  tapping, // three taps a second; each stops within milliseconds, at about 50 m/s^2
  stopping // 0.4 m/s to rest within 20 ms, again and again
};
inline constexpr HandGesture kHandGestures[] = {HandGesture::slow, HandGesture::fast,
                                                HandGesture::turning, HandGesture::tapping,
                                                HandGesture::stopping};
const char* nameOf(HandGesture gesture);

// Returns a hand that moves so; its surface is the plane z = 0.
SimulatedHand gesture(HandGesture kind, std::uint32_t seed, double seconds = 10);

} // namespace patina
