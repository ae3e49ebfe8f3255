// SIGINT and SIGTERM ask a run to stop after the step it is in; a second signal kills.
#pragma once

#include <csignal>

namespace grainray::cli {

/// Catches both signals while it lives.
class StopSignals {
public:
    StopSignals();
    ~StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;
    bool asked() const;

private:
    struct sigaction interrupt_before_{}, terminate_before_{};
};

}  // namespace grainray::cli
