// Neighbours on the GPU, between the caller's own kernels, in the caller's stream: no point and no list crosses the bus.
// A kernel places the points of a cubic lattice, the search reads them where they are, a kernel counts what it found.
#include <array>
#include <cstdio>

#include <cuda_runtime.h>

#include <grainray/neighbors.hpp>

namespace {

constexpr std::uint32_t side = 100, n = side * side * side;
constexpr int skipped = 77;  // what the tests take for "not here"

/// x, y, z, reach: the neighbours are within 1.2.
__global__ void place(float4* points) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) points[i] = {float(i % side), float(i / side % side), float(i / side / side), 0.6f};
}

__global__ void count(const std::uint64_t* offsets, std::uint32_t* histogram) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const std::uint64_t neighbors = offsets[i + 1] - offsets[i];
    atomicAdd(&histogram[neighbors < 7 ? neighbors : 7], 1);
}

void check(cudaError_t status) {
    if (status != cudaSuccess) throw grainray::SimulationError(cudaGetErrorString(status));
}

std::array<std::uint32_t, 8> neighbors_of_lattice() {
    cudaStream_t stream;
    float4* points;
    std::uint32_t* histogram;
    std::array<std::uint32_t, 8> found;
    check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking));
    check(cudaMalloc(&points, n * sizeof(float4)));
    check(cudaMalloc(&histogram, sizeof found));

    grainray::SearchOptions options;
    options.stream = stream;
    grainray::NeighborSearch search(grainray::Device::cuda, options);
    grainray::NeighborList list(grainray::Device::cuda);

    check(cudaMemsetAsync(histogram, 0, sizeof found, stream));
    place<<<(n + 255) / 256, 256, 0, stream>>>(points);
    const float* p = &points->x;
    search.find({p, p + 1, p + 2, 4, p + 3, 4, 0, nullptr, n}, list);  // coordinates and reaches stand four floats apart
    count<<<(n + 255) / 256, 256, 0, stream>>>(list.offsets.data(), histogram);
    check(cudaMemcpyAsync(found.data(), histogram, sizeof found, cudaMemcpyDeviceToHost, stream));
    check(cudaStreamSynchronize(stream));
    std::printf("%u points, %zu entries, found by %s on %s\n", n, list.neighbors.size(), search.backend().c_str(), grainray::cuda_status().c_str());

    check(cudaFree(histogram));
    check(cudaFree(points));
    check(cudaStreamDestroy(stream));
    return found;
}

}  // namespace

int main() {
    if (!grainray::cuda_available()) {
        std::printf("skipped: %s\n", grainray::cuda_status().c_str());
        return skipped;
    }
    const auto found = neighbors_of_lattice();
    for (std::uint32_t k = 0; k < found.size(); ++k)
        if (found[k]) std::printf("%u neighbours: %u points\n", k, found[k]);

    constexpr std::uint32_t inner = side - 2;
    const std::array<std::uint32_t, 8> expected{0, 0, 0, 8, 12 * inner, 6 * inner * inner, inner * inner * inner, 0};
    if (found == expected) return 0;
    std::printf("wrong: a lattice has other numbers\n");
    return 1;
}
