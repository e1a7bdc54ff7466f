// All colours of pictures, plots and the window. sRGB, 0 .. 1.
#pragma once

#include <array>

namespace patina::palette {

using Color = std::array<double, 3>;

// VTK's setters take double* but only read it.
inline double* forVtk(const Color& color) {
  return const_cast<double*>(color.data());
}

inline constexpr Color kText{0.13, 0.15, 0.19}; // on light backgrounds

// Background of a picture and the colours that depend on it.
struct BackgroundStyle {
  Color low, high;       // background at the bottom and at the top
  Color text_background; // behind text; at least as far from its colour as the background is
  Color text;
  Color shaft;        // thin bodies in front of the background
  bool plates = true; // texts have a background of their own
};
inline constexpr BackgroundStyle kLight{
    {0.965, 0.970, 0.978}, {0.780, 0.825, 0.875}, {0.780, 0.825, 0.875}, kText, {0.28, 0.30, 0.36}};
inline constexpr BackgroundStyle kDark{{0.185, 0.207, 0.243},
                                       {0.098, 0.110, 0.133},
                                       {0.185, 0.207, 0.243},
                                       {0.90, 0.915, 0.935},
                                       {0.62, 0.66, 0.72}};

inline constexpr BackgroundStyle kWhite{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, kText, {0.28, 0.30, 0.36}};

inline constexpr Color kSecondary{0.45, 0.49, 0.55}; // outlines, grids

inline constexpr Color kSurface{0.68, 0.80, 0.64};
inline constexpr Color kSurfaceBack{0.50, 0.56, 0.50}; // inner side, visible in a cut
inline constexpr Color kEdges{0.36, 0.44, 0.37};
inline constexpr Color kNoValue{0.74, 0.75, 0.77}; // part of a surface without a value
inline constexpr Color kIso{0.30, 0.62, 0.78};
inline constexpr Color kOffsetBand{0.92, 0.70, 0.10};
inline constexpr Color kMagnetBand{0.80, 0.12, 0.62};

inline constexpr Color kTool{0.95, 0.55, 0.12};
inline constexpr Color kToolPale{0.87, 0.74, 0.47};
inline constexpr Color kToolShaft = kLight.shaft;
inline constexpr Color kGhost{0.45, 0.35, 0.62};
inline constexpr Color kContactPoint{0.10, 0.11, 0.14};
inline constexpr Color kForce{0.78, 0.10, 0.22};

inline constexpr Color kUnstable{0.62, 0.36, 0.72}; // in the stability map

// Ends of the diverging distance map: inside warm, outside cool.
inline constexpr Color kInside{0.706, 0.204, 0.118};
inline constexpr Color kOutside{0.130, 0.330, 0.640};

// Stations of the sequential map from low to high, increasingly dark, so that it works in grey.
inline constexpr std::array<Color, 5> kMuch{{
    {0.985, 0.945, 0.760},
    {0.640, 0.830, 0.590},
    {0.180, 0.630, 0.610},
    {0.150, 0.390, 0.600},
    {0.170, 0.130, 0.370},
}};

// Series of plots, distinct in luminance as well as hue.
inline constexpr std::array<Color, 6> kSeries{{
    {0.12, 0.36, 0.66},
    {0.84, 0.37, 0.05},
    {0.13, 0.52, 0.33},
    {0.50, 0.28, 0.60},
    {0.55, 0.41, 0.10},
    {0.10, 0.55, 0.62},
}};

} // namespace patina::palette
