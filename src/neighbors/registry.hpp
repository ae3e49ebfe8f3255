// The registry of back ends: one row each.
#pragma once

#include <span>

#include "neighbors/backend.hpp"

namespace grainray::neighbors {

struct Row {
    using Factory = std::unique_ptr<Backend> (*)();
    const char* name;
    Factory cpu, cuda;                         ///< how to make it on each device; null: not built
    Status (*cpu_status)(), (*cuda_status)();  ///< whether it works here
    bool automatic;                            ///< a candidate of `auto` for many points
    bool (*can_win)(Device, const Effort&);    ///< whether it is worth measuring beside cells; null: always

    Status status(Device device) const { return device == Device::cpu ? cpu_status() : cuda_status(); }
    std::unique_ptr<Backend> make(Device device) const { return device == Device::cpu ? cpu() : cuda(); }
};

std::span<const Row> registry();
/// Null: not known.
const Row* find_row(const std::string& name);
/// Throws InputError: not known (names those that are), or not available, and why.
const Row& require_backend(const std::string& name, Device);

}  // namespace grainray::neighbors
