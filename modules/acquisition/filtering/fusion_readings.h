// Readings of the probe for the fused path: streams merged, averaged over windows, and the motion
// about which its first pass is linearised.
#pragma once

#include "acquisition/filtering/fusion_pass.h"

namespace patina {

// Merges both streams, which share a clock; readings at one time are one. Samples and rates that
// are not finite, repeat a time or run backwards are left out.
std::vector<InertialReading> inertialReadings(const std::vector<ProbeSample>& samples,
                                              const std::vector<RateSample>& rates,
                                              const ProbeModel& probe);

// Returns means of readings over windows of 8 ms. The filter is linear about its reference, and a
// hand moves little within a window, so that coarse passes lose almost nothing (the idea of
// preintegration: Forster, Carlone, Dellaert & Scaramuzza 2017).
std::vector<InertialReading> meansOverWindows(const std::vector<InertialReading>& readings);

// Returns the camera's motion at the windows, turned by the gyroscope where the camera has gaps.
ReferenceMotion firstReference(const CameraTrack& track,
                               const std::vector<InertialReading>& windows);

} // namespace patina
