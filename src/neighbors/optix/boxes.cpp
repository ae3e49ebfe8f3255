#include "neighbors/optix/boxes.hpp"

#include <cuda_runtime_api.h>
#include <optix_stubs.h>

namespace grainray::optix {

void BoxTree::build(bool refit) {
    Machine& machine = Machine::get();
    const unsigned flags = OPTIX_GEOMETRY_FLAG_DISABLE_ANYHIT;
    const auto boxes = reinterpret_cast<CUdeviceptr>(boxes_.data());
    OptixBuildInput input{};
    input.type = OPTIX_BUILD_INPUT_TYPE_CUSTOM_PRIMITIVES;
    input.customPrimitiveArray.aabbBuffers = &boxes;
    input.customPrimitiveArray.numPrimitives = static_cast<unsigned>(boxes_.size());
    input.customPrimitiveArray.flags = &flags;
    input.customPrimitiveArray.numSbtRecords = 1;
    OptixAccelBuildOptions options{};
    // Against neither preference: builds 2.5 ms instead of 4.1, searches 4 % longer (1.6 million points, H100).
    options.buildFlags = OPTIX_BUILD_FLAG_ALLOW_UPDATE | OPTIX_BUILD_FLAG_PREFER_FAST_BUILD | OPTIX_BUILD_FLAG_ALLOW_COMPACTION;
    options.operation = refit ? OPTIX_BUILD_OPERATION_UPDATE : OPTIX_BUILD_OPERATION_BUILD;
    OptixAccelBufferSizes sizes{};
    machine.check(optixAccelComputeMemoryUsage(machine.context(), &options, &input, 1, &sizes), "size a tree");
    if (!refit) tree_.resize_discard_slack(sizes.outputSizeInBytes);
    scratch_.resize_discard_slack(refit ? sizes.tempUpdateSizeInBytes : sizes.tempSizeInBytes);
    OptixAccelEmitDesc compacted{};
    compacted.type = OPTIX_PROPERTY_TYPE_COMPACTED_SIZE;
    compacted.result = reinterpret_cast<CUdeviceptr>(compacted_size_.data());
    machine.check(optixAccelBuild(machine.context(), nullptr, &options, &input, 1, reinterpret_cast<CUdeviceptr>(scratch_.data()), scratch_.size(),
                                  reinterpret_cast<CUdeviceptr>(tree_.data()), tree_.size(), &handle_, refit ? nullptr : &compacted, refit ? 0 : 1),
                  refit ? "refit a tree" : "build a tree");
    if (!refit) compact();
}

/// A fifth smaller, and refitted in 0.7 ms instead of 1.0; costs a build 0.25 ms (1.6 million points, H100).
void BoxTree::compact() {
    Machine& machine = Machine::get();
    Array<char> smaller(Device::cuda, compacted_size_.to_host()[0]);
    machine.check(optixAccelCompact(machine.context(), nullptr, handle_, reinterpret_cast<CUdeviceptr>(smaller.data()), smaller.size(), &handle_), "compact a tree");
    tree_.swap(smaller);
}

}  // namespace grainray::optix
