// Stage of the tests: runs each primitive on host data.
#include "exec/primitives.hpp"

#include "exec/exec.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

struct Add {
    GR_HD double operator()(double a, double b) const { return a + b; }
};

std::uint64_t scan(std::vector<std::uint64_t>& values) {
    Array<std::uint64_t> a(device, values);
    const std::uint64_t total = exclusive_scan(a.view());
    values = a.to_host();
    return total;
}

void sort(std::vector<std::uint32_t>& keys, std::vector<std::uint32_t>& values, int bits) {
    Array<std::uint32_t> k(device, keys), v(device, values), k2(device), v2(device);
    sort_by_key(k, v, k2, v2, bits);
    keys = k.to_host();
    values = v.to_host();
}

double sum(const std::vector<double>& values) {
    Array<double> a(device, values);
    const auto v = a.view();
    return reduce(values.size(), 0.0, [=] GR_HD(std::size_t i) { return v[i]; }, Add{});
}

struct AddIndices {
    GR_HD std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a + b; }
};

std::vector<std::uint32_t> calls(std::size_t n, std::uint64_t& sum) {
    Array<std::uint32_t> counts(device, n);
    Array<std::uint64_t> result(device, 1);
    counts.clear_bytes();
    const auto c = counts.view();
    reduce_into(result.data(), n, std::uint64_t{0}, [=] GR_HD(std::size_t i) { return ++c[i], std::uint64_t{i}; }, AddIndices{});
    sum = fetch(result.data());
    return counts.to_host();
}

std::vector<std::uint32_t> histogram(const std::vector<std::uint32_t>& values, std::uint32_t bins) {
    Array<std::uint32_t> a(device, values), counts(device, bins);
    counts.clear_bytes();
    const auto v = a.view(), c = counts.view();
    for_each(values.size(), [=] GR_HD(std::size_t i) { atomic_add(&c[v[i] % bins], 1u); });
    return counts.to_host();
}

std::uint32_t first_above(const std::vector<std::uint32_t>& values, std::uint32_t limit) {
    Array<std::uint32_t> a(device, values), first(device, std::vector<std::uint32_t>{~0u});
    const auto v = a.view(), f = first.view();
    for_each(values.size(), [=] GR_HD(std::size_t i) {
        if (v[i] > limit) atomic_min(&f[0], static_cast<std::uint32_t>(i));
    });
    return first.to_host()[0];
}

}  // namespace

const PrimitiveFunctions primitive_functions{scan, sort, sum, calls, histogram, first_above};

}  // namespace grainray::GRAINRAY_EXEC
