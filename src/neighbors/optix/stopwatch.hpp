// Times on the GPU's own clock, without waiting for it until they are asked for.
#pragma once

#include <array>

#include "exec/cuda_error.hpp"

namespace grainray::optix {

class Stopwatch {
public:
    Stopwatch() {
        for (auto& e : events_) cuda::check(cudaEventCreate(&e), "make a clock");
    }
    ~Stopwatch() {
        for (auto& e : events_) cudaEventDestroy(e);
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

    void start() {
        next_ = 0;
        lap();
    }
    void lap() { cuda::check(cudaEventRecord(events_[next_++], nullptr), "read the clock"); }
    /// Length of lap k.
    double milliseconds(std::size_t k) const {
        float t = 0;
        cuda::check(cudaEventSynchronize(events_[k + 1]), "read the clock");
        cuda::check(cudaEventElapsedTime(&t, events_[k], events_[k + 1]), "read the clock");
        return t;
    }

private:
    std::array<cudaEvent_t, 3> events_{};
    std::size_t next_ = 0;
};

}  // namespace grainray::optix
