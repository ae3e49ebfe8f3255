// The progress line on stderr: only where stderr is a terminal; one line at the start and one at the end otherwise.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "grainray/simulation.hpp"

namespace grainray::cli {

/// ", 1200 particles: 500 inserted, 20 waiting, 300 removed"; nothing where no particle comes or goes.
std::string exchange_text(const Simulation&);

class Progress {
public:
    Progress(bool quiet, std::uint64_t first_step, std::uint64_t last_step);
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Redraws the line if half a second has passed.
    void update(const Simulation&);
    /// Removes the line, so that a message can be printed.
    void clear();

private:
    using clock = std::chrono::steady_clock;
    double rebuild_interval(const Simulation&);

    bool shown_, drawn_ = false;
    std::uint64_t first_, last_, step_before_;
    clock::time_point time_before_;
    double steps_per_second_ = 0, interval_ = 0, interval_cost_ = 0;
    clock::time_point interval_time_{};
};

}  // namespace grainray::cli
