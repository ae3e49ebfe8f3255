#include "progress.hpp"

#include <unistd.h>

#include <cstdio>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "arguments.hpp"
#include "report.hpp"

namespace grainray::cli {
namespace {

constexpr double redraw_seconds = 0.5;
constexpr double smoothing = 0.3;          // weight of the newest speed
constexpr double interval_share = 0.02;    // of the time may go into asking for search figures, which copies lists

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::string exchange_text(const Simulation& simulation) {
    if (simulation.streams().empty() && simulation.removals().empty()) return "";
    const Exchanged e = exchanged_by(simulation);
    std::string text = fmt::format(", {}", counted(simulation.size(), "particle"));
    const char* joint = ": ";
    for (const auto& [count, what] : {std::pair{e.inserted, "inserted"}, {e.waiting, "waiting"}, {e.removed, "removed"}, {e.lost, "lost"}})
        if (count) text += fmt::format("{}{} {}", std::exchange(joint, ", "), count, what);
    return text;
}

Progress::Progress(bool quiet, std::uint64_t first_step, std::uint64_t last_step)
    : shown_(!quiet && isatty(STDERR_FILENO)), first_(first_step), last_(last_step), step_before_(first_step), time_before_(clock::now()) {}

double Progress::rebuild_interval(const Simulation& simulation) {
    if (seconds_since(interval_time_) * interval_share < interval_cost_) return interval_;
    const auto start = clock::now();
    interval_ = simulation.search().mean_interval_steps;
    interval_cost_ = seconds_since(start);
    interval_time_ = clock::now();
    return interval_;
}

void Progress::update(const Simulation& simulation) {
    if (!shown_) return;
    const double seconds = seconds_since(time_before_);
    const std::uint64_t step = simulation.step_count();
    if (seconds < redraw_seconds || step == step_before_) return;
    const double now = static_cast<double>(step - step_before_) / seconds;
    steps_per_second_ = steps_per_second_ > 0 ? (1 - smoothing) * steps_per_second_ + smoothing * now : now;
    step_before_ = step;
    const double percent = 100.0 * static_cast<double>(step - first_) / static_cast<double>(last_ - first_);
    fmt::print(stderr, "\r{:5.1f} %  step {}/{}  t = {:.4g} s  {} particle-steps/s{}  rebuild every {:.3g} steps  {} left\x1b[K", percent, step,
               last_, simulation.time(), short_number(steps_per_second_ * static_cast<double>(simulation.size())), exchange_text(simulation), rebuild_interval(simulation),
               duration_text(static_cast<double>(last_ - step) / steps_per_second_));
    std::fflush(stderr);
    drawn_ = true;
    time_before_ = clock::now();
}

void Progress::clear() {
    if (!drawn_) return;
    fmt::print(stderr, "\r\x1b[K");
    std::fflush(stderr);
    drawn_ = false;
}

}  // namespace grainray::cli
