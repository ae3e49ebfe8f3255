// How long a list should last and how wide margins are at least, found while running. The knobs are the interval N and the least
// margin s; the aim is the least time of a step, T = (U + L C) / L, where making a list takes U, it lasts L steps, and one takes C.
// Downhill along each knob is
//   d ln T = u (d ln U - d ln L) + (1 - u) d ln C,   u = U / (U + L C).
// How L answers is known from the particle that ended the list: it had the margin m = own N + s r and left at the speed v, so L grows by
// own / v for a step of N and by r / v for a unit of s; a list that reaches its limit lasts a step more for each of N.
// How U and C answer a model expects: a part of each goes with the entries, which grow as (1 + w)^3, where w is what searches reach
// beyond the radius, margins and shear, so all of it but s grows with N; an entry more costs a step the less the more of the others
// touch. What is off is measured (slopes.hpp): on a GPU
// the few widest margins may cost more than all others, and one boulder's row more than all grains'. For that the knobs of successive
// lists go round a small square. Choices change the time alone, never the trajectory.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include "neighbors/slopes.hpp"

namespace grainray {

class IntervalTuner {
public:
    /// A list that came to its end.
    struct Life {
        double steps, limit;  ///< how long it lasted, and would have at most
        double entries, particles;
        double widening;      ///< w
        double update_seconds, contact_seconds;  ///< its making; the forces of pairs in all its steps (fused: whole steps)
        double boundary_seconds = 0;             ///< the forces of planes and facets in all its steps
        /// The particle that left its margin: m and v a step, in radii; 0 where a wider margin was no use to it, or nobody looked.
        double leaver_margin = 0, leaver_speed = 0;
        double touching = -1;  ///< share of the entries that touch; below 0: not known
        bool early() const { return steps < limit; }
    };

    /// interval, skin > 0: fixed.
    explicit IntervalTuner(double interval = 0, double skin = 0)
        : interval_(interval > 0 ? interval : 24), skin_(skin > 0 ? skin : 0.03), interval_fixed_(interval > 0), skin_fixed_(skin > 0) {}

    static constexpr std::uint32_t shortest = 4, longest = 200;

    /// N and s of the next list; s: of the particle's radius.
    double interval() const {
        return interval_fixed_ ? interval_ : std::clamp<double>(interval_ * std::exp(side * corner(0)), shortest, most());
    }
    double skin() const { return skin_fixed_ ? skin_ : std::clamp(skin_ + side * corner(1) * std::min(margin_, 2 * skin_), least_skin, widest_skin); }

    /// Whether to look who ended the present list: it takes a little time.
    bool looks() const { return (lists_ < 32 || lists_ % 2 == 0) && !(interval_fixed_ && skin_fixed_); }

    /// A list meant for more steps, or with a wider least margin, has become too large.
    void shorten(double interval, double skin) {
        if (!interval_fixed_) interval_ = most_ = std::min(interval_, interval);
        if (!skin_fixed_) skin_ = std::clamp(skin, least_skin, skin_);
        shortened_ = true;
    }

    void finished(const Life& life) {
        if (life.steps == 0 || life.entries == 0 || life.widening <= 0) return;
        if (!(life.update_seconds > 0 && life.contact_seconds > 0 && life.boundary_seconds >= 0)) return;  // a caller has set its profile to zero meanwhile
        smooth(update_, life.update_seconds);
        smooth(contact_, life.contact_seconds);
        smooth(boundary_, life.boundary_seconds);
        const double all = update_ + contact_ + boundary_, u = update_ / all;
        const Slopes::Pair expected = model(life, u, contact_ / all);
        if (shortened_) slopes_.interrupt();  // it was made twice
        else slopes_.learn(u * std::log(life.update_seconds) + (1 - u) * std::log((life.contact_seconds + life.boundary_seconds) / life.steps),
                           {std::log(life.limit), skin() / margin_}, expected);
        shortened_ = false;
        most_ = std::min<double>(1.04 * most_, longest);  // what was too large may fit again when motion calms down
        const bool heard = life.limit >= std::floor(interval());
        if (!heard && !interval_fixed_) interval_ = std::max<double>({shortest, life.limit, 0.9 * interval_});  // motion bounds it: do not drift off
        if (looks()) move(life, u, expected, heard);
        ++lists_;
    }

