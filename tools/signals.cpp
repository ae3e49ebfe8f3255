#include "signals.hpp"

#include <unistd.h>

namespace grainray::cli {
namespace {

constexpr int stopping[] = {SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t stop_asked = 0;

extern "C" void ask_to_stop(int signal) {
    if (!stop_asked) {
        stop_asked = 1;
        return;
    }
    constexpr char line[] = "\ngrainray: killed by a second signal; the last checkpoint is what is left\n";
    [[maybe_unused]] const auto ignored = write(STDERR_FILENO, line, sizeof line - 1);
    struct sigaction kill {};
    kill.sa_handler = SIG_DFL;
    sigaction(signal, &kill, nullptr);
    raise(signal);  // taken when this handler returns
}

}  // namespace

StopSignals::StopSignals() {
    stop_asked = 0;
    struct sigaction stop {};
    stop.sa_handler = ask_to_stop;
    stop.sa_flags = SA_RESTART;
    sigemptyset(&stop.sa_mask);
    for (int k = 0; k < 3; ++k) {
        sigaction(stopping[k], nullptr, &before_[k]);
        if (stopping[k] != SIGHUP || before_[k].sa_handler != SIG_IGN) sigaction(stopping[k], &stop, nullptr);
    }
}

StopSignals::~StopSignals() {
    for (int k = 0; k < 3; ++k) sigaction(stopping[k], &before_[k], nullptr);
}

bool StopSignals::asked() const { return stop_asked != 0; }

}  // namespace grainray::cli
