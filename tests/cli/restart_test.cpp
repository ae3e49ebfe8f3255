// A restart goes on exactly: after a number of steps, after a signal, in the same folder or in another.
#include <signal.h>

#include <algorithm>

#include "grainray/output.hpp"
#include "process.hpp"

namespace grainray::cli_test {
namespace {

/// Frames every 100 steps, history every 50.
const Arguments outputs{"--set", "output.frames=0.01", "--set", "output.history=0.005"};

Arguments with_outputs(Arguments arguments) {
    arguments.insert(arguments.end(), outputs.begin(), outputs.end());
    return arguments;
}

std::size_t count_rows(const std::string& text) { return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')); }

std::size_t count_frames(const fs::path& run) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(run / "frames"), fs::directory_iterator()));
}

TEST(Restart, TwiceTheStepsIsTheSameAsTwoRuns) {
    const Folder folder;
    folder.write("bed.toml", bed());
    ASSERT_EQ(folder.grainray(with_outputs({"run", "bed.toml", "--steps", "800", "--out", "whole"})).status, 0);
    ASSERT_EQ(folder.grainray(with_outputs({"run", "bed.toml", "--steps", "400", "--out", "half"})).status, 0);
    const Result r = folder.grainray({"run", "half/scene.toml", "--restart", "half/checkpoint.h5", "--out", "half", "--steps", "400"});
    ASSERT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(folder.summary("half")["state_hash"], folder.summary("whole")["state_hash"]);
    EXPECT_EQ(folder.summary("half")["steps"], 400);
    EXPECT_EQ(folder.summary("half")["step"], 800);
    EXPECT_EQ(count_frames(folder / "half"), 9u);
    EXPECT_EQ(count_frames(folder / "whole"), 9u);
    EXPECT_EQ(read_frame(folder / "half/frames/000008.vtp").position, read_frame(folder / "whole/frames/000008.vtp").position);
    EXPECT_EQ(count_rows(folder.read("half/history.csv")), count_rows(folder.read("whole/history.csv")));
}

TEST(Restart, IntoAnotherFolder) {
    const Folder folder;
    folder.write("bed.toml", bed());
    ASSERT_EQ(folder.grainray(with_outputs({"run", "bed.toml", "--steps", "250", "--out", "first"})).status, 0);
    ASSERT_EQ(folder.grainray(with_outputs({"run", "bed.toml", "--restart", "first/checkpoint.h5", "--steps", "250", "--out", "second"})).status, 0);
    ASSERT_EQ(folder.grainray(with_outputs({"run", "bed.toml", "--steps", "500", "--out", "whole"})).status, 0);
    EXPECT_EQ(folder.summary("second")["state_hash"], folder.summary("whole")["state_hash"]);
    EXPECT_EQ(read_frame(folder / "second/frames/000005.vtp").position, read_frame(folder / "whole/frames/000005.vtp").position);
    EXPECT_EQ(read_checkpoint(folder / "first/checkpoint.h5").step, 250u);
}

TEST(Restart, AfterTheEndThereIsNothingToDo) {
    const Folder folder;
    folder.write("pair.toml", two_spheres());
    ASSERT_EQ(folder.grainray({"run", "pair.toml"}).status, 0);
    const auto hash = folder.summary("pair-out")["state_hash"];
    const Result r = folder.grainray({"run", "pair.toml", "--restart", "pair-out/checkpoint.h5"});
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_NE(r.err.find("raise simulation.duration or give --steps"), std::string::npos) << r.err;
    EXPECT_EQ(folder.summary("pair-out")["steps"], 0);
    EXPECT_EQ(folder.summary("pair-out")["state_hash"], hash);
}

TEST(Restart, RefusesAnotherScene) {
    const Folder folder;
    folder.write("bed.toml", bed());
    ASSERT_EQ(folder.grainray({"run", "bed.toml", "--steps", "100", "--out", "first"}).status, 0);
    const auto refused = [&](const std::string& setting, const std::string& word) {
        const Result r = folder.grainray({"run", "bed.toml", "--restart", "first/checkpoint.h5", "--out", "second", "--set", setting});
        EXPECT_EQ(r.status, 2) << r.err;
        EXPECT_NE(r.err.find(word), std::string::npos) << r.err;
        EXPECT_FALSE(fs::exists(folder / "second"));
    };
    refused("particles.grains.count=[6,6,5]", "216 particles");
    refused("simulation.dt=2e-4", "--set simulation.dt=0.0001");
}

