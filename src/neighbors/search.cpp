// NeighborSearch and the registry of back ends.
#include <array>
#include <cmath>
#include <map>

#include "neighbors/backend.hpp"

namespace grainray {
namespace {

using Factory = std::unique_ptr<neighbors::Backend> (*)();

/// The registry: one row a back end, with how to make it on each device and whether it works here.
struct Row {
    const char* name;
    Factory cpu, cuda;
    neighbors::Status (*cpu_status)();
    neighbors::Status (*cuda_status)();
};

neighbors::Status always() { return {true, "ready"}; }
neighbors::Status where_cuda() { return {cuda_available(), cuda_available() ? "ready" : cuda_status()}; }

#ifdef GRAINRAY_HAS_CUDA
#define GRAINRAY_ON_CUDA(function) cuda::function
#else
#define GRAINRAY_ON_CUDA(function) nullptr
#endif
#ifdef GRAINRAY_HAS_OPTIX
#define GRAINRAY_ON_OPTIX(function) cuda::function
neighbors::Status rays_on_cuda() { return cuda_available() ? cuda::optix_status() : where_cuda(); }
#else
#define GRAINRAY_ON_OPTIX(function) nullptr
neighbors::Status rays_on_cuda() {
    if (!cuda_available()) return where_cuda();
    return {false, "this build has no OptiX: its headers were not there when it was configured; set OptiX_ROOT to their folder and build again"};
}
#endif

constexpr std::array registry{
    Row{"brute", cpu::make_brute, GRAINRAY_ON_CUDA(make_brute), always, where_cuda},
    Row{"cells", cpu::make_cells, GRAINRAY_ON_CUDA(make_cells), always, where_cuda},
    Row{"rays", cpu::make_embree, GRAINRAY_ON_OPTIX(make_optix), cpu::embree_status, rays_on_cuda},
    Row{"rays-published", cpu::make_embree_published, GRAINRAY_ON_OPTIX(make_optix_published), cpu::embree_status, rays_on_cuda},
};

/// Below this many points all pairs are tested faster than cells are sorted.
constexpr std::size_t brute_is_faster_below = 256;

Factory factory(const Row& row, Device device) { return device == Device::cpu ? row.cpu : row.cuda; }
neighbors::Status status(const Row& row, Device device) { return device == Device::cpu ? row.cpu_status() : row.cuda_status(); }

std::string known_names() {
    std::string names = "auto";
    for (const Row& row : registry) names += std::string(", ") + row.name;
    return names;
}

void pack(Device device, const Points& points, const neighbors::Request& request, const char* what, neighbors::Packed& packed) {
#ifdef GRAINRAY_HAS_CUDA
    if (device == Device::cuda) return cuda::pack_points(points, request, what, packed);
#endif
    (void)device;
    cpu::pack_points(points, request, what, packed);
}

}  // namespace

struct NeighborSearch::Impl {
    Device device;
    SearchOptions options;
    std::map<std::string, std::unique_ptr<neighbors::Backend>> made;
    neighbors::Packed points, queries;
    std::string backend, reason;

    Impl(Device d, SearchOptions o) : device(d), options(std::move(o)), points(d), queries(d) {
        if (device == Device::cuda && !cuda_available()) throw InputError("device 'cuda' asked for, but " + cuda_status());
        for (int a = 0; a < 3; ++a)
            if (!std::isfinite(options.period[a]) || options.period[a] < 0 || !std::isfinite(options.lower[a]))
                throw InputError("periodic box: its lower corner must be finite and its lengths finite and not negative");
        if (options.block == 0) throw InputError("block must be at least 1");
        if (options.backend != "auto") require(options.backend);
    }

    const Row& require(const std::string& name) const {
        for (const Row& row : registry) {
            if (name != row.name) continue;
            if (const neighbors::Status s = status(row, device); !s.available)
                throw InputError("search back end '" + name + "' is not available on device '" + std::string(grainray::name(device)) + "': " + s.reason);
            return row;
        }
        throw InputError("search back end '" + name + "' is not known; known are: " + known_names());
    }

    neighbors::Request request() const { return {options.kind, options.block, options.ascending, options.lower, options.period}; }

    neighbors::Backend& choose(std::size_t n) {
        if (options.backend != "auto") {
            backend = options.backend;
            reason = "asked for";
        } else if (n < brute_is_faster_below) {
            backend = "brute";
            reason = "fewer than " + std::to_string(brute_is_faster_below) + " points";
        } else {
            backend = "cells";
            reason = "the fastest here for " + std::to_string(brute_is_faster_below) + " points and more";
        }
        auto& instance = made[backend];
        if (!instance) instance = factory(require(backend), device)();
        return *instance;
    }
};

NeighborSearch::NeighborSearch(Device device, SearchOptions options) : impl_(std::make_unique<Impl>(device, std::move(options))) {}
NeighborSearch::~NeighborSearch() = default;
NeighborSearch::NeighborSearch(NeighborSearch&&) noexcept = default;
NeighborSearch& NeighborSearch::operator=(NeighborSearch&&) noexcept = default;

void NeighborSearch::find(const Points& points, NeighborList& list) {
    pack(impl_->device, points, impl_->request(), "point", impl_->points);
    impl_->choose(points.size).pairs(impl_->points, impl_->request(), list);
}

void NeighborSearch::find(const Points& queries, const Points& points, NeighborList& list) {
    neighbors::Request request = impl_->request();
    request.kind = ListKind::half;  // rows belong to the queries alone
    pack(impl_->device, points, request, "point", impl_->points);
    pack(impl_->device, queries, request, "query", impl_->queries);
    impl_->choose(points.size).queries(impl_->queries, impl_->points, request, list);
}

const std::string& NeighborSearch::backend() const { return impl_->backend; }
const std::string& NeighborSearch::reason() const { return impl_->reason; }
const SearchOptions& NeighborSearch::options() const { return impl_->options; }
void NeighborSearch::set_block(std::uint32_t block) { impl_->options.block = block; }

std::size_t NeighborSearch::memory_bytes() const {
    std::size_t bytes = impl_->points.spheres.bytes() + impl_->points.ids.bytes();
    for (const auto& [name, backend] : impl_->made) bytes += backend->memory_bytes();
    return bytes;
}

std::vector<BackendInfo> search_backends(Device device) {
    std::vector<BackendInfo> info;
    for (const Row& row : registry) {
        const neighbors::Status s = status(row, device);
        info.push_back({row.name, s.available, s.reason});
    }
    return info;
}

}  // namespace grainray
