#include <nanoflann.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "peers.hpp"

namespace grainray::peers {
namespace {

struct Coordinates {
    const cli::Cloud& cloud;
    std::size_t kdtree_get_point_count() const { return cloud.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return cloud.xyz[3 * i + axis]; }
    template <class Bounds>
    bool kdtree_get_bbox(Bounds&) const { return false; }
};
using Tree = ::nanoflann::KDTreeSingleIndexAdaptor<::nanoflann::L2_Simple_Adaptor<float, Coordinates>, Coordinates, 3, std::uint32_t>;

/// Keeps what is within the sum of the two reaches; the tree is asked for the widest such sum.
struct Row {
    const cli::Cloud& cloud;
    std::uint32_t i;
    float widest;
    std::vector<std::uint32_t>& found;

    float worstDist() const { return widest * widest; }
    bool full() const { return true; }
    bool addPoint(float squared, std::uint32_t j) {
        const float sum = cloud.reach[i] + cloud.reach[j];
        if (squared < sum * sum && j != i) found.push_back(j);
        return true;
    }
};

struct Search {
    const cli::Cloud& cloud;
    Coordinates coordinates{cloud};
    Tree tree{3, coordinates};
    float largest = 0;
    std::vector<std::uint64_t> offsets;
    std::vector<std::uint32_t> neighbors;

    explicit Search(const cli::Cloud& c) : cloud(c) {
        for (const float r : cloud.reach) largest = std::max(largest, r);
    }

    std::uint64_t operator()() {
        tree.buildIndex();
        constexpr std::size_t block = 512;
        const std::size_t n = cloud.size(), blocks = (n + block - 1) / block;
        std::vector<std::vector<std::uint32_t>> found(blocks);
        offsets.assign(n + 1, 0);
        tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
            for (std::size_t i = b * block; i < std::min(n, (b + 1) * block); ++i) {
                const std::size_t before = found[b].size();
                Row row{cloud, static_cast<std::uint32_t>(i), cloud.reach[i] + largest, found[b]};
                tree.findNeighbors(row, &cloud.xyz[3 * i], {});
                offsets[i] = found[b].size() - before;
            }
        });
        std::exclusive_scan(offsets.begin(), offsets.end(), offsets.begin(), std::uint64_t{0});
        neighbors.resize(offsets[n]);
        tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
            std::copy(found[b].begin(), found[b].end(), neighbors.begin() + static_cast<std::ptrdiff_t>(offsets[b * block]));
        });
        return neighbors.size();
    }
};

}  // namespace

cli::Contender nanoflann(const cli::Cloud& cloud) {
    const auto search = std::make_shared<Search>(cloud);
    return {"nanoflann", [search] { return (*search)(); }, {}, [search] { search->tree.buildIndex(); }, false, {}};
}

}  // namespace grainray::peers
