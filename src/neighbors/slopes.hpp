// How a figure answers to two knobs, measured while both move a little all the time: least squares over the differences between one
// time and the next, so that a slow drift does not matter, as a correction of what a model expects. It fades, as the world changes.
#pragma once

#include <algorithm>

namespace grainray {

class Slopes {
public:
    struct Pair {
        double a, b;  ///< one for each knob
    };

    /// value: of the figure where the knobs stood at `knobs`; expected: its slopes by the model.
    void learn(double value, Pair knobs, Pair expected) {
        const Pair moved{knobs.a - knobs_.a, knobs.b - knobs_.b};
        const double unexpected = std::clamp(value - value_ - moved.a * expected.a - moved.b * expected.b, -outlier, outlier);
        const bool follows = follows_;
        value_ = value;
        knobs_ = knobs;
        follows_ = true;
        if (!follows) return;
        aa_ = memory * aa_ + moved.a * moved.a;
        ab_ = memory * ab_ + moved.a * moved.b;
        bb_ = memory * bb_ + moved.b * moved.b;
        ra_ = memory * ra_ + moved.a * unexpected;
        rb_ = memory * rb_ + moved.b * unexpected;
    }
    /// The next value cannot be compared with the last.
    void interrupt() { follows_ = false; }

    /// What to add to the slopes expected.
    Pair correction() const {
        const double aa = aa_ + trust, bb = bb_ + trust, determinant = aa * bb - ab_ * ab_;
        return {(ra_ * bb - rb_ * ab_) / determinant, (rb_ * aa - ra_ * ab_) / determinant};
    }

private:
    static constexpr double memory = 0.96;  ///< kept from one time to the next
    static constexpr double trust = 0.15;   ///< in the model: the sum of squares of moves that counts as much
    static constexpr double outlier = 0.2;

    bool follows_ = false;
    double value_ = 0, aa_ = 0, ab_ = 0, bb_ = 0, ra_ = 0, rb_ = 0;
    Pair knobs_{};
};

}  // namespace grainray
