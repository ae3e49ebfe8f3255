// The forecast of device memory: what state.hpp and the stages keep, added up for the moments when they keep most.
#include "device_memory.hpp"

#include <algorithm>
#include <numeric>

#include "state.hpp"

namespace grainray {
namespace {

// Measured in column collapses of 0.1 to 1.6 million grains on an H100 (benchmarks/results/h100.md).
constexpr double slot_share = 1.37;     ///< slots of slices over entries: a slice is as wide as its longest row
constexpr double columns = 14.8;        ///< of histories a row, most of all lists: its slice's row that touches most, and two
constexpr double contact_sides = 8.5;   ///< of a particle, when the column lands and lists are longest
constexpr double pool_share = 1.02;     ///< sizes are rounded up by up to a sixteenth
constexpr double fixed_bytes = 4e6;     ///< scratch of sorts and sums, parameters
constexpr double facet_rows = 115;      ///< bytes of a row of facets: two or three of them, their histories, its force
constexpr double near_facets = 0.15;    ///< of the particles; where more are, as many have fewer neighbours
constexpr double ray_bytes = 390;       ///< a particle: boxes, tree and slots of OptiX
constexpr double boulder = 3;           ///< mean radii from which a particle's row widens its slice

constexpr double particle = sizeof(Near) + sizeof(Far) + sizeof(Body) + sizeof(Vec3f) + sizeof(std::uint32_t);
constexpr double margin = sizeof(Near) + sizeof(Vec3f), row = sizeof(std::uint32_t) + 2 * sizeof(std::uint64_t) / 32.0;
constexpr double word = sizeof(std::uint32_t) * (1 + 1 / 32.0);   ///< an entry of a slice: partner, and a number for 32 rows
constexpr double column = sizeof(Vec3f) * (1 + 1 / 64.0);         ///< of a row, with its share of the spare ones
constexpr double search = 16 + 32 + 117 + 12 + 8;                 ///< points; cells; table of what is found, left over; row starts
constexpr double entry = sizeof(std::uint32_t) + sizeof(Vec3f);   ///< of a list that is not in slices

/// Slots of rows that the small ones around a large particle fill, 32 rows wide. Twice as many are near as touch.
double boulder_slots(const std::vector<double>& radii) {
    const double mean = std::accumulate(radii.begin(), radii.end(), 0.0) / std::max<double>(1, static_cast<double>(radii.size()));
    double slots = 0;
    for (const double r : radii)
        if (r > boulder * mean) slots += 32 * 2 * 3 * (1 + r / mean) * (1 + r / mean);
    return slots;
}

double surface_bytes(const Scene& scene, double particles, double triangles, double nodes) {
    if (scene.meshes.empty() && !scene.terrain) return 0;
    return triangles * (sizeof(Triangle) + 4 * sizeof(std::uint32_t)) + nodes * sizeof(double) + particles * (2 * sizeof(std::uint32_t) + 2 * near_facets * facet_rows);
}

double sum(const std::vector<MemoryPart>& parts) {
    return std::accumulate(parts.begin(), parts.end(), 0.0, [](double s, const MemoryPart& p) { return s + p.bytes; });
}

}  // namespace

std::vector<MemoryPart> forecast_device_memory(const Scene& scene, double n, const std::vector<double>& radii, const std::string& backend,
                                               double triangles, double nodes) {
    const double wide = boulder_slots(radii);
    const bool periodic = scene.domain.periodic[0] || scene.domain.periodic[1] || scene.domain.periodic[2];
    const double planes = scene.planes.empty() ? 1 : 2;  // list and the one before
    const std::vector<MemoryPart> always{{"particles", n * (particle + margin)},
                                         {"planes", n * planes * (sizeof(std::uint64_t) + 0.2 * entry)},
                                         {"meshes and terrain", surface_bytes(scene, n, triangles, nodes)},
                                         {"rays", backend == "rays" || backend == "rays-published" ? n * ray_bytes : 0},
                                         {"fixed", fixed_bytes}};
    const double touching = n * (sizeof(std::uint64_t) + 0.5 * contact_sides * entry), index = n * sizeof(std::uint32_t);
    const std::vector<MemoryPart> lists{{"lists", n * (row + planned_entries * slot_share * word + columns * column) + wide * (word + sizeof(Vec3f))}};
    // The moments: the new list is there and the histories of the old one still are; the search; a step.
    const std::vector<std::vector<MemoryPart>> moments{
        {lists[0], {"histories carried over", touching + index}},
        {{"histories carried over", touching + index}, {"search", n * (search + sizeof(std::uint32_t) * planned_entries)}},
        {lists[0], {"next state", n * (sizeof(Near) + sizeof(Body) + (periodic ? sizeof(Far) : 0))}}};
    const auto most = std::max_element(moments.begin(), moments.end(), [](const auto& a, const auto& b) { return sum(a) < sum(b); });
    std::vector<MemoryPart> parts = always;
    parts.insert(parts.begin() + 1, most->begin(), most->end());
    for (MemoryPart& part : parts) part.bytes *= pool_share;
    std::erase_if(parts, [](const MemoryPart& part) { return part.bytes == 0; });
    return parts;
}

}  // namespace grainray