    /// "a list takes 2.1 ms and is meant for 24 steps; least margin 0.08 r"; empty before the first list ends.
    std::string reason() const {
        if (update_ == 0) return {};
        char text[128];
        std::snprintf(text, sizeof text, "a list takes %.3g ms and is meant for %.3g steps; least margin %.2g r", 1e3 * update_, interval_, skin_);
        return text;
    }

private:
    static constexpr double side = 0.1;                      ///< half a side of the square, in ln N and, at most, in s over leavers' margins
    static constexpr double entries_worth_a_particle = 3.4;  ///< an update's time a particle over its time an entry
    static constexpr double contacts_cost = 3.1;             ///< of a step: an entry that touches, over one that does not
    static constexpr double usual_touching = 0.7;            ///< where it is not known
    static constexpr double least_skin = 0.01, widest_skin = 0.4;

    static void smooth(double& mean, double value) { mean = mean > 0 ? 0.9 * mean + 0.1 * value : value; }
    /// Downhill, but never far: one list says little.
    static double step(double rate, double down) { return rate * std::clamp(down, -0.4, 0.4); }
    double most() const { return std::max<double>(shortest, most_); }
    /// -1 or 1: where in the square the present list stands.
    double corner(int knob) const { return (lists_ + (knob == 0 ? 1 : 0)) % 4 < 2 ? 1 : -1; }

    /// What one more entry, which does not touch, costs a step of one on average.
    static double candidate_share(const Life& life) {
        const double touching = life.touching < 0 ? usual_touching : life.touching;
        return 1 / (1 + (contacts_cost - 1) * touching);
    }

    /// u d ln U + (1 - u) d ln C, for d ln N and for d s over leavers' margins. Of C the model knows pairs, which have the share c;
    /// candidates of facets are measured alone.
    Slopes::Pair model(const Life& life, double u, double c) const {
        const double w = life.widening, of_update = life.entries / (life.entries + entries_worth_a_particle * life.particles);
        const double widening = (u * of_update + c * candidate_share(life)) * 3 / (1 + w);
        return {widening * std::max(w - skin(), 0.05 * w), widening * margin_};
    }

    void move(const Life& life, double u, Slopes::Pair expected, bool heard) {
        double by_interval = 1, by_skin = 0;  // d ln L
        if (life.early()) {
            const double way = std::max(life.leaver_speed * life.steps, life.leaver_margin);  // of a list's life at that speed
            by_interval = way > 0 ? std::max(0.0, life.leaver_margin - skin()) / way : 0;
            by_skin = way > 0 ? margin_ / way : 0;
            if (way > 0) smooth(margin_, std::clamp(life.leaver_margin, 0.02, 0.5));
        }
        const Slopes::Pair off = slopes_.correction();
        if (!interval_fixed_ && heard)
            interval_ = std::clamp<double>(interval_ * std::exp(step(0.6, u * by_interval - std::max(0.0, expected.a + off.a))), shortest, most());
        if (!skin_fixed_)
            skin_ = std::clamp(skin_ + margin_ * step(0.4, u * by_skin - std::max(0.0, expected.b + off.b)), least_skin, widest_skin);
    }

    double interval_, skin_;
    bool interval_fixed_, skin_fixed_, shortened_ = false;
    std::uint32_t lists_ = 0;
    double update_ = 0, contact_ = 0, boundary_ = 0;  ///< seconds of a list lately
    double margin_ = 0.1;              ///< of leavers lately, radii
    double most_ = longest;            ///< steps that fit lately
    Slopes slopes_;
};

}  // namespace grainray
