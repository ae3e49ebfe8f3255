// grainray run: scene -> folder of results.
#include <chrono>
#include <cstdio>
#include <optional>

#include <fmt/format.h>

#include "arguments.hpp"
#include "command.hpp"
#include "preflight.hpp"
#include "restart.hpp"
#include "run_loop.hpp"
#include "setup.hpp"
#include "summary.hpp"

namespace grainray::cli {
namespace {

namespace fs = std::filesystem;
using clock = std::chrono::steady_clock;

struct Options {
    fs::path scene, out, restart;
    EngineOptions engine;
    std::optional<std::int64_t> steps;  ///< none: to the end of the scene
    bool force = false, quiet = false;
};

std::string restart_command(const Options& options, const RunFolder& folder, const Simulation& simulation, std::uint64_t last) {
    std::string command = fmt::format("grainray run {} --restart {} --out {}", folder.scene().string(), folder.checkpoint().string(), folder.path().string());
    if (options.steps) command += fmt::format(" --steps {}", last - simulation.step_count());
    return command;
}

/// One run, from the checks to the summary.
class Run {
public:
    explicit Run(const Options& options)
        : options_(options), limit_(options.engine.threads), scene_(load_resolved(options.scene, options.engine.set)),
          engine_(choose_engine(options.engine, scene_)),
          folder_(options.out.empty() ? fs::path(options.scene.stem().string() + "-out") : options.out, scene_.output.format) {}

    int run() {
        goes_on_ = folder_.goes_on_from(options_.restart);
        std::error_code ignored;
        if (fs::is_directory(folder_.path(), ignored)) lock_.emplace(folder_.path());
        folder_.check(options_.force, goes_on_);
        Simulation simulation = make_simulation();
        const std::uint64_t first = simulation.step_count();
        RunPlan plan = plan_run(scene_, first, range_.last(scene_), goes_on_);
        plan.has_checkpoint = goes_on_ && fs::equivalent(options_.restart, folder_.checkpoint(), ignored);
        facts_.first_step = first;
        facts_.threads = ThreadLimit::count();
        facts_.device_reason = engine_.device_reason;
        prepare_folder();
        print_start(simulation, plan);
        return simulate(simulation, plan);
    }

private:
    Simulation make_simulation() {
        const InitialState particles = place_checked(scene_);
        std::optional<Checkpoint> checkpoint;
        if (!options_.restart.empty()) checkpoint = read_checkpoint(options_.restart);
        if (options_.steps) range_.asked = static_cast<std::uint64_t>(*options_.steps);
        range_.restarted = checkpoint.has_value();
        range_.first = checkpoint ? checkpoint->step : 0;
        if (checkpoint) require_fit(scene_, particles, *checkpoint, options_.restart);
        Preflight preflight = inspect(scene_, particles, range_);
        if (checkpoint) inspect_restart(scene_, *checkpoint, range_, preflight);
        inspect_disk(folder_.path(), preflight);
        inspect_device(scene_, particles, engine_.options, preflight);
        facts_.device_forecast_bytes = preflight.device_bytes();
        insist(preflight, options_.quiet);
        if (!checkpoint) return {scene_, particles, engine_.options};
        return {scene_, *checkpoint, engine_.options};
    }

    void prepare_folder() {
        folder_.create();
        if (!lock_) {
            lock_.emplace(folder_.path());
            folder_.check_still_empty();
        }
        if (!goes_on_) folder_.clear();
        write_text_atomically(folder_.scene(), scene_.source);
    }

    void print_start(const Simulation& simulation, const RunPlan& plan) const {
        if (options_.quiet) return;
        fmt::print(stderr, "grainray {}: {}{}, {} of {} s{}, {} ({}), to {}\n", GRAINRAY_VERSION,
                   scene_.title.empty() ? "" : scene_.title + ": ", counted(simulation.size(), "particle"), counted(plan.last - plan.first, "step"), scene_.dt,
                   plan.first ? fmt::format(" from step {}", plan.first) : "", name(simulation.device()), counted(static_cast<std::uint64_t>(facts_.threads), "thread"), folder_.path().string());
    }

