// From what rays found to rows of a list.
#pragma once

#include "neighbors/backend.hpp"
#include "neighbors/rays/slots.hpp"

namespace grainray::neighbors::rays {

enum class Reported {
    once,     ///< each pair by one of its two points
    twice,    ///< each pair by both
    queries,  ///< rays are queries; the kind of list does not apply
};

/// Box p is point order[p], and so is source p, unless sources are queries. `points` decide who owns a pair where the kind of
/// list asks.
struct Rows {
    Slots slots;
    View<const std::uint32_t> order;
    View<const Sphere> points;
    View<const std::uint32_t> ids;
    // Set on the device where entries must be tested once more, and with what: OptiX programs flush the squares of distances
    // below 1e-19 to zero.
    View<const std::uint32_t> doubtful;
    View<const Sphere> sources, boxes;
    Vec3f period;
};

/// Kept from call to call.
struct RowsMemory {
    explicit RowsMemory(Device device) : own(device), others(device), ranks(device) {}
    Array<std::uint32_t> own;     ///< by point: entries of its row that its own ray found; they stand first
    Array<std::uint32_t> others;  ///< by point: the other entries
    Array<std::uint32_t> ranks;   ///< by slot: its place among the others of the other point's row
    std::size_t bytes() const { return own.bytes() + others.bytes() + ranks.bytes(); }
};

}  // namespace grainray::neighbors::rays

namespace grainray::cpu {
void make_rows(const neighbors::rays::Rows&, neighbors::rays::Reported, const neighbors::Request&, neighbors::rays::RowsMemory&, NeighborList&);
}
namespace grainray::cuda {
void make_rows(const neighbors::rays::Rows&, neighbors::rays::Reported, const neighbors::Request&, neighbors::rays::RowsMemory&, NeighborList&);
}
