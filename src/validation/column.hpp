// The column collapse that LAMMPS and LIGGGHTS ran too (benchmarks/peers): scenes and histories.
#pragma once

#include "grainray/simulation.hpp"
#include "validation/deposit.hpp"

namespace grainray::validation {

struct Column {
    int nx, ny, nz;        ///< lattice
    double side_friction;  ///< of the two side walls
    double radius = 0.1;   ///< m

    double spacing() const { return 2.4 * radius; }
    double width() const { return ny * spacing(); }
    Channel channel() const { return {radius, width(), nx * spacing()}; }
};

inline constexpr Column column_A{32, 10, 63, 0}, column_B{21, 23, 41, 1};

/// The stable reading of the published table: normal damping only, walls with k_t = 2/7 k_n.
Scene column_scene(const Column&, std::uint64_t seed);

}  // namespace grainray::validation
