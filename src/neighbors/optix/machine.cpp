#include "neighbors/optix/machine.hpp"

#include <cuda_runtime_api.h>
#include <dlfcn.h>

#include <array>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <vector>

#include <optix_function_table_definition.h>
#include <optix_stubs.h>

#include "exec/cuda_error.hpp"

#ifndef OPTIX_FUNCTION_TABLE_SYMBOL  // headers before 8.1
#define OPTIX_FUNCTION_TABLE_SYMBOL g_optixFunctionTable
#endif

namespace grainray::optix {

extern const char* const programs;  // PTX of programs.cu, embedded by the build

namespace {

constexpr std::size_t record_size = OPTIX_SBT_RECORD_HEADER_SIZE;
constexpr std::array intersections{"__intersection__pairs", "__intersection__published", "__intersection__queries"};

/// The last things OptiX said, for when something fails.
class Messages {
public:
    void add(const std::string& text) {
        const std::lock_guard lock(mutex_);
        last_.push_back(text);
        if (last_.size() > 4) last_.pop_front();
    }
    std::string text() const {
        const std::lock_guard lock(mutex_);
        std::string all;
        for (const std::string& m : last_) all += (all.empty() ? "; OptiX said: " : " | ") + m;
        for (char& c : all)
            if (c == '\n') c = ' ';
        return all;
    }

private:
    mutable std::mutex mutex_;
    std::deque<std::string> last_;
};
Messages& messages() {
    static auto* const all = new Messages;
    return *all;
}

std::string version_text(unsigned version) { return std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100); }

}  // namespace

Machine& Machine::get() {
    static auto* const machine = new Machine;
    return *machine;
}

Machine::Machine() {
    try {
        load();
        make_context();
        make_pipeline();
        status_ = {true, "OptiX " + version_text(OPTIX_VERSION) + (rt_cores_ ? ", RT cores " + version_text(100 * rt_cores_)
                                                                             : ", this GPU has no RT cores: rays are traced in software")};
    } catch (const Error& e) {
        status_ = {false, e.what()};
    }
}

/// An interface older than the driver is what drivers keep: one built with old headers runs on every newer driver.
void Machine::load() {
    const char* const given = std::getenv("GRAINRAY_OPTIX_LIBRARY");
    const char* const name = given ? given : "libnvoptix.so.1";
    void* const library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (!library)
        throw SimulationError(std::string("OptiX is not there (") + dlerror() + "); it comes with the NVIDIA driver: install the whole driver, start a "
                              "container with NVIDIA_DRIVER_CAPABILITIES=all, or set GRAINRAY_OPTIX_LIBRARY to the library");
    using Query = OptixResult(int, unsigned, OptixQueryFunctionTableOptions*, const void**, void*, std::size_t);
    auto* const query = reinterpret_cast<Query*>(dlsym(library, "optixQueryFunctionTable"));
    if (!query) throw SimulationError(std::string(name) + " is no OptiX library; install the driver anew or mend GRAINRAY_OPTIX_LIBRARY");
    const OptixResult result = query(OPTIX_ABI_VERSION, 0, nullptr, nullptr, &OPTIX_FUNCTION_TABLE_SYMBOL, sizeof OPTIX_FUNCTION_TABLE_SYMBOL);
    if (result == OPTIX_ERROR_UNSUPPORTED_ABI_VERSION)
        throw SimulationError("the NVIDIA driver is older than OptiX " + version_text(OPTIX_VERSION) + ", which this build speaks; update the driver, or build with older "
                              "headers (OptiX_ROOT)");
    if (result != OPTIX_SUCCESS) throw SimulationError("OptiX does not start (error " + std::to_string(result) + "); update or reinstall the driver");
}

void Machine::make_context() {
    cuda::check(cudaFree(nullptr), "start");  // makes the CUDA context that OptiX joins
    OptixDeviceContextOptions options{};
    options.logCallbackFunction = [](unsigned, const char* tag, const char* text, void*) { messages().add(std::string(tag) + ": " + text); };
    options.logCallbackLevel = 3;
    check(optixDeviceContextCreate(nullptr, &options, &context_), "create a context");
    check(optixDeviceContextGetProperty(context_, OPTIX_DEVICE_PROPERTY_RTCORE_VERSION, &rt_cores_, sizeof rt_cores_), "ask for RT cores");
}

OptixProgramGroup Machine::group(const OptixProgramGroupDesc& description, const char* what) {
    const OptixProgramGroupOptions options{};
    OptixProgramGroup made = nullptr;
    check(optixProgramGroupCreate(context_, &description, 1, &options, nullptr, nullptr, &made), what);
    return made;
}

