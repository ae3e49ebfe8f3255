// The neighbour search alone: how many neighbours the points of a cubic lattice have.
// Inside there are 6, on a face 5, on an edge 4, at a corner 3, and the numbers of such points are known.
#include <cstdio>
#include <map>
#include <vector>

#include <grainray/neighbors.hpp>

int main() {
    constexpr std::size_t side = 30;
    std::vector<float> xyz;
    for (std::size_t k = 0; k < side; ++k)
        for (std::size_t j = 0; j < side; ++j)
            for (std::size_t i = 0; i < side; ++i)
                for (const std::size_t a : {i, j, k}) xyz.push_back(static_cast<float>(a));
    const std::size_t n = xyz.size() / 3;

    grainray::NeighborSearch search;
    grainray::NeighborList list;
    search.find(grainray::Points::xyz(xyz.data(), n, 0.6f), list);  // |x_i - x_j| < 1.2

    std::map<std::uint64_t, std::size_t> histogram;
    const auto offsets = list.offsets.view();
    for (std::size_t i = 0; i < list.rows(); ++i) ++histogram[offsets[i + 1] - offsets[i]];

    std::printf("%zu points, %zu entries, found by %s\n", n, list.neighbors.size(), search.backend().c_str());
    for (const auto& [neighbors, points] : histogram)
        std::printf("%llu neighbours: %zu points\n", static_cast<unsigned long long>(neighbors), points);

    constexpr std::size_t inner = side - 2;
    const std::map<std::uint64_t, std::size_t> expected{{3, 8}, {4, 12 * inner}, {5, 6 * inner * inner}, {6, inner * inner * inner}};
    if (histogram == expected) return 0;
    std::printf("wrong: a lattice has other numbers\n");
    return 1;
}
