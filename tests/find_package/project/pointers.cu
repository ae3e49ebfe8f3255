// Links grainray::neighbors from CUDA: four points on a line in the caller's device memory, in the caller's stream.
#include <cstdio>
#include <vector>

#include <cuda_runtime.h>

#include <grainray/neighbors.hpp>

__global__ void place(float* xyz) { xyz[3 * threadIdx.x] = static_cast<float>(threadIdx.x); }

int main() {
    if (!grainray::cuda_available()) {
        std::printf("not run: %s\n", grainray::cuda_status().c_str());
        return 0;
    }
    float* xyz = nullptr;
    cudaStream_t stream = nullptr;
    cudaMalloc(&xyz, 12 * sizeof(float));
    cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking);
    cudaMemsetAsync(xyz, 0, 12 * sizeof(float), stream);
    place<<<1, 4, 0, stream>>>(xyz);

    grainray::SearchOptions options;
    options.stream = stream;
    grainray::NeighborSearch search(grainray::Device::cuda, options);
    grainray::NeighborList list(grainray::Device::cuda);
    search.find(grainray::Points::xyz(xyz, 4, 0.6f), list);
    const std::vector<std::uint32_t> expected{1, 0, 2, 1, 3, 2};
    return list.neighbors.to_host() == expected ? 0 : 1;
}
