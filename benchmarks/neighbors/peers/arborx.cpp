// Compiled by the compiler that Kokkos wants: C++, or nvcc where Kokkos was built for CUDA.
#include <ArborX.hpp>
#include <detail/ArborX_NeighborList.hpp>

#include <algorithm>
#include <memory>

#include "peers.hpp"

namespace {

using Space = Kokkos::DefaultExecutionSpace;
using Memory = Space::memory_space;
using Point = ArborX::Point<3, float>;
using Sphere = ArborX::Sphere<3, float>;
template <class T>
using Array = Kokkos::View<T*, Memory>;

/// A sphere of each point's reach meets all the others.
struct Asked {
    Array<Sphere> spheres;
};

struct NotItself {
    template <class Predicate, class Value, class Output>
    KOKKOS_FUNCTION void operator()(const Predicate& asked, const Value& value, const Output& output) const {
        if (static_cast<int>(value.index) != ArborX::getData(asked)) output(static_cast<int>(value.index));
    }
};

}  // namespace

template <>
struct ArborX::AccessTraits<Asked> {
    using memory_space = Memory;
    static KOKKOS_FUNCTION std::size_t size(const Asked& a) { return a.spheres.size(); }
    static KOKKOS_FUNCTION auto get(const Asked& a, std::size_t i) { return ArborX::intersects(a.spheres(i)); }
};

namespace {

struct Search {
    Space space;
    Array<Point> points;
    Array<Sphere> spheres;
    Array<int> offsets{"offsets", 0}, neighbors{"neighbors", 0};
    float radius;  ///< 0: the reaches differ

    explicit Search(const grainray::cli::Cloud& cloud) : points("points", cloud.size()), spheres("spheres", cloud.size()) {
        const auto p = Kokkos::create_mirror_view(points);
        const auto s = Kokkos::create_mirror_view(spheres);
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            p(i) = Point{cloud.xyz[3 * i], cloud.xyz[3 * i + 1], cloud.xyz[3 * i + 2]};
            s(i) = Sphere{p(i), cloud.reach[i]};
        }
        Kokkos::deep_copy(points, p);
        Kokkos::deep_copy(spheres, s);
        radius = cloud.ratio > 1 ? 0 : 2 * cloud.reach.front();
    }

    std::uint64_t run() {
        if (radius > 0) {
            ArborX::Experimental::findFullNeighborList(space, points, radius, offsets, neighbors);
        } else {
            const ArborX::BoundingVolumeHierarchy tree(space, ArborX::Experimental::attach_indices(spheres));
            tree.query(space, ArborX::Experimental::attach_indices<int>(Asked{spheres}), NotItself{}, neighbors, offsets);
        }
        space.fence();
        return neighbors.size();
    }

    void build() {
        if (radius > 0) ArborX::BoundingVolumeHierarchy tree(space, ArborX::Experimental::attach_indices(points));
        else ArborX::BoundingVolumeHierarchy tree(space, ArborX::Experimental::attach_indices(spheres));
        space.fence();
    }
};

}  // namespace

namespace grainray::peers {

Device arborx_device() { return Kokkos::SpaceAccessibility<Kokkos::HostSpace, Memory>::accessible ? Device::cpu : Device::cuda; }

cli::Contender arborx(const cli::Cloud& cloud) {
    static const Kokkos::ScopeGuard kokkos;
    const auto search = std::make_shared<Search>(cloud);
    return {"arborx", [search] { return search->run(); }, {}, [search] { search->build(); }, false, {}};
}

}  // namespace grainray::peers
