// SIGINT, SIGTERM and SIGHUP ask a run to stop after the step it is in; a second signal says so and kills.
#pragma once

#include <csignal>

namespace grainray::cli {

/// Catches the signals while it lives; a hang-up that is ignored, as under nohup, stays so.
class StopSignals {
public:
    StopSignals();
    ~StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;
    bool asked() const;

private:
    struct sigaction before_[3]{};
};

}  // namespace grainray::cli