void Machine::make_pipeline() {
    OptixModuleCompileOptions compile{};
    OptixPipelineCompileOptions pipeline{};
    pipeline.traversableGraphFlags = OPTIX_TRAVERSABLE_GRAPH_FLAG_ALLOW_SINGLE_GAS;
    pipeline.numPayloadValues = 3;
    pipeline.numAttributeValues = 2;
    pipeline.exceptionFlags = OPTIX_EXCEPTION_FLAG_NONE;
    pipeline.pipelineLaunchParamsVariableName = "launch_parameters";
    pipeline.usesPrimitiveTypeFlags = OPTIX_PRIMITIVE_TYPE_FLAGS_CUSTOM;
    OptixModule module = nullptr;
    check(optixModuleCreate(context_, &compile, &pipeline, programs, std::char_traits<char>::length(programs), nullptr, nullptr, &module), "compile the programs");

    std::vector<OptixProgramGroup> groups;
    OptixProgramGroupDesc d{};
    d.kind = OPTIX_PROGRAM_GROUP_KIND_RAYGEN;
    d.raygen = {module, "__raygen__rays"};
    groups.push_back(group(d, "make the ray program"));
    d = {};
    d.kind = OPTIX_PROGRAM_GROUP_KIND_MISS;
    d.miss = {module, "__miss__nothing"};
    groups.push_back(group(d, "make the miss program"));
    for (const char* name : intersections) {
        d = {};
        d.kind = OPTIX_PROGRAM_GROUP_KIND_HITGROUP;
        d.hitgroup.moduleIS = module;
        d.hitgroup.entryFunctionNameIS = name;
        groups.push_back(group(d, "make an intersection program"));
    }
    OptixPipelineLinkOptions link{};
    link.maxTraceDepth = 1;
    check(optixPipelineCreate(context_, &pipeline, &link, groups.data(), static_cast<unsigned>(groups.size()), nullptr, nullptr, &pipeline_), "link the programs");

    std::vector<char> records(groups.size() * record_size);
    for (std::size_t g = 0; g < groups.size(); ++g) check(optixSbtRecordPackHeader(groups[g], &records[g * record_size]), "pack a record");
    records_ = Array<char>(Device::cuda, records);
    parameters_ = Array<char>(Device::cuda, sizeof(Parameters));
}

void Machine::launch(Search search, Parameters parameters, std::size_t n) {
    constexpr std::size_t most = std::size_t{1} << 29;  // OptiX takes 2^30 at a time
    const auto record = [&](std::size_t g) { return reinterpret_cast<CUdeviceptr>(records_.data() + g * record_size); };
    OptixShaderBindingTable table{};
    table.raygenRecord = record(0);
    table.missRecordBase = record(1);
    table.missRecordStrideInBytes = record_size;
    table.missRecordCount = 1;
    table.hitgroupRecordBase = record(2 + static_cast<std::size_t>(search));
    table.hitgroupRecordStrideInBytes = record_size;
    table.hitgroupRecordCount = 1;
    for (std::size_t first = 0; first < n; first += most) {
        parameters.first = first;
        detail::copy(Device::cuda, parameters_.data(), Device::cpu, &parameters, sizeof parameters);
        const auto rays = static_cast<unsigned>(std::min(most, n - first));
        check(optixLaunch(pipeline_, nullptr, reinterpret_cast<CUdeviceptr>(parameters_.data()), sizeof parameters, &table, rays, 1, 1), "launch rays");
    }
}

void Machine::check(OptixResult result, const char* what) const {
    if (result == OPTIX_SUCCESS) return;
    throw SimulationError(std::string("OptiX could not ") + what + ": " + optixGetErrorString(result) + messages().text() +
                          " (search by cells needs no OptiX; a newer driver may help)");
}

}  // namespace grainray::optix

namespace grainray::cuda {

bool may_have_ray_cores() {
    int device = 0, major = 0, minor = 0;
    if (cudaGetDevice(&device) || cudaDeviceGetAttribute(&major, cudaDevAttrComputeCapabilityMajor, device) ||
        cudaDeviceGetAttribute(&minor, cudaDevAttrComputeCapabilityMinor, device))
        return true;
    return !(minor == 0 && (major == 7 || major == 8 || major == 9 || major == 10));  // V100, A100, H100 and H200, B200
}

}  // namespace grainray::cuda
