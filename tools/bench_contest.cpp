#include "bench_contest.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>

#include <fmt/format.h>

namespace grainray::cli {
namespace {

constexpr int least_rounds = 3, most_rounds = 20;
constexpr double long_search = 5;  // seconds; the warm-up of such is enough

using Clock = std::chrono::steady_clock;

template <class F>
double seconds_of(const F& f) {
    const auto start = Clock::now();
    f();
    return std::chrono::duration<double>(Clock::now() - start).count();
}

double processor_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
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

/// The times of one contender, a round each.
struct Times {
    std::vector<double> search, processor, update, build, refit;
    double used = 0;

    /// A search that follows a build cannot keep anything of the last search, and the other way round.
    void round(const Contender& c) {
        const double before = processor_seconds();
        search.push_back(seconds_of(c.search));
        processor.push_back(processor_seconds() - before);
        used += search.back();
        if (c.update) update.push_back(seconds_of(c.update));
        if (c.build) build.push_back(seconds_of(c.build));
        if (c.build && c.keeps) refit.push_back(seconds_of(c.build));
    }
    bool wants_more(double seconds) const {
        const int rounds = static_cast<int>(search.size());
        if (rounds < least_rounds) return rounds == 0 || used < long_search;
        return rounds < most_rounds && used < seconds;
    }
};

double median_ms(std::vector<double> times) {
    std::sort(times.begin(), times.end());
    return times.empty() ? 0 : 1e3 * times[times.size() / 2];
}

void summarize(const Times& times, Figures& f) {
    f.repeats = static_cast<int>(times.search.size());
    f.median = median_ms(times.search);
    f.least = 1e3 * *std::min_element(times.search.begin(), times.search.end());
    if (!times.processor.empty()) f.processor = 1e3 * *std::min_element(times.processor.begin(), times.processor.end());
    f.update = median_ms(times.update);
    f.build = median_ms(times.build);
    f.refit = median_ms(times.refit);
}

/// What this library's contender works with.
struct Searcher {
    Device device;
    Points points, moved, one;
    NeighborSearch search;
    NeighborList list, row;

    Searcher(Device d, const SearchOptions& options, const Points& p, const Points& m)
        : device(d), points(p), moved(m), one(p), search(d, options), list(d), row(d) {
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
    std::uint64_t find(const Points& p) {
        search.find(p, list);
        return entries(list);
    }
    void build() {
        search.find(one, points, row);
        entries(row);
    }
};

}  // namespace

std::vector<Figures> take_turns(const std::vector<Contender>& contenders, double seconds) {
    std::vector<Figures> all(contenders.size());
    std::vector<Times> times(contenders.size());
    for (std::size_t c = 0; c < contenders.size(); ++c) {
        all[c].name = contenders[c].name;
        attempt(all[c], [&] {
            const double before = processor_seconds(), warm_up = seconds_of([&] { all[c].entries = contenders[c].search(); });
            if (warm_up > long_search) {
                times[c].search.push_back(times[c].used = warm_up);
                times[c].processor.push_back(processor_seconds() - before);
            }
            if (contenders[c].memory_bytes) all[c].memory_bytes = contenders[c].memory_bytes();
            if (contenders[c].build) contenders[c].build();
        });
    }
    for (bool more = true; more;) {
        more = false;
        for (std::size_t c = 0; c < contenders.size(); ++c) {
            if (!all[c].failure.empty() || !times[c].wants_more(seconds)) continue;
            more = true;
            attempt(all[c], [&] { times[c].round(contenders[c]); });
        }
    }
    for (std::size_t c = 0; c < contenders.size(); ++c)
        if (all[c].failure.empty()) summarize(times[c], all[c]);
    return all;
}

Contender contender(Device device, const SearchOptions& options, const Points& points, const Points& moved) {
    const auto s = std::make_shared<Searcher>(device, options, points, moved);
    Contender c{options.backend, [s] { return s->find(s->points); }, {}, [s] { s->build(); }, false, [s] {
                    return s->search.memory_bytes() + s->list.offsets.bytes() + s->list.neighbors.bytes();
                }};
    if (device == Device::cuda) {  // on the CPU nothing but memory is kept from call to call
        c.update = [s] { s->find(s->moved); };
        c.keeps = true;
    }
    return c;
}

nlohmann::ordered_json row_json(const Cloud& cloud, bool both_sides, const Figures& f) {
    nlohmann::ordered_json row{{"cloud", cloud.name}, {"ratio", cloud.ratio}, {"order", cloud.order}, {"points", cloud.size()}, {"backend", f.name}};
    if (!f.failure.empty()) {
        row["failure"] = f.failure;
        return row;
    }
    const double neighbors = static_cast<double>(f.entries) * (both_sides ? 1 : 2);
    row["neighbors_per_point"] = neighbors / static_cast<double>(std::max<std::size_t>(cloud.size(), 1));
    row["milliseconds"] = f.median;
    row["milliseconds_min"] = f.least;
    if (f.processor > 0) row["milliseconds_processor"] = f.processor;
    if (f.update > 0) row["milliseconds_update"] = f.update;
    if (f.build > 0) row["milliseconds_build"] = f.build;
    if (f.refit > 0) row["milliseconds_refit"] = f.refit;
    row["repeats"] = f.repeats;
    row["list_entries"] = f.entries;
    row["entries_per_second"] = 1e3 * static_cast<double>(f.entries) / f.median;
    if (f.memory_bytes) row["memory_bytes"] = f.memory_bytes;
    return row;
}

void print_heading() {
    fmt::print("{:<10} {:>5} {:>9} {:<14} {:>9} {:>9} {:>9} {:>9} {:>9} {:>10} {:>10} {:>11}\n", "cloud", "ratio", "points", "search", "ms", "least", "update", "build",
               "refit", "neighbours", "entries/s", "bytes/point");
}

void print_row(const nlohmann::ordered_json& row) {
    fmt::print("{:<10} {:>5g} {:>9} {:<14} ", row["cloud"].get<std::string>(), row["ratio"].get<double>(), row["points"].get<std::size_t>(),
               row["backend"].get<std::string>());
    if (row.contains("failure")) {
        fmt::print("{}\n", row["failure"].get<std::string>());
        return;
    }
    const auto number = [&](const char* key) { return row.contains(key) ? row[key].get<double>() : 0; };
    for (const char* key : {"milliseconds", "milliseconds_min", "milliseconds_update", "milliseconds_build", "milliseconds_refit"})
        fmt::print("{:>9} ", row.contains(key) ? fmt::format("{:.3f}", number(key)) : "-");
    fmt::print("{:>10.2f} {:>9.1f}M {:>11}{}\n", number("neighbors_per_point"), number("entries_per_second") / 1e6,
               row.contains("memory_bytes") ? fmt::format("{:.0f}", number("memory_bytes") / number("points")) : "-",
               row.contains("entries_differ") && number("entries_differ") != 0 ? fmt::format("  ({:+} entries)", number("entries_differ")) : "");
}

}  // namespace grainray::cli
