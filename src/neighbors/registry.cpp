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
#else
#define GRAINRAY_ON_OPTIX(function) nullptr
Status rays_on_cuda() {
    if (!cuda_available()) return where_cuda();
    return {false, "this build has no OptiX: its headers were not there when it was configured; set OptiX_ROOT to their folder and build again"};
}
#endif

constexpr std::array rows{
    Row{"brute", cpu::make_brute, GRAINRAY_ON_CUDA(make_brute), always, where_cuda, false},
    Row{"cells", cpu::make_cells, GRAINRAY_ON_CUDA(make_cells), always, where_cuda, true},
    Row{"rays", cpu::make_embree, GRAINRAY_ON_OPTIX(make_optix), cpu::embree_status, rays_on_cuda, true},
    Row{"rays-published", cpu::make_embree_published, GRAINRAY_ON_OPTIX(make_optix_published), cpu::embree_status, rays_on_cuda, false},
};

std::string known_names() {
    std::string names = "auto";
    for (const Row& row : rows) names += std::string(", ") + row.name;
    return names;
}

}  // namespace

std::span<const Row> registry() { return rows; }

const Row& require_backend(const std::string& name, Device device) {
    for (const Row& row : rows) {
        if (name != row.name) continue;
        if (const Status s = row.status(device); !s.available)
            throw InputError("search back end '" + name + "' is not available on device '" + std::string(grainray::name(device)) + "': " + s.reason);
        return row;
    }
    throw InputError("search back end '" + name + "' is not known; known are: " + known_names());
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
