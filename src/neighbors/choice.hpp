// What `auto` takes: the candidate that took least time on the caller's own points. Those that can win are measured on the
// first search, and again when the points have changed enough, as long as measuring stays a small share of the time spent
// searching. The choice changes the time alone, never the list.
#pragma once

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

namespace grainray::neighbors {

/// What the cost of a search depends on.
struct Facts {
    double points = 0, entries = 0;  ///< entries: of the list of the search before
    double spread = 1;               ///< largest reach over the mean
    double crowding = 1;             ///< (mean reach)^3 points over the volume of their bounds: small in sparse worlds
};

class Choice {
public:
    struct Candidate {
        std::string name;
        double seconds = 0;  ///< of a search when last measured; 0: never
        Facts at;            ///< what it was measured on
        std::string why_not; ///< why the last round left it out; empty: it did not, or it is not here
    };

    explicit Choice(std::vector<std::string> names) {
        for (std::string& name : names) candidates_.push_back({std::move(name), 0, {}, {}});
    }

    const std::vector<Candidate>& candidates() const { return candidates_; }
    std::size_t best() const { return best_; }

    /// Whether a round of measuring is due; else take the best.
    bool due(const Facts& now) const {
        const double least = candidates_[best_].seconds;
        if (candidates_.size() < 2 || least == 0) return candidates_.size() > 1;
        if (!differ(now, candidates_[best_].at, 1.5) || contenders(now).size() < 2) return false;
        double forecast = 0;
        for (const std::size_t c : contenders(now)) forecast += 2 * (candidates_[c].seconds > 0 ? candidates_[c].seconds : hopeless_factor * least);
        return spent_measuring_ + forecast <= share * spent_searching_;
    }
    /// Those that were not far behind when last measured.
    std::vector<std::size_t> contenders(const Facts& now) const {
        std::vector<std::size_t> all;
        for (std::size_t c = 0; c < candidates_.size(); ++c)
            if (!hopeless(candidates_[c], now)) all.push_back(c);
        return all;
    }

    /// A candidate whose first search, which also makes its memory, took this long need not be searched with again.
    bool out_of_the_race(double seconds) const {
        const double least = candidates_[best_].seconds;
        return least > 0 && seconds > 3 * hopeless_factor * least;
    }

    void measured(std::size_t c, double seconds, const Facts& at) {
        candidates_[c].seconds = std::max(seconds, 1e-9);
        candidates_[c].at = at;
        candidates_[c].why_not.clear();
        if (candidates_[best_].seconds == 0) best_ = c;
    }
    void left_out(std::size_t c, std::string why_not) {
        candidates_[c].seconds = 0;
        candidates_[c].why_not = std::move(why_not);
    }
    /// A round is over that cost this much more than one search would have; the first is free.
    void finished_round(double extra_seconds) {
        if (rounds_++ > 0) spent_measuring_ += extra_seconds;
        for (std::size_t c = 0; c < candidates_.size(); ++c)
            if (candidates_[c].seconds > 0 && candidates_[c].seconds < candidates_[best_].seconds) best_ = c;
    }
    void searched(double seconds) { spent_searching_ += seconds; }

    /// "measured 0.31 ms a search against 2.4 ms by rays".
    std::string reason() const {
        std::string rivals, without;
        for (const Candidate& c : candidates_) {
            if (&c != &candidates_[best_] && c.seconds > 0) rivals += (rivals.empty() ? " against " : " and ") + milliseconds(c.seconds) + " ms by " + c.name;
            if (!c.why_not.empty()) without += (without.empty() ? "" : "; ") + c.name + " left out: " + c.why_not;
        }
        if (rivals.empty()) return without.empty() ? "the only one here for many points" : without;
        return "measured " + milliseconds(candidates_[best_].seconds) + " ms a search" + rivals + (without.empty() ? "" : "; ") + without;
    }

private:
    static constexpr double share = 0.03, hopeless_factor = 4;

    static bool differ(double a, double b, double factor) { return a > b * factor || b > a * factor; }
    static bool differ(const Facts& a, const Facts& b, double factor) {
        return differ(a.points, b.points, factor) || differ(a.entries / a.points, b.entries / b.points, factor) || differ(a.spread, b.spread, factor) ||
               differ(a.crowding, b.crowding, 4 * factor);
    }
    /// Far behind when last measured, on points much like these.
    bool hopeless(const Candidate& c, const Facts& now) const {
        return c.seconds > hopeless_factor * candidates_[best_].seconds && candidates_[best_].seconds > 0 && !differ(now, c.at, 3);
    }
    static std::string milliseconds(double seconds) {
        char text[32];
        std::snprintf(text, sizeof text, "%.3g", 1e3 * seconds);
        return text;
    }

    std::vector<Candidate> candidates_;
    std::size_t best_ = 0;
    int rounds_ = 0;
    double spent_measuring_ = 0, spent_searching_ = 0;
};

}  // namespace grainray::neighbors
