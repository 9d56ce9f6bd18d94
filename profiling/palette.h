// profiling/palette.h - one colour per kernel name, the same in every picture.
#pragma once
#include <string_view>

namespace skred {

struct KernelColour {
  std::string_view hex;       // "#rrggbb"
  std::string_view trace;     // nearest of the colour names that chrome://tracing knows
};

// Kernels of one part of the step share a hue: collision detection blue, forces orange, motion green, the nonsmooth solver
// purple. Within a hue they differ in lightness, so the parts and the kernels can be told apart without seeing colour. The
// hues are those of Okabe and Ito 2008, "Color Universal Design". A name that is not listed gets a colour by its hash.
KernelColour kernel_colour(std::string_view kernel);

}  // namespace skred
