// Exact fixed-radius neighbour search. Knows no physics; needs no CUDA to compile.
//
// Every point i has a reach R_i. Points i and j are neighbours when |x_i - x_j| < R_i + R_j, evaluated in single
// precision by one predicate (src/neighbors/pair_test.hpp) that every back end shares: all return the same set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "grainray/device.hpp"

namespace grainray {

/// What is true of points. A caller who knows it spares a search a look at all points and the wait for its result.
struct Extents {
    Vec3f lower, upper;                                ///< bounds of the coordinates
    float min_reach = 0, mean_reach = 0, max_reach = 0;
};

/// Points where the caller already has them: host memory for Device::cpu, device memory for Device::cuda.
/// Coordinate a of point i is at a[i * stride], so structure-of-arrays (stride 1), float3 (3) and float4 (4) all fit.
struct Points {
    const float *x = nullptr, *y = nullptr, *z = nullptr;
    std::size_t stride = 1;
    const float* reach = nullptr;  ///< reach[i * reach_stride] >= 0; null: uniform_reach for all
    std::size_t reach_stride = 1;
    float uniform_reach = 0;
    const std::uint32_t* ids = nullptr;  ///< distinct; break ties of the owner rule; null: the index
    std::size_t size = 0;
    /// Of these points, where known; then nobody checks that coordinates and reaches are finite. Bounds that are too narrow or reaches
    /// that are not so make lists wrong.
    const Extents* extents = nullptr;

    /// Packed x y z x y z ... of n points.
    static Points xyz(const float* data, std::size_t n, float reach) { return {data, data + 1, data + 2, 3, nullptr, 1, reach, nullptr, n}; }
};

enum class ListKind {
    half,     ///< each pair once, in the row of its owner: the point with the larger (reach, id)
    full,     ///< each pair in both rows
    blocked,  ///< once where both points lie in one block of consecutive indices, else in both rows
};

struct SearchOptions {
    /// auto | brute | cells | rays (Embree on the CPU, OptiX on CUDA) | rays-published (the published algorithm, to compare)
    std::string backend = "auto";
    ListKind kind = ListKind::full;
    std::uint32_t block = 1;       ///< of ListKind::blocked
    bool ascending = true;         ///< each row in ascending order (else the order is unspecified)
    Vec3f lower{};                 ///< lower corner of the periodic box
    Vec3f period{};                ///< its length along each axis; 0: not periodic. The nearest image counts, once.
    bool local_order = false;      ///< near points have near indices: then they are looked at in that order, which is faster
    /// The caller's cudaStream_t, of Device::cuda. find() begins after what is in it, and what is put into it later begins
    /// after find(). Null: the default stream.
    void* stream = nullptr;
};

/// Row i: neighbors[offsets[i]] ... neighbors[offsets[i + 1] - 1]. No row has a cap.
struct NeighborList {
    explicit NeighborList(Device device = Device::cpu) : offsets(device), neighbors(device) {}
    Array<std::uint64_t> offsets;    ///< rows + 1
    Array<std::uint32_t> neighbors;  ///< indices of points
    std::size_t rows() const { return offsets.size() ? offsets.size() - 1 : 0; }
};

struct BackendInfo {
    std::string name;
    bool available = false;
    std::string reason;  ///< one sentence: what it runs on, or why it is off and the remedy
};

/// A reusable search; keeps its buffers from call to call. Not thread-safe; uses all threads of the CPU or one GPU.
class NeighborSearch {
public:
    /// Throws InputError: unknown back end (names the known ones), device not there, negative or not finite period.
    explicit NeighborSearch(Device = Device::cpu, SearchOptions = {});
    ~NeighborSearch();
    NeighborSearch(NeighborSearch&&) noexcept;
    NeighborSearch& operator=(NeighborSearch&&) noexcept;

    /// Neighbours among the points themselves; a point is never its own neighbour, duplicates are neighbours.
    /// Throws InputError naming the first point with a NaN, infinite coordinate or a negative reach.
    void find(const Points& points, NeighborList& list);
    /// For each query q the points j with |q - x_j| < R_q + R_j. `kind` does not apply.
    void find(const Points& queries, const Points& points, NeighborList& list);

    /// The back end of the last find() and why.
    const std::string& backend() const;
    const std::string& reason() const;
    const SearchOptions& options() const;
    void set_block(std::uint32_t block);
    /// Lists of points that would have more entries than this stay without rows, list.rows() is 0, where that is known before memory for
    /// them is taken (everywhere but with OptiX). To begin with there is no limit.
    void set_most_entries(std::size_t most);
    std::size_t memory_bytes() const;
    /// Gives back what every find() makes anew; the next one costs as much more as allocating does.
    void release();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The back ends of a device, built in or not.
std::vector<BackendInfo> search_backends(Device);

}  // namespace grainray
