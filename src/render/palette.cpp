#include "render/palette.hpp"

#include <array>

namespace grainray::picture {

namespace {

constexpr Color rgb(std::uint32_t hex) {
    return {static_cast<float>(hex >> 16 & 255) / 255, static_cast<float>(hex >> 8 & 255) / 255, static_cast<float>(hex & 255) / 255};
}

// Viridis at equal steps; between them a straight line is closer than an eye can tell. Its first tenth is left out: too
// dark to show the form of a sphere, and particles at rest would all be there.
constexpr std::array<Color, 9> scale{rgb(0x440154), rgb(0x472d7b), rgb(0x3b528b), rgb(0x2c728e), rgb(0x21918c),
                                     rgb(0x28ae80), rgb(0x5ec962), rgb(0xaddc30), rgb(0xfde725)};

// Distinct also for colour-blind readers: the palette of Okabe and Ito with two greys added.
constexpr std::array<Color, 9> kinds{rgb(0x0072b2), rgb(0xe69f00), rgb(0x009e73), rgb(0xd55e00), rgb(0x56b4e9),
                                     rgb(0xcc79a7), rgb(0xf0e442), rgb(0x8c8c8c), rgb(0x4d4d4d)};

}  // namespace

Color scale_color(float t) {
    const float at = mix(0.1f, 1.f, std::clamp(t, 0.f, 1.f)) * (scale.size() - 1);
    const std::size_t k = std::min(static_cast<std::size_t>(at), scale.size() - 2);
    return mix(scale[k], scale[k + 1], at - static_cast<float>(k));
}

Color kind_color(std::size_t k) { return kinds[k % kinds.size()]; }
std::size_t kind_colors() { return kinds.size(); }

}  // namespace grainray::picture
