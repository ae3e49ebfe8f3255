#include "bench_contest.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

namespace grainray::cli {
namespace {

constexpr int least_rounds = 3, most_rounds = 20;
constexpr double long_search = 5;  // seconds; one round of such is enough

using Clock = std::chrono::steady_clock;

template <class F>
double seconds_of(const F& f) {
    const auto start = Clock::now();
    f();
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Runs f; what it throws becomes the figures' failure.
template <class F>
void attempt(Figures& figures, const F& f) {
    if (!figures.failure.empty()) return;
    try {
        f();
    } catch (const Error& e) {
        figures.failure = e.what();
    }
}

bool needs_more(const std::vector<double>& times, double used, double seconds) {
    const int rounds = static_cast<int>(times.size());
    if (rounds == 0) return true;
    if (rounds < least_rounds) return used < long_search;
    return rounds < most_rounds && used < seconds;
}

/// What this library's contender works with.
struct Searcher {
    Device device;
    Points points, one;
    NeighborSearch search;
    NeighborList list, row;

    Searcher(Device d, const SearchOptions& options, const Points& p) : device(d), points(p), one(p), search(d, options), list(d), row(d) {
        one.size = std::min<std::size_t>(p.size, 1);
    }

    /// Reading a result waits for the device.
    std::uint64_t entries(const NeighborList& l) const {
        std::uint64_t last = 0;
        if (l.offsets.size()) detail::copy(Device::cpu, &last, device, l.offsets.data() + l.offsets.size() - 1, sizeof last);
        std::uint32_t neighbor = 0;
        if (last) detail::copy(Device::cpu, &neighbor, device, l.neighbors.data() + last - 1, sizeof neighbor);
        return last;
    }
};

}  // namespace

std::vector<Figures> take_turns(const std::vector<Contender>& contenders, double seconds) {
    std::vector<Figures> all(contenders.size());
    std::vector<std::vector<double>> times(contenders.size());
    std::vector<double> used(contenders.size());
    for (std::size_t c = 0; c < contenders.size(); ++c) {
        all[c].name = contenders[c].name;
        attempt(all[c], [&] { all[c].entries = contenders[c].search(); });
    }
    for (bool more = true; more;) {
        more = false;
        for (std::size_t c = 0; c < contenders.size(); ++c) {
            if (!all[c].failure.empty() || !needs_more(times[c], used[c], seconds)) continue;
            more = true;
            attempt(all[c], [&] { times[c].push_back(seconds_of(contenders[c].search)); });
            if (!times[c].empty()) used[c] += times[c].back();
        }
    }
    for (std::size_t c = 0; c < contenders.size(); ++c) {
        Figures& f = all[c];
        if (!f.failure.empty()) continue;
        std::sort(times[c].begin(), times[c].end());
        f.repeats = static_cast<int>(times[c].size());
        f.median_ms = 1e3 * times[c][times[c].size() / 2];
        f.least_ms = 1e3 * times[c].front();
        if (contenders[c].memory_bytes) f.memory_bytes = contenders[c].memory_bytes();
        if (!contenders[c].build) continue;
        for (int k = 0; k < std::min(f.repeats, least_rounds); ++k)
            attempt(f, [&] {
                const double ms = 1e3 * seconds_of(contenders[c].build);
                f.build_ms = k == 0 ? ms : std::min(f.build_ms, ms);
            });
    }
    return all;
}

Contender contender(Device device, const SearchOptions& options, const Array<float>& xyz, const Array<float>& reach) {
    const auto s = std::make_shared<Searcher>(device, options, points_of(xyz, reach));
    return {options.backend,
            [s] { s->search.find(s->points, s->list); return s->entries(s->list); },
            [s] { s->search.find(s->one, s->points, s->row); s->entries(s->row); },
            [s] { return s->search.memory_bytes() + s->list.offsets.bytes() + s->list.neighbors.bytes(); }};
}

nlohmann::ordered_json row_json(const Cloud& cloud, bool both_sides, const Figures& f) {
    nlohmann::ordered_json row{{"cloud", cloud.name}, {"ratio", cloud.ratio}, {"order", cloud.order}, {"points", cloud.size()}, {"backend", f.name}};
    if (!f.failure.empty()) {
        row["failure"] = f.failure;
        return row;
    }
    const double neighbors = static_cast<double>(f.entries) * (both_sides ? 1 : 2);
    row["neighbors_per_point"] = neighbors / static_cast<double>(std::max<std::size_t>(cloud.size(), 1));
    row["milliseconds"] = f.median_ms;
    row["milliseconds_min"] = f.least_ms;
    if (f.build_ms > 0) row["milliseconds_build"] = f.build_ms;
    row["repeats"] = f.repeats;
    row["list_entries"] = f.entries;
    row["entries_per_second"] = 1e3 * static_cast<double>(f.entries) / f.median_ms;
    if (f.memory_bytes) row["memory_bytes"] = f.memory_bytes;
    return row;
}

void print_heading() {
    fmt::print("{:<10} {:>5} {:>10} {:<15} {:>10} {:>10} {:>10} {:>10} {:>10} {:>11}\n", "cloud", "ratio", "points", "search", "ms", "least", "build",
               "neighbours", "entries/s", "bytes/point");
}

void print_row(const nlohmann::ordered_json& row) {
    fmt::print("{:<10} {:>5g} {:>10} {:<15} ", row["cloud"].get<std::string>(), row["ratio"].get<double>(), row["points"].get<std::size_t>(),
               row["backend"].get<std::string>());
    if (row.contains("failure")) {
        fmt::print("{}\n", row["failure"].get<std::string>());
        return;
    }
    const auto number = [&](const char* key) { return row.contains(key) ? row[key].get<double>() : 0; };
    const double rate = number("entries_per_second"), points = std::max(number("points"), 1.0);
    fmt::print("{:>10.3f} {:>10.3f} {:>10} {:>10.2f} {:>9.1f}M {:>11}{}\n", number("milliseconds"), number("milliseconds_min"),
               row.contains("milliseconds_build") ? fmt::format("{:.3f}", number("milliseconds_build")) : "-", number("neighbors_per_point"), rate / 1e6,
               row.contains("memory_bytes") ? fmt::format("{:.0f}", number("memory_bytes") / points) : "-",
               number("entries_differ") != 0 ? fmt::format("  ({:+} entries)", row["entries_differ"].get<std::int64_t>()) : "");
}

}  // namespace grainray::cli