TEST(Restart, RefusesWhatTheCheckpointDecidesAndNamesWhatChanges) {
    const Folder folder;
    folder.write("bed.toml", bed());
    ASSERT_EQ(folder.grainray({"run", "bed.toml", "--steps", "20", "--out", "first"}).status, 0);
    const auto restart = [&](const std::string& setting) {
        return folder.grainray({"run", "bed.toml", "--restart", "first/checkpoint.h5", "--out", "second", "--force", "--steps", "5", "--set", setting});
    };
    for (const char* setting : {"materials.grain.density=7800", "particles.grains.radius=0.01", "simulation.seed=2", "particles.grains.velocity=[1,0,0]"}) {
        const Result r = restart(setting);
        const std::string text = setting;
        EXPECT_EQ(r.status, 2) << setting;
        EXPECT_NE(r.err.find(text.substr(0, text.find('='))), std::string::npos) << r.err;
    }
    const Result friction = restart("materials.grain.friction=0.3");
    EXPECT_EQ(friction.status, 0) << friction.err;
    EXPECT_NE(friction.err.find("warning: from step 20 on the scene is another than in the checkpoint: materials.grain.friction\n"), std::string::npos) << friction.err;
    for (const char* setting : {"output.frames=0.001", "materials.grain.normal_stiffness=10 kN/m", "simulation.duration=20.0"})
        EXPECT_EQ(restart(setting).err.find("warning"), std::string::npos) << setting;
}

class Interrupted : public testing::TestWithParam<int> {};

TEST_P(Interrupted, StateIsSavedAndTheRestartIsExact) {
    const Folder folder;
    folder.write("bed.toml", bed());
    const pid_t child = folder.start(with_outputs({"run", "bed.toml", "--out", "out"}));
    ASSERT_TRUE(wait_for_file(folder / "out/frames/000001.vtp", child));
    kill(child, GetParam());
    const Result r = folder.finish(child);
    ASSERT_EQ(r.status, 130) << r.err;
    EXPECT_NE(r.err.find("grainray run out/scene.toml --restart out/checkpoint.h5 --out out"), std::string::npos) << r.err;
    const auto summary = folder.summary("out");
    EXPECT_EQ(summary["status"], "interrupted");
    const std::uint64_t step = summary["step"];
    EXPECT_EQ(read_checkpoint(folder / "out/checkpoint.h5").step, step);

    const Result again = folder.grainray({"run", "out/scene.toml", "--restart", "out/checkpoint.h5", "--out", "out", "--steps", "150"});
    ASSERT_EQ(again.status, 0) << again.err;
    ASSERT_EQ(folder.grainray({"run", "bed.toml", "--steps", std::to_string(step + 150), "--out", "whole"}).status, 0);
    EXPECT_EQ(folder.summary("out")["state_hash"], folder.summary("whole")["state_hash"]);
    EXPECT_EQ(count_frames(folder / "out"), (step + 150 + 99) / 100 + 1);
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupted, testing::Values(SIGTERM, SIGINT, SIGHUP),
                         [](const auto& chosen) { return chosen.param == SIGTERM ? "TERM" : chosen.param == SIGINT ? "INT" : "HUP"; });

TEST(InterruptedWithSteps, PrintsTheStepsThatAreLeft) {
    const Folder folder;
    folder.write("bed.toml", bed());
    const pid_t child = folder.start(with_outputs({"run", "bed.toml", "--out", "out", "--steps", "90000"}));
    ASSERT_TRUE(wait_for_file(folder / "out/frames/000001.vtp", child));
    kill(child, SIGTERM);
    const Result r = folder.finish(child);
    ASSERT_EQ(r.status, 130) << r.err;
    const std::uint64_t step = folder.summary("out")["step"];
    EXPECT_NE(r.err.find("--steps " + std::to_string(90000 - step)), std::string::npos) << r.err;
}

}  // namespace
}  // namespace grainray::cli_test
