#include "signals.hpp"

namespace grainray::cli {
namespace {

volatile std::sig_atomic_t stop_asked = 0;

extern "C" void ask_to_stop(int) {
    stop_asked = 1;
    struct sigaction kill {};
    kill.sa_handler = SIG_DFL;
    sigaction(SIGINT, &kill, nullptr);
    sigaction(SIGTERM, &kill, nullptr);
}

}  // namespace

StopSignals::StopSignals() {
    stop_asked = 0;
    struct sigaction stop {};
    stop.sa_handler = ask_to_stop;
    stop.sa_flags = SA_RESTART;
    sigemptyset(&stop.sa_mask);
    sigaction(SIGINT, &stop, &interrupt_before_);
    sigaction(SIGTERM, &stop, &terminate_before_);
}

StopSignals::~StopSignals() {
    sigaction(SIGINT, &interrupt_before_, nullptr);
    sigaction(SIGTERM, &terminate_before_, nullptr);
}

bool StopSignals::asked() const { return stop_asked != 0; }

}  // namespace grainray::cli
