// What a search back end is: it takes packed points and fills lists. One registry row and one CMake line add another.
#pragma once

#include <memory>

#include "grainray/neighbors.hpp"
#include "neighbors/pair_test.hpp"

namespace grainray::neighbors {

/// Points packed, checked and wrapped into the periodic box: the same numbers for every back end. What the caller has in this form
/// already stays where it is.
struct Packed {
    explicit Packed(Device device) : copied_spheres(device), copied_ids(device) {}
    View<const Sphere> spheres;
    View<const std::uint32_t> ids;
    Array<Sphere> copied_spheres;
    Array<std::uint32_t> copied_ids;
    float min_reach = 0, mean_reach = 0, max_reach = 0;
    Vec3f lower{}, upper{};  ///< bounds of the centres
    std::size_t size() const { return spheres.size; }
};

struct Request {
    ListKind kind;
    std::uint32_t block;
    bool ascending, local_order;
    Vec3f lower, period;
    std::size_t most_entries = ~std::size_t{0};  ///< longer lists stay without rows, where that is known before they are filled
    bool periodic() const { return period.x > 0 || period.y > 0 || period.z > 0; }
};

class Backend {
public:
    virtual ~Backend() = default;
    virtual void pairs(const Packed& points, const Request&, NeighborList&) = 0;
    virtual void queries(const Packed& queries, const Packed& points, const Request&, NeighborList&) = 0;
    virtual std::size_t memory_bytes() const = 0;
    /// Gives back what every search makes anew.
    virtual void release() {}
    /// What a reader of its times should know; empty: nothing.
    virtual std::string note() const { return {}; }
};

/// Points that a search by cells looks at.
struct Effort {
    double mean = 0, most = 0;  ///< for one point: on average, and for the one with most
};

/// Whether a back end works here, and one sentence: what it runs on, or why it is off and what to do.
struct Status {
    bool available;
    std::string reason;
};

/// Packs caller's points; throws InputError naming the first bad one. `what` is "point" or "query".
using PackFunction = void (*)(const Points&, const Request&, const char* what, Packed&);

}  // namespace grainray::neighbors

namespace grainray::cpu {
void pack_points(const Points&, const neighbors::Request&, const char* what, neighbors::Packed&);
neighbors::Effort cells_effort(const neighbors::Packed& asking, const neighbors::Packed& points, bool of_queries, const neighbors::Request&);
std::unique_ptr<neighbors::Backend> make_brute();
std::unique_ptr<neighbors::Backend> make_cells();
std::unique_ptr<neighbors::Backend> make_embree();
std::unique_ptr<neighbors::Backend> make_embree_published();
neighbors::Status embree_status();
}  // namespace grainray::cpu

namespace grainray::cuda {
void pack_points(const Points&, const neighbors::Request&, const char* what, neighbors::Packed&);
neighbors::Effort cells_effort(const neighbors::Packed& asking, const neighbors::Packed& points, bool of_queries, const neighbors::Request&);
/// What is put into stream `second` from now on begins after what stream `first` holds now. Null: the default stream.
void order_streams(void* first, void* second);
std::unique_ptr<neighbors::Backend> make_brute();
std::unique_ptr<neighbors::Backend> make_cells();
/// False on GPUs that are known to trace rays in software; OptiX is not asked, since its start takes a second.
bool may_have_ray_cores();
std::unique_ptr<neighbors::Backend> make_optix();
std::unique_ptr<neighbors::Backend> make_optix_published();
neighbors::Status optix_status();
}  // namespace grainray::cuda
