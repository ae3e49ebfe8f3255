// OptiX on the present GPU: the driver's library, a context and the compiled programs. Made once, on first use.
#pragma once

#include "neighbors/backend.hpp"
#include "neighbors/optix/parameters.hpp"

namespace grainray::optix {

enum class Search { pairs, published, queries };

class Machine {
public:
    /// Never destroyed: the driver may be gone by the time statics are.
    static Machine& get();

    /// Off, with the reason, where anything is missing, too old or broken.
    const neighbors::Status& status() const { return status_; }
    OptixDeviceContext context() const { return context_; }
    /// Rays for sources [0, n) of the parameters.
    void launch(Search, Parameters, std::size_t n);

    /// Throws SimulationError with what OptiX said.
    void check(OptixResult, const char* what) const;

private:
    Machine();
    void load();
    void make_context();
    void make_pipeline();
    OptixProgramGroup group(const OptixProgramGroupDesc&, const char* what);

    neighbors::Status status_;
    unsigned rt_cores_ = 0;
    OptixDeviceContext context_ = nullptr;
    OptixPipeline pipeline_ = nullptr;
    Array<char> records_{Device::cpu}, parameters_{Device::cpu};
};

}  // namespace grainray::optix
