// The primitives behind plain functions, once an executor.
#pragma once

#include <cstdint>
#include <vector>

namespace grainray {

struct PrimitiveFunctions {
    std::uint64_t (*scan)(std::vector<std::uint64_t>& values);
    void (*sort)(std::vector<std::uint32_t>& keys, std::vector<std::uint32_t>& values, int bits);
    double (*sum)(const std::vector<double>& values);
    std::vector<std::uint32_t> (*calls)(std::size_t n, std::uint64_t& sum);  ///< of a reduction over i whose function writes; how often for each i
    std::vector<std::uint32_t> (*histogram)(const std::vector<std::uint32_t>& values, std::uint32_t bins);
    std::uint32_t (*first_above)(const std::vector<std::uint32_t>& values, std::uint32_t limit);
};

namespace cpu { extern const PrimitiveFunctions primitive_functions; }
namespace cuda { extern const PrimitiveFunctions primitive_functions; }

}  // namespace grainray
