// Refit or rebuild, from measured costs. A tree of boxes may be refitted to points that have moved, which is cheaper than a
// new one but leaves it worse, so that each later search takes dq longer. Over a cycle of one rebuild and k refits the cost
// of an update is least at k = -1 + sqrt(1 + 2 (t_rebuild - t_refit) / dq) (arXiv 2601.15633).
#pragma once

#include <algorithm>
#include <cmath>

namespace grainray::neighbors::rays {

class RefitPolicy {
public:
    /// Whether the next update should rebuild.
    bool rebuild() const { return refits_ >= cycle(); }

    /// How many refits to let a tree live through.
    int cycle() const {
        if (rebuild_ == 0 || refit_ == 0 || growth_ == 0) return first_cycle;
        const double saved = rebuild_ - refit_;
        if (saved <= 0) return 0;
        if (growth_ < 0) return longest_cycle;
        return static_cast<int>(std::min<double>(longest_cycle, std::sqrt(1 + 2 * saved / growth_) - 1));
    }

    /// The tree was made or refitted, and then searched; times in any one unit, 0 where one is not known.
    void rebuilt(double build_time, double search_time) {
        refits_ = 0;
        smooth(rebuild_, build_time);
        fresh_search_ = search_time;
    }
    void refitted(double refit_time, double search_time) {
        ++refits_;
        smooth(refit_, refit_time);
        if (fresh_search_ > 0 && search_time > 0) smooth(growth_, (search_time - fresh_search_) / refits_);
    }

private:
    static constexpr int first_cycle = 4, longest_cycle = 100;
    static void smooth(double& mean, double value) {
        if (value != 0) mean = mean == 0 ? value : 0.8 * mean + 0.2 * value;
    }
    double rebuild_ = 0, refit_ = 0, growth_ = 0, fresh_search_ = 0;
    int refits_ = 0;
};

}  // namespace grainray::neighbors::rays
