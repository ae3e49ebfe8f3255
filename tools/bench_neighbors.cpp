// grainray bench neighbors: the search alone, on clouds of points with about ten neighbours each.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "grainray/neighbors.hpp"
#include "grainray/output.hpp"
#include "setup.hpp"

namespace grainray::cli {
namespace {

constexpr std::size_t brute_limit = 50'000;  // all pairs of more points take too long to be in a default table
constexpr int least_repeats = 3, most_repeats = 20;
constexpr double enough_seconds = 1;

struct Options {
    std::vector<std::int64_t> points{20'000, 200'000};
    std::string backend = "auto", kind = "half", device = "auto";
    int threads = 0;
    std::filesystem::path json;
};

struct Cloud {
    std::string name;
    float reach;
    std::vector<float> xyz;
};

/// One point a unit of volume; the sphere of radius 2 reach holds ten of them.
Cloud random_cloud(std::size_t n) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(0, std::cbrt(static_cast<float>(n)));
    Cloud cloud{"random", 0.5f * std::cbrt(10 / (4.0f / 3.0f * 3.14159265f)), std::vector<float>(3 * n)};
    for (float& x : cloud.xyz) x = place(random);
    return cloud;
}

/// A cubic lattice of unit spacing, each point moved a little; its order is that of the lattice.
Cloud lattice_cloud(std::size_t n) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> shift(0, 0.3f);
    const auto side = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(n))));
    Cloud cloud{"lattice", 0.7f, {}};
    for (std::size_t i = 0; i < n; ++i)
        for (const std::size_t k : {i % side, i / side % side, i / side / side}) cloud.xyz.push_back(static_cast<float>(k) + shift(random));
    return cloud;
}

struct Measured {
    double milliseconds;  ///< median of build and search together
    std::uint64_t entries;
    std::size_t memory_bytes;
    int repeats;
};

Measured measure(NeighborSearch& search, const Points& points, Device device) {
    NeighborList list(device);
    search.find(points, list);  // grows the buffers
    std::vector<double> times;
    double total = 0;
    while (times.size() < least_repeats || (times.size() < most_repeats && total < enough_seconds)) {
        const auto start = std::chrono::steady_clock::now();
        search.find(points, list);
        std::uint32_t last = 0;  // reading a result waits for the device
        if (list.neighbors.size()) detail::copy(Device::cpu, &last, device, list.neighbors.data() + list.neighbors.size() - 1, sizeof last);
        times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        total += times.back();
    }
    std::sort(times.begin(), times.end());
    return {1e3 * times[times.size() / 2], list.neighbors.size(), search.memory_bytes() + list.offsets.bytes() + list.neighbors.bytes(),
            static_cast<int>(times.size())};
}

nlohmann::ordered_json bench_one(const Cloud& cloud, const std::string& backend, const Options& options, Device device) {
    SearchOptions search_options;
    search_options.backend = backend;
    search_options.kind = options.kind == "half" ? ListKind::half : ListKind::full;
    search_options.ascending = false;
    NeighborSearch search(device, search_options);
    const std::size_t n = cloud.xyz.size() / 3;
    const Array<float> xyz(device, cloud.xyz);
    const Measured m = measure(search, Points::xyz(xyz.data(), n, cloud.reach), device);
    const double both_sides = static_cast<double>(m.entries) * (options.kind == "half" ? 2 : 1);
    fmt::print("{:<8} {:>10} {:<7} {:>10.3f} {:>12.2f} {:>14} {:>11.1f}\n", cloud.name, n, search.backend(), m.milliseconds,
               both_sides / static_cast<double>(n), short_number(1e3 * static_cast<double>(m.entries) / m.milliseconds),
               static_cast<double>(m.memory_bytes) / static_cast<double>(n));
    return {{"cloud", cloud.name}, {"points", n}, {"backend", search.backend()}, {"milliseconds", m.milliseconds}, {"repeats", m.repeats},
            {"mean_neighbors", both_sides / static_cast<double>(n)}, {"list_entries", m.entries},
            {"neighbors_per_second", 1e3 * static_cast<double>(m.entries) / m.milliseconds}, {"memory_bytes", m.memory_bytes}};
}

int bench_neighbors(const Options& options) {
    require_choice("--kind", options.kind, {"half", "full"});
    for (const std::int64_t n : options.points) require_at_least("--points", n, 1);
    require_at_least("--threads", options.threads, 0);
    require_writable("--json", options.json);
    const Device device = choose_search_device(options.device);
    if (options.backend != "all") require_backend("--backend", options.backend, device);
    const ThreadLimit limit(options.threads);
    nlohmann::ordered_json json{{"version", GRAINRAY_VERSION}, {"benchmark", "neighbors"}, {"device", std::string(name(device))},
                                {"threads", ThreadLimit::count()}, {"kind", options.kind}, {"results", nlohmann::ordered_json::array()}};
    fmt::print("build and search, {} lists, on {} with {} threads\n", options.kind, name(device), ThreadLimit::count());
    fmt::print("{:<8} {:>10} {:<7} {:>10} {:>12} {:>14} {:>11}\n", "cloud", "points", "search", "ms", "neighbours", "entries/s", "bytes/point");
    for (const std::int64_t n : options.points)
        for (const Cloud& cloud : {random_cloud(static_cast<std::size_t>(n)), lattice_cloud(static_cast<std::size_t>(n))}) {
            std::vector<std::string> backends{options.backend};
            if (options.backend == "all") {
                backends.clear();
                for (const BackendInfo& info : search_backends(device))
                    if (info.available && (info.name != "brute" || static_cast<std::size_t>(n) <= brute_limit)) backends.push_back(info.name);
            }
            for (const std::string& backend : backends) json["results"].push_back(bench_one(cloud, backend, options, device));
        }
    if (!options.json.empty()) write_text_atomically(options.json, json.dump(2) + '\n');
    return done;
}

}  // namespace

void add_bench_neighbors(CLI::App& bench, Action& chosen) {
    CLI::App* command = bench.add_subcommand("neighbors", "Time of the neighbour search on random and lattice clouds");
    const auto options = std::make_shared<Options>();
    command->add_option("--points", options->points, "Numbers of points, with commas between")->delimiter(',')->allow_extra_args(false)->type_name("N,...");
    command->add_option("--backend", options->backend, "auto, brute, cells, or all (brute force up to 50,000 points)")->capture_default_str();
    command->add_option("--kind", options->kind, "half: each pair once; full: in both rows")->capture_default_str();
    command->add_option("--device", options->device, "auto, cpu or cuda")->capture_default_str();
    command->add_option("--threads", options->threads, "CPU threads; 0: all")->capture_default_str();
    command->add_option("--json", options->json, "Write the figures to this file")->type_name("FILE")->check(not_empty());
    command->footer("Example: grainray bench neighbors --points 1000,100000 --backend all --json neighbors.json");
    command->callback([options, &chosen] { chosen = [options] { return bench_neighbors(*options); }; });
}

}  // namespace grainray::cli
