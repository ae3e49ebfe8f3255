// grainray_peers: the options of `grainray bench neighbors`, with every peer that this build has.
#include <CLI/CLI.hpp>

#include <cstdio>

#include "peers.hpp"

namespace grainray::peers {
namespace {

std::vector<cli::Contender> all([[maybe_unused]] Device device, [[maybe_unused]] const cli::Cloud& cloud) {
    std::vector<cli::Contender> found;
#ifdef GRAINRAY_PEER_NANOFLANN
    if (device == Device::cpu) found.push_back(nanoflann(cloud));
#endif
#ifdef GRAINRAY_PEER_ARBORX
    if (device == arborx_device()) found.push_back(arborx(cloud));
#endif
#ifdef GRAINRAY_PEER_CUNSEARCH
    if (device == Device::cuda && !(cloud.ratio > 1)) found.push_back(cunsearch(cloud));
#endif
    return found;
}

}  // namespace
}  // namespace grainray::peers

int main(int argc, char** argv) {
    CLI::App app("Neighbour search beside other libraries");
    app.require_subcommand(1);
    grainray::cli::Action chosen;
    grainray::cli::add_bench_neighbors(app, chosen, grainray::peers::all);
    CLI11_PARSE(app, argc, argv);
    try {
        return chosen();
    } catch (const grainray::Error& e) {
        std::fprintf(stderr, "grainray_peers: %s\n", e.what());
        return dynamic_cast<const grainray::InputError*>(&e) ? grainray::cli::input_wrong : grainray::cli::simulation_failed;
    }
}
