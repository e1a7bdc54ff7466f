// What of a profile is texture where a probe was drawn over it. Heights are found by time, from
// acceleration and a camera: an error lasts some tenths of a second, and is as long a wave as the
// tip goes in them. Where it lands, turns or lifts it hardly goes, and the error is a spike.
#pragma once

#include <vector>

namespace patina {

// The slow course of heights `step` apart [m], through those of weight 1 and past those of weight
// 0, which may be anything: cubic splines with the least sum of squared misses and third
// differences. A wave of wavelength l is 1 / (1 + (length / l)^6) of itself in it; a parabola
// whole, up to the ends. Weights: not negative, three apart above 0.
std::vector<double> courseOf(const std::vector<double>& heights, const std::vector<double>& weights,
                             double step, double length);

// Between 0 and 1, how far heights are known by the speed at which each was drawn over: 1/2 at a
// quarter of their median, as the noise of heights' squares grows with its cube. Throws Error where
// the tip stands on half of them or more.
std::vector<double> weightsBySpeed(const std::vector<double>& speeds);

// Heights without their course beyond `cutoff` [m], each by its weight: what is not known is no
// texture, and what lies on both sides of it is joined by the course.
std::vector<double> drawnHeights(const std::vector<double>& heights,
                                 const std::vector<double>& speeds, double step, double cutoff);

} // namespace patina
