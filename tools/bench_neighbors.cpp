// grainray bench neighbors: the search alone, by back ends, on clouds of points with about ten neighbours each.
#include <algorithm>
#include <cstdio>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench_contest.hpp"
#include "command.hpp"
#include "grainray/output.hpp"
#include "setup.hpp"

namespace grainray::cli {
namespace {

constexpr std::size_t brute_limit = 20'000;  // all pairs of more points take too long to be among "all"

struct Options {
    std::vector<std::int64_t> points{20'000, 200'000};
    std::vector<std::string> clouds{"random", "lognormal"}, backends{"auto"};
    std::vector<double> ratios{8};
    std::string kind = "half", order = "morton", device = "auto", machine;
    double seconds = 0.5, longest = 20;
    int threads = 0;
    std::filesystem::path json;
    Peers peers = nullptr;
};

void require_options(const Options& options) {
    require_choice("--kind", options.kind, {"half", "full"});
    require_choice("--order", options.order, {"morton", "random"});
    for (const std::int64_t n : options.points) require_at_least("--points", n, 1);
    for (const double r : options.ratios)
        if (!(r >= 1 && r <= 1000)) throw InputError(fmt::format("--ratio: {} is not a ratio of sizes; give 1 to 1000", r));
    if (!(options.seconds > 0)) throw InputError("--seconds must be above 0");
    if (!(options.longest > 0)) throw InputError("--longest must be above 0");
    std::vector<std::string> known = cloud_names();
    known.push_back("all");
    for (const std::string& cloud : options.clouds) require_choice("--cloud", cloud, known);
    require_at_least("--threads", options.threads, 0);
    require_writable("--json", options.json);
}

bool is_all(const std::vector<std::string>& names) { return std::find(names.begin(), names.end(), "all") != names.end(); }

struct CloudName {
    std::string name;
    double ratio;
};
/// Clouds of several sizes stand once for each ratio.
std::vector<CloudName> clouds_of(const Options& options) {
    std::vector<CloudName> all;
    for (const std::string& name : is_all(options.clouds) ? cloud_names() : options.clouds) {
        if (!has_sizes(name)) all.push_back({name, 1});
        else
            for (const double ratio : options.ratios) all.push_back({name, ratio});
    }
    return all;
}

std::vector<std::string> backends_of(const Options& options, Device device, std::size_t points) {
    if (!is_all(options.backends)) return options.backends;
    std::vector<std::string> all;
    for (const BackendInfo& info : search_backends(device))
        if (info.available && (info.name != "brute" || points <= brute_limit)) all.push_back(info.name);
    return all;
}

/// Throws SimulationError where two back ends found different numbers of pairs.
void require_equal(const Cloud& cloud, const std::vector<Figures>& all) {
    const Figures* first = nullptr;
    for (const Figures& f : all) {
        if (!f.failure.empty()) continue;
        if (first && f.entries != first->entries)
            throw SimulationError(fmt::format("cloud {} of {}: {} found {} entries and {} found {}; please report this", cloud.name,
                                              counted(cloud.size(), "point"), first->name, first->entries, f.name, f.entries));
        if (!first) first = &f;
    }
}

/// Who took too long on a cloud: "rays-published on two-size".
using TooSlow = std::set<std::string>;

void bench_cloud(const CloudName& which, std::size_t points, const Options& options, Device device, TooSlow& too_slow, nlohmann::ordered_json& results) {
    const Cloud cloud = make_cloud(which.name, which.ratio, points, options.order);
    const Array<float> xyz(device, cloud.xyz), moved(device, moved_xyz(cloud)), reach(device, cloud.reach);
    std::vector<Contender> contenders;
    for (const std::string& backend : backends_of(options, device, points)) {
        SearchOptions search;
        search.backend = backend;
        search.kind = options.kind == "half" ? ListKind::half : ListKind::full;
        search.ascending = false;
        search.local_order = options.order == "morton";
        contenders.push_back(contender(device, search, points_of(xyz, reach), points_of(moved, reach)));
    }
    const std::size_t ours = contenders.size();
    if (options.peers && options.kind == "full")  // they fill no others
        for (Contender& peer : options.peers(device, cloud)) contenders.push_back(std::move(peer));
    for (Contender& c : contenders)
        if (too_slow.contains(c.name + " on " + cloud.name))
            c.search = [&options]() -> std::uint64_t { throw SimulationError(fmt::format("left out: took longer than {:g} s before", options.longest)); };
    std::vector<Figures> all = take_turns(contenders, options.seconds);
    for (std::size_t c = 0; c < all.size(); ++c) {
        results.push_back(row_json(cloud, options.kind == "full", all[c]));
        // Peers round in their own way, so pairs on the very reach may differ.
        if (c >= ours && all[c].failure.empty() && all[0].failure.empty()) results.back()["entries_differ"] = static_cast<std::int64_t>(all[c].entries - all[0].entries);
        if (all[c].least > 1e3 * options.longest) too_slow.insert(all[c].name + " on " + cloud.name);
        print_row(results.back());
    }
    std::fflush(stdout);
    all.resize(ours);
    require_equal(cloud, all);
}

int bench_neighbors(const Options& options) {
    require_options(options);
    const Device device = choose_search_device(options.device);
    if (!is_all(options.backends))
        for (const std::string& backend : options.backends) require_backend("--backend", backend, device);
    const ThreadLimit limit(options.threads);
    nlohmann::ordered_json json{{"version", GRAINRAY_VERSION}, {"benchmark", "neighbors"}, {"machine", machine_json(device, options.machine, ThreadLimit::count())},
                                {"kind", options.kind}, {"results", nlohmann::ordered_json::array()}};
    fmt::print("{}, {} threads, {} lists, points in {} order\n", json["machine"]["name"].get<std::string>(), ThreadLimit::count(), options.kind, options.order);
    print_heading();
    TooSlow too_slow;
    for (const std::int64_t n : options.points)
        for (const CloudName& which : clouds_of(options)) {
            bench_cloud(which, static_cast<std::size_t>(n), options, device, too_slow, json["results"]);
            // After each cloud, so that a run that is stopped leaves what it has measured.
            if (!options.json.empty()) write_text_atomically(options.json, json.dump(2) + '\n');
        }
    return done;
}

}  // namespace

void add_bench_neighbors(CLI::App& bench, Action& chosen) { add_bench_neighbors(bench, chosen, nullptr); }

void add_bench_neighbors(CLI::App& bench, Action& chosen, Peers peers) {
    Command command(bench, chosen, "neighbors", "Time of the neighbour search by back ends, on clouds of points");
    const auto options = std::make_shared<Options>();
    options->peers = peers;
    if (peers) options->kind = "full";
    command.list("--points", options->points, "N,...", "Numbers of points, with commas between; default 20000,200000");
    command.list("--cloud", options->clouds, "NAME,...", "random, lattice, lognormal, two-size, sparse, clustered, or all; default random,lognormal");
    command.list("--ratio", options->ratios, "R,...", "Largest reach by smallest, of lognormal and two-size; default 8");
    command.list("--backend", options->backends, "NAME,...", "Back ends as `grainray info` names them, auto, or all (brute force up to 20,000 points)");
    command.option_with_default("--kind", options->kind, "", "half: each pair once; full: in both rows");
    command.option_with_default("--order", options->order, "", "Of the points in memory: morton, as a simulation keeps them, or random");
    command.option_with_default("--device", options->device, "", "auto, cpu or cuda");
    command.option_with_default("--threads", options->threads, "", "CPU threads; 0: all");
    command.option_with_default("--seconds", options->seconds, "", "Time for each row, about; at least three repeats, at most 20");
    command.option_with_default("--longest", options->longest, "", "A back end that takes more seconds on a cloud is left out of that cloud from then on");
    command.option("--machine", options->machine, "NAME", "Name of this machine in the file; default: its GPU or processor");
    command.option("--json", options->json, "FILE", "Write the figures to this file");
    command.footer("Example: grainray bench neighbors --cloud two-size --ratio 1,2,4,8,16,32 --backend all --json neighbors.json");
    command.action([options] { return bench_neighbors(*options); });
}

}  // namespace grainray::cli