    int simulate(Simulation& simulation, const RunPlan& plan) {
        const auto start = clock::now();
        const auto seconds = [&] { return std::chrono::duration<double>(clock::now() - start).count(); };
        std::unique_ptr<RunLoop> loop;
        try {
            loop = std::make_unique<RunLoop>(simulation, scene_, folder_, plan, options_.quiet);
            const bool finished = loop->run();
            facts_.wall_seconds = seconds();
            facts_.status = finished ? "done" : "interrupted";
            write_text_atomically(folder_.summary(), summary_text(simulation, scene_, facts_));
            return finished ? report_done(simulation) : report_interrupted(simulation, plan);
        } catch (const SimulationError& e) {
            if (loop) loop->progress().clear();
            facts_.wall_seconds = seconds();
            facts_.message = e.what();
            note_failure(simulation);
            throw SimulationError(fmt::format("{}; {}", e.what(), loop ? loop->last_checkpoint() : "no checkpoint was written"));
        }
    }

    /// Best effort: the disk may be what failed.
    void note_failure(const Simulation& simulation) noexcept {
        try {
            facts_.status = "failed";
            write_text_atomically(folder_.summary(), summary_text(simulation, scene_, facts_));
        } catch (const std::exception&) {
        }
    }

    int report_done(const Simulation& simulation) const {
        const std::uint64_t steps = simulation.step_count() - facts_.first_step;
        const double rate = facts_.wall_seconds > 0 ? static_cast<double>(simulation.particle_steps()) / facts_.wall_seconds : 0;
        if (!options_.quiet)
            fmt::print(stderr, "done: {} in {}, {} particle-steps/s{}; state {}; results in {}\n", counted(steps, "step"), duration_text(facts_.wall_seconds),
                       short_number(rate), exchange_text(simulation), hash_text(simulation.state_hash()), folder_.path().string());
        return done;
    }

    int report_interrupted(const Simulation& simulation, const RunPlan& plan) const {
        fmt::print(stderr, "grainray: interrupted at step {} of {}, state saved; go on with: {}\n", simulation.step_count(), plan.last,
                   restart_command(options_, folder_, simulation, plan.last));
        return interrupted;
    }

    const Options& options_;
    ThreadLimit limit_;
    Scene scene_;
    Engine engine_;
    RunFolder folder_;
    std::optional<FolderLock> lock_;
    RunRange range_;
    RunFacts facts_;
    bool goes_on_ = false;
};

int run(const Options& options) {
    if (options.steps) require_steps("--steps", *options.steps, 0);
    return Run(options).run();
}

}  // namespace

void add_run(CLI::App& app, Action& chosen) {
    Command command(app, chosen, "run", "Simulate a scene");
    const auto options = std::make_shared<Options>();
    command.argument("SCENE", options->scene, "Scene file");
    command.engine_options(options->engine);
    command.option("--out", options->out, "DIR", "Folder for the results; else the name of the scene with -out");
    command.option("--steps", options->steps, "N", "Steps from where the run starts; else to the end of the scene");
    command.option("--restart", options->restart, "FILE", "Checkpoint to go on from, exactly");
    command.flag("--force", options->force, "Replace the files of an earlier run in the folder, and no others");
    command.flag("--quiet", options->quiet, "Print errors only");
    command.footer("Example: grainray run examples/column_collapse.toml --set materials.grain.friction=0.3 --out smooth\n"
                    "Ctrl-C saves the state; the command that goes on from it is printed. The folder holds frames/*.vtp\n"
                    "(ParaView, OVITO), history.csv, summary.json, checkpoint.h5 and scene.toml.");
    command.action([options] { return run(*options); });
}

}  // namespace grainray::cli
