// Steps and outputs of a run, in batches that end where something is to be written.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "grainray/output.hpp"
#include "grainray/simulation.hpp"
#include "output/queue.hpp"
#include "progress.hpp"
#include "run_folder.hpp"
#include "signals.hpp"

namespace grainray::cli {

/// All in steps. An interval of 0: never, but for the first and the last state.
struct RunPlan {
    std::uint64_t first = 0, last = 0;
    std::uint64_t frames = 0, history = 0, checkpoints = 0;
    bool appends = false;  ///< goes on in the folder of its checkpoint: the first state is there already
    bool has_checkpoint = false;  ///< the folder's checkpoint is the first state
    std::uint64_t frame_index(std::uint64_t step) const;
};
/// Intervals of the scene in whole steps.
RunPlan plan_run(const Scene&, std::uint64_t first, std::uint64_t last, bool appends);

class RunLoop {
public:
    RunLoop(Simulation&, const Scene&, const RunFolder&, const RunPlan&, bool quiet);
    /// False where a signal stopped it; its state is then in the checkpoint. Throws SimulationError. In every case what
    /// was handed to the writing thread has been written, up to the first file that could not be.
    bool run();
    Progress& progress() { return progress_; }
    /// "the last good checkpoint is FILE (step N, t = T s)", or that there is none.
    std::string last_checkpoint() const;

private:
    enum Part : unsigned { frame = 1, history = 2, checkpoint = 4 };
    struct Output;

    bool run_to_end();
    unsigned due_now() const;
    void look(unsigned parts);
    void write(unsigned parts);
    std::shared_ptr<const Output> take(unsigned parts) const;
    void write_out(const Output&);
    std::uint64_t next_stop() const;
    void advance(std::uint64_t limit);
    void write_lost();

    Simulation& simulation_;
    const Scene& scene_;
    const RunFolder& folder_;
    RunPlan plan_;
    StopSignals signals_;
    Progress progress_;
    HistoryFile history_;
    std::optional<HistoryFile> lost_, removed_;  ///< of an open terrain, of removals; of the stepping thread alone
    double seconds_per_step_ = 0;
    std::uint64_t asked_checkpoint_, written_checkpoint_;  ///< steps; the second belongs to the writing thread
    OutputQueue queue_;  // last: its jobs use the others
};

}  // namespace grainray::cli
