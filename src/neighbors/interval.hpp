// How wide margins are and how long a list should last, found while running, from one model of the cost of a step:
//   T = t_update(e) / n + t_entry e
// for a list of e entries that lasts n steps. Margins together are sigma times the radii; e grows as (1 + sigma)^3, and of the time
// of an update a part grows with e. A list ends in one of two ways, and each says which knob to turn:
//   at its limit: n is the interval, and only the part of the margins that grows with it (speed times interval) costs;
//   early, by one particle past its margin: n grows as sigma^(1/2) or so, as far as such particles are accelerated, and both knobs widen
//   all margins.
// Each list moves its knobs towards where dT = 0. Nothing is compared between lists, so that a world that changes, as a column
// that lands, does not mislead. Choices change the time alone, never the trajectory.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

namespace grainray {

class IntervalTuner {
public:
    /// A list that came to its end, and the seconds that its making and the forces of all its steps took.
    struct Life {
        double steps, entries, particles;
        double margin;  ///< sigma
        bool early;     ///< a particle moved past its margin before the interval was over
        double update_seconds, contact_seconds;
    };

    /// interval, skin > 0: fixed. candidate_share: what an entry that does not touch costs of one on average.
    explicit IntervalTuner(double interval = 0, double skin = 0, double candidate_share = 0.6)
        : interval_(interval > 0 ? interval : 24), skin_(skin > 0 ? skin : 0.03), interval_fixed_(interval > 0), skin_fixed_(skin > 0),
          candidate_share_(candidate_share) {}

    static constexpr std::uint32_t shortest = 4, longest = 200;

    double interval() const { return interval_; }
    double skin() const { return skin_; }  ///< least margin, of the particle's radius

    /// A list meant for more steps, or with a wider least margin, has become too large.
    void shorten(double interval, double skin) {
        if (!interval_fixed_) interval_ = most_ = std::min(interval_, interval);
        if (!skin_fixed_) skin_ = std::clamp(skin, 0.01, skin_);
    }

    void finished(const Life& life) {
        if (life.steps == 0 || life.entries == 0 || life.margin == 0) return;
        if (!(life.update_seconds > 0 && life.contact_seconds > 0)) return;  // a caller has set its profile to zero meanwhile
        smooth(update_, life.update_seconds);
        smooth(entry_, candidate_share_ * life.contact_seconds / life.steps / life.entries);
        const double making = update_ / life.steps, of_entries = life.entries / (life.entries + entries_worth_a_particle * life.particles);
        const double widening = (entry_ * life.entries + of_entries * making) * 3 * life.margin / (1 + life.margin);  // dT / d ln sigma
        if (life.early) {
            const double factor = towards(0.5 * making, widening);
            move(factor, factor);
        } else {
            move(towards(making, widening * std::clamp(1 - skin_ / life.margin, 0.05, 1.0)), 0.95);
        }
    }

    /// "a list takes 2.1 ms and is meant for 24 steps; least margin 0.08 r"; empty before the first list ends.
    std::string reason() const {
        if (update_ == 0) return {};
        char text[128];
        std::snprintf(text, sizeof text, "a list takes %.3g ms and is meant for %.3g steps; least margin %.2g r", 1e3 * update_, interval_, skin_);
        return text;
    }

private:
    static constexpr double entries_worth_a_particle = 3.4;  ///< an update's time a particle over its time an entry
    static void smooth(double& mean, double value) { mean = mean > 0 ? 0.9 * mean + 0.1 * value : value; }
    static double towards(double gain, double cost) { return std::clamp(std::sqrt(gain / std::max(cost, 1e-30)), 0.8, 1.25); }
    void move(double interval_factor, double skin_factor) {
        most_ = std::min<double>(1.05 * most_, longest);  // what was too large may fit again when motion calms down
        if (!interval_fixed_) interval_ = std::clamp<double>(interval_ * interval_factor, shortest, std::max<double>(shortest, most_));
        if (!skin_fixed_) skin_ = std::clamp(skin_ * skin_factor, 0.01, 0.4);
    }

    double interval_, skin_;
    bool interval_fixed_, skin_fixed_;
    double candidate_share_, update_ = 0, entry_ = 0;
    double most_ = longest;  ///< steps that fit lately
};

}  // namespace grainray
