// Every colour of the pictures, the plots and the window, in one place. sRGB, 0 .. 1.
#pragma once

#include <array>

namespace patina::palette {

using Color = std::array<double, 3>;

// VTK's setters ask for double* and only read it.
inline double* forVtk(const Color& color) {
  return const_cast<double*>(color.data());
}

inline constexpr Color kText{0.13, 0.15, 0.19}; // on light things

// What a picture stands on, and what follows from it.
struct Ground {
  Color low, high; // behind everything, at the bottom and at the top
  Color plate;     // below words; the ground is no nearer to their colour
  Color text;
  Color shaft; // of thin things with only the ground behind them
};
inline constexpr Ground kLight{
    {0.965, 0.970, 0.978}, {0.780, 0.825, 0.875}, {0.780, 0.825, 0.875}, kText, {0.28, 0.30, 0.36}};
inline constexpr Ground kDark{{0.185, 0.207, 0.243},
                              {0.098, 0.110, 0.133},
                              {0.185, 0.207, 0.243},
                              {0.90, 0.915, 0.935},
                              {0.62, 0.66, 0.72}};

inline constexpr Color kQuiet{0.45, 0.49, 0.55}; // outlines, grids

inline constexpr Color kSurface{0.68, 0.80, 0.64};
inline constexpr Color kSurfaceBack{0.50, 0.56, 0.50}; // the inner side, seen through a cut
inline constexpr Color kEdges{0.36, 0.44, 0.37};
inline constexpr Color kNoValue{0.74, 0.75, 0.77}; // of a surface whose other parts have one
inline constexpr Color kIso{0.30, 0.62, 0.78};
inline constexpr Color kOffsetBand{0.92, 0.70, 0.10};
inline constexpr Color kMagnetBand{0.80, 0.12, 0.62};

inline constexpr Color kTool{0.95, 0.55, 0.12};
inline constexpr Color kToolPale{0.87, 0.74, 0.47};
inline constexpr Color kToolShaft = kLight.shaft;
inline constexpr Color kGhost{0.45, 0.35, 0.62};
inline constexpr Color kContactPoint{0.10, 0.11, 0.14};
inline constexpr Color kForce{0.78, 0.10, 0.22};

inline constexpr Color kSlips{0.62, 0.36, 0.72}; // of the stability map

// Ends of the diverging map of distance: inside warm, outside cool.
inline constexpr Color kInside{0.706, 0.204, 0.118};
inline constexpr Color kOutside{0.130, 0.330, 0.640};

// Stations of the sequential map, from little to much; ever darker, so that it is read in grey,
// too.
inline constexpr std::array<Color, 5> kMuch{{
    {0.985, 0.945, 0.760},
    {0.640, 0.830, 0.590},
    {0.180, 0.630, 0.610},
    {0.150, 0.390, 0.600},
    {0.170, 0.130, 0.370},
}};

// Series of plots: told apart by luminance as well as hue.
inline constexpr std::array<Color, 6> kSeries{{
    {0.12, 0.36, 0.66},
    {0.84, 0.37, 0.05},
    {0.13, 0.52, 0.33},
    {0.50, 0.28, 0.60},
    {0.55, 0.41, 0.10},
    {0.10, 0.55, 0.62},
}};

} // namespace patina::palette
