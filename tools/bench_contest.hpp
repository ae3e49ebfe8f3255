// Searches that do the same work, timed in turns, so that a busy moment of the machine meets all of them alike.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench_clouds.hpp"
#include "commands.hpp"

namespace grainray::cli {

struct Contender {
    std::string name;
    std::function<std::uint64_t()> search;      ///< everything: structure, neighbours, list; waits; returns the list's entries
    std::function<void()> update;               ///< the same after the points moved a little, keeping what can be kept; or empty
    std::function<void()> build;                ///< the structure alone; empty where it cannot be had alone
    bool keeps = false;                         ///< a second build in a row may refit the first one's structure
    std::function<std::size_t()> memory_bytes;  ///< of the searcher and its list; empty: not known
};

/// Milliseconds; a time that is not known is 0.
struct Figures {
    std::string name, failure;  ///< failure: why there are no figures, else empty
    double median = 0, least = 0;
    double processor = 0;                     ///< least time of the processor, all threads together: what others do on it counts less
    double update = 0, build = 0, refit = 0;  ///< medians
    std::uint64_t entries = 0;
    std::size_t memory_bytes = 0;
    int repeats = 0;
};

/// Each once to warm up, then in rounds until each has used `seconds`: three rounds at least, 20 at most. A search that
/// takes longer than five seconds is done once.
std::vector<Figures> take_turns(const std::vector<Contender>&, double seconds);

/// A search of this library; `moved` are the points after a short while. The arrays must outlive the contender. `build`
/// asks for the neighbours of one query.
Contender contender(Device, const SearchOptions&, const Points&, const Points& moved);

/// Searches of other libraries over a cloud, full lists (benchmarks/neighbors/peers).
using Peers = std::vector<Contender> (*)(Device, const Cloud&);
/// `bench neighbors`, where peers take turns with this library's back ends.
void add_bench_neighbors(CLI::App& bench, Action& chosen, Peers peers);

/// One row of the results; `both_sides`: the list holds each pair twice.
nlohmann::ordered_json row_json(const Cloud&, bool both_sides, const Figures&);
void print_heading();
void print_row(const nlohmann::ordered_json& row);

/// What figures of several machines are told apart by. `name` empty: the GPU's or the processor's.
nlohmann::ordered_json machine_json(Device, const std::string& name, int threads);

}  // namespace grainray::cli
