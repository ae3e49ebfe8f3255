#include "neighbors/registry.hpp"

#include <array>

namespace grainray::neighbors {
namespace {

Status always() { return {true, "ready"}; }
Status where_cuda() { return {cuda_available(), cuda_available() ? "ready" : cuda_status()}; }

#ifdef GRAINRAY_HAS_CUDA
#define GRAINRAY_ON_CUDA(function) cuda::function
#else
#define GRAINRAY_ON_CUDA(function) nullptr
#endif
#ifdef GRAINRAY_HAS_OPTIX
#define GRAINRAY_ON_OPTIX(function) cuda::function
Status rays_on_cuda() { return cuda_available() ? cuda::optix_status() : where_cuda(); }
bool traced_by_hardware(Device device) { return device == Device::cuda && cuda::may_have_ray_cores(); }
#else
#define GRAINRAY_ON_OPTIX(function) nullptr
bool traced_by_hardware(Device) { return false; }
Status rays_on_cuda() {
    if (!cuda_available()) return where_cuda();
    return {false, "this build has no OptiX: its headers were not there when it was configured; set OptiX_ROOT to their folder and build again"};
}
#endif

/// Rays traced in software won nowhere below this effort of cells (docs/neighbors.md). On a GPU cells wait for the one point
/// that looks at most.
bool rays_can_win(Device device, const Effort& cells) {
    return cells.mean >= 100 || (device == Device::cuda && cells.most >= 1000) || traced_by_hardware(device);
}

constexpr std::array rows{
    Row{"brute", cpu::make_brute, GRAINRAY_ON_CUDA(make_brute), always, where_cuda, false, nullptr},
    Row{"cells", cpu::make_cells, GRAINRAY_ON_CUDA(make_cells), always, where_cuda, true, nullptr},
    Row{"rays", cpu::make_embree, GRAINRAY_ON_OPTIX(make_optix), cpu::embree_status, rays_on_cuda, true, rays_can_win},
    Row{"rays-published", cpu::make_embree_published, GRAINRAY_ON_OPTIX(make_optix_published), cpu::embree_status, rays_on_cuda, false, nullptr},
};

std::string known_names() {
    std::string names = "auto";
    for (const Row& row : rows) names += std::string(", ") + row.name;
    return names;
}

}  // namespace

std::span<const Row> registry() { return rows; }

const Row* find_row(const std::string& name) {
    for (const Row& row : rows)
        if (name == row.name) return &row;
    return nullptr;
}

const Row& require_backend(const std::string& name, Device device) {
    const Row* const row = find_row(name);
    if (!row) throw InputError("search back end '" + name + "' is not known; known are: " + known_names());
    if (const Status s = row->status(device); !s.available)
        throw InputError("search back end '" + name + "' is not available on device '" + std::string(grainray::name(device)) + "': " + s.reason);
    return *row;
}

}  // namespace grainray::neighbors

namespace grainray {

std::vector<BackendInfo> search_backends(Device device) {
    std::vector<BackendInfo> info;
    for (const neighbors::Row& row : neighbors::registry()) {
        const neighbors::Status s = row.status(device);
        info.push_back({row.name, s.available, s.reason});
    }
    return info;
}

}  // namespace grainray
