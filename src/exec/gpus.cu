#include "exec/gpus.hpp"

#include <cuda_runtime_api.h>

#include <cstdio>
#include <fstream>

namespace grainray::cuda {
namespace {

__global__ void nothing() {}

std::string version_text(int version) { return std::to_string(version / 1000) + '.' + std::to_string(version % 1000 / 10); }

int runtime_version() {
    int version = 0;
    cudaRuntimeGetVersion(&version);
    return version;
}

/// The newest CUDA that the installed driver serves; 0 where there is no driver.
int driver_supports() {
    int version = 0;
    if (cudaDriverGetVersion(&version) != cudaSuccess) version = 0;
    return version;
}

/// The driver's own version ("580.65.06"); empty where the kernel module is not loaded.
std::string driver_version() {
    std::ifstream file("/sys/module/nvidia/version");
    std::string text;
    file >> text;
    return text;
}

std::string no_driver() {
    if (driver_supports() == 0) return "no NVIDIA driver is installed; a GPU needs one";
    const std::string own = driver_version();
    return "the NVIDIA driver" + (own.empty() ? own : ' ' + own) + " is too old: it serves CUDA " + version_text(driver_supports()) +
           ", this build needs " + version_text(runtime_version()) + "; update the driver";
}

/// A sentence for what keeps CUDA from working at all, or from working on one GPU.
std::string explain(cudaError_t error) {
    switch (error) {
        case cudaErrorInsufficientDriver: return no_driver();
        case cudaErrorNoDevice: return "no NVIDIA GPU is visible (none is there, or CUDA_VISIBLE_DEVICES hides it)";
        case cudaErrorDevicesUnavailable: return "the GPU is taken by another process; wait for that one, or choose another GPU with CUDA_VISIBLE_DEVICES";
        case cudaErrorNoKernelImageForDevice:
        case cudaErrorInvalidDeviceFunction:
            return "this build has no code for this GPU; build with -D CMAKE_CUDA_ARCHITECTURES= its compute capability without the dot";
        case cudaErrorUnsupportedPtxVersion: return "the NVIDIA driver is older than the CUDA toolkit of this build and cannot translate its code; update the driver";
        case cudaErrorSystemDriverMismatch: return "the NVIDIA driver was changed while it was in use; start the machine again";
        case cudaErrorStubLibrary: return "the CUDA driver library found is the toolkit's stub; take the stubs folder out of LD_LIBRARY_PATH";
        case cudaErrorMemoryAllocation: return "the GPU has no memory left; end what uses it, or choose another GPU with CUDA_VISIBLE_DEVICES";
        default: return std::string("CUDA does not start: ") + cudaGetErrorString(error) + "; nvidia-smi may say more";
    }
}

/// Makes `device` the current one, with all that a kernel needs, so that what keeps it from working shows here.
cudaError_t start(int device) {
    cudaFuncAttributes ignored{};
    cudaError_t error = cudaSetDevice(device);
    if (error == cudaSuccess) error = cudaFuncGetAttributes(&ignored, nothing);
    if (error == cudaSuccess) error = cudaFree(nullptr);
    cudaGetLastError();
    return error;
}

Gpu describe(int device) {
    Gpu gpu;
    cudaDeviceProp properties{};
    cudaError_t error = cudaGetDeviceProperties(&properties, device);
    if (error == cudaSuccess) {
        gpu.name = properties.name;
        gpu.major = properties.major;
        gpu.minor = properties.minor;
        gpu.total_bytes = properties.totalGlobalMem;
        error = start(device);
    }
    if (error == cudaSuccess) error = cudaMemGetInfo(&gpu.free_bytes, &gpu.total_bytes);
    if (error != cudaSuccess) gpu.problem = explain(error);
    return gpu;
}

Probe ask_first() {
    int count = 0;
    cudaError_t error = cudaGetDeviceCount(&count);
    if (error == cudaSuccess && count == 0) error = cudaErrorNoDevice;
    if (error != cudaSuccess) return {false, explain(error)};
    const Gpu gpu = describe(0);
    if (!gpu.problem.empty()) return {false, (gpu.name.empty() ? "" : gpu.name + ": ") + gpu.problem};
    char text[400];
    std::snprintf(text, sizeof text, "%s, %.0f GiB, compute capability %d.%d", gpu.name.c_str(), static_cast<double>(gpu.total_bytes) / (1 << 30), gpu.major,
                  gpu.minor);
    return {true, text};
}

}  // namespace

const Probe& probe() {
    static const Probe p = ask_first();
    return p;
}

CudaReport report() {
    CudaReport result{runtime_version(), driver_supports(), driver_version(), {}};
    int count = 0;
    if (cudaGetDeviceCount(&count) != cudaSuccess) return result;
    for (int device = 0; device < count; ++device) result.gpus.push_back(describe(device));
    cudaSetDevice(0);
    return result;
}

}  // namespace grainray::cuda
