// Links grainray::neighbors only: four points on a line, each within reach of the next.
#include <cstdio>
#include <vector>

#include <grainray/neighbors.hpp>

int main() {
    const std::vector<float> xyz{0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0};
    grainray::NeighborSearch search;
    grainray::NeighborList list;
    search.find(grainray::Points::xyz(xyz.data(), 4, 0.6f), list);

    std::printf("%zu rows, %zu neighbours, found by %s\n", list.rows(), list.neighbors.size(), search.backend().c_str());
    const std::vector<std::uint32_t> expected{1, 0, 2, 1, 3, 2};
    return list.neighbors.to_host() == expected ? 0 : 1;
}
