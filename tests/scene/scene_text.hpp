// Shortest scenes the tests start from.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "grainray/scene.hpp"

namespace grainray::test {

/// Needs dt and duration; everything else has a default. Four lines.
inline const std::string minimal = "[simulation]\ndt = 1e-3\nduration = 1\n\n";
/// minimal and one material. Six lines.
inline const std::string with_grain = minimal + "[materials.grain]\n\n";

inline Scene parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return parse_scene(text, "test.toml", overrides);
}

/// What parsing throws, or "" where it throws nothing.
inline std::string parse_error(const std::string& text, const std::vector<std::string>& overrides = {}) {
    try {
        parse(text, overrides);
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

inline std::string placement_error(const Scene& scene) {
    try {
        place_particles(scene);
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

/// Smallest gap between two spheres; box: periods along the given axes.
inline double smallest_gap(const InitialState& s, const Box* box = nullptr, std::array<bool, 3> periodic = {}) {
    double gap = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < s.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            Vec3d d = s.positions[i] - s.positions[j];
            for (int axis = 0; axis < 3; ++axis)
                if (box && periodic[static_cast<std::size_t>(axis)])
                    d[axis] -= box->extent()[axis] * std::round(d[axis] / box->extent()[axis]);
            gap = std::min(gap, length(d) - s.radii[i] - s.radii[j]);
        }
    return gap;
}

}  // namespace grainray::test
