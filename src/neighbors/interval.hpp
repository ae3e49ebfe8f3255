// How many steps a list should last, found while running. A list that lasts n steps and has e entries costs a step
//   T = t_update / n + t_entry e
// with both times measured as running means, so that two lists are compared by what is exact about them, n and e, and the
// noise of a clock does not steer. The interval is made longer as long as T falls, then shorter, and so on round the
// optimum. The choice changes the time alone, never the trajectory.
#pragma once

#include <algorithm>
#include <cstdint>

namespace grainray {

class IntervalTuner {
public:
    /// fixed > 0: no tuning.
    explicit IntervalTuner(double fixed = 0) : interval_(fixed > 0 ? fixed : 16), tuned_(!(fixed > 0)) {}

    double interval() const { return interval_; }

    /// A list of `entries` candidates has come to its end after `steps` steps; seconds its making and all its steps' forces took.
    void finished(std::uint64_t steps, std::uint64_t entries, double update_seconds, double contact_seconds) {
        if (!tuned_ || steps == 0 || entries == 0) return;
        const double n = static_cast<double>(steps), e = static_cast<double>(entries);
        smooth(update_, update_seconds);
        smooth(entry_, candidate_share * contact_seconds / n / e);
        const auto cost = [&](double life, double size) { return update_ / life + entry_ * size; };
        if (last_steps_ > 0 && cost(n, e) > cost(last_steps_, last_entries_)) factor_ = 1 / factor_;
        last_steps_ = n;
        last_entries_ = e;
        interval_ = std::clamp(interval_ * factor_, 4.0, 200.0);
    }

private:
    static constexpr double candidate_share = 0.6;  ///< what an entry that does not touch costs of one on average
    static void smooth(double& mean, double value) { mean = mean > 0 ? 0.9 * mean + 0.1 * value : value; }

    double interval_;
    bool tuned_;
    double factor_ = 1.25, update_ = 0, entry_ = 0, last_steps_ = 0, last_entries_ = 0;
};

}  // namespace grainray
