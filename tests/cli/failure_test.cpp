// Runs that cannot go on: exit status 1, a sentence, and the last good checkpoint left as it was.
#include <algorithm>

#include "grainray/output.hpp"
#include "process.hpp"

namespace grainray::cli_test {
namespace {

/// Two spheres that sit almost in each other; allowed by limits.overlap, and the step is below the critical one.
std::string explosion() {
    return R"toml(title = "explosion"
[simulation]
dt = 6e-4
duration = 0.6
gravity = [0, 0, 0]
[output]
frames = 0.06
[limits]
overlap = 1.99
speed = 5
[materials.steel]
density = 2000
normal_stiffness = 5e3
friction = 0
normal_damping = 0
[particles.pair]
type = "list"
material = "steel"
positions = [[0, 0, 0], [0.001, 0, 0]]
radii = 0.01
)toml";
}

TEST(Failure, ExplosionNamesParticlesAndTimeStep) {
    const Folder folder;
    folder.write("boom.toml", explosion());
    const Result r = folder.grainray({"run", "boom.toml", "--out", "out", "--quiet"});
    ASSERT_EQ(r.status, 1) << r.err;
    EXPECT_TRUE(r.err.starts_with("grainray: stopped at")) << r.err;
    for (const char* word : {"particle 0", "particle 1", "dt = 0.0006 s", "critical dt = ", "out/checkpoint.h5 (step 0"})
        EXPECT_NE(r.err.find(word), std::string::npos) << "no '" << word << "' in " << r.err;
    EXPECT_EQ(read_checkpoint(folder / "out/checkpoint.h5").step, 0u);
    const auto s = folder.summary("out");
    EXPECT_EQ(s["status"], "failed");
    EXPECT_NE(s["message"].get<std::string>().find("particle 0"), std::string::npos);
    EXPECT_LE(s["step"], 100);  // within one output interval; a run looks closely at its first steps
    EXPECT_FALSE(fs::exists(folder / "out/frames/000001.vtp"));
}

TEST(Failure, FileSizeLimitStandsForAFullDisk) {
    const Folder folder;
    folder.write("pair.toml", two_spheres());
    const Result r = folder.grainray({"run", "pair.toml", "--out", "out", "--steps", "2000", "--set", "output.history=1e-4", "--set",
                                      "output.frames=0.01", "--set", "output.checkpoints=0.005"}, 60'000);
    ASSERT_EQ(r.status, 1) << r.err;
    for (const char* word : {"history.csv", "limit", "last good checkpoint is out/checkpoint.h5"}) EXPECT_NE(r.err.find(word), std::string::npos) << r.err;
    const Checkpoint checkpoint = read_checkpoint(folder / "out/checkpoint.h5");
    EXPECT_GT(checkpoint.step, 0u);
    EXPECT_EQ(folder.read("out/history.csv").back(), '\n');
    EXPECT_EQ(folder.summary("out")["status"], "failed");
    // With room again it goes on from there.
    const Result again = folder.grainray({"run", "out/scene.toml", "--restart", "out/checkpoint.h5", "--out", "out", "--steps", "10"});
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(folder.summary("out")["step"], checkpoint.step + 10);
}

/// A frame in the middle of the run meets a full disk while later states are computed already.
TEST(Failure, FullDiskInTheMiddleOfARun) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    const Folder folder;
    folder.write("pair.toml", two_spheres());
    ASSERT_EQ(folder.grainray({"run", "pair.toml", "--out", "out", "--quiet"}).status, 0);
    fs::create_symlink("/dev/full", folder / "out/frames/000003.vtp.tmp");
    const Result r = folder.grainray({"run", "pair.toml", "--out", "out", "--quiet", "--force"});
    EXPECT_EQ(r.status, 1) << r.err;
    for (const char* word : {"cannot write out/frames/000003.vtp: the disk is full", "last good checkpoint is out/checkpoint.h5 (step 80,"})
        EXPECT_NE(r.err.find(word), std::string::npos) << "no '" << word << "' in " << r.err;
    EXPECT_EQ(read_checkpoint(folder / "out/checkpoint.h5").step, 80u);
    EXPECT_TRUE(fs::exists(folder / "out/frames/000002.vtp"));
    EXPECT_FALSE(fs::exists(folder / "out/frames/000004.vtp"));  // nothing is written after what failed
    const std::string history = folder.read("out/history.csv");
    EXPECT_EQ(std::count(history.begin(), history.end(), '\n'), 1 + 12) << history;  // steps 0, 10 ... 110
    EXPECT_EQ(folder.summary("out")["status"], "failed");

    const Result again = folder.grainray({"run", "out/scene.toml", "--restart", "out/checkpoint.h5", "--out", "out"});
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(folder.summary("out")["step"], 200);
}

TEST(Failure, NoRoomForTheFirstFrame) {
    const Folder folder;
    folder.write("bed.toml", bed());
    const Result r = folder.grainray({"run", "bed.toml", "--steps", "10", "--out", "out"}, 4'000);
    EXPECT_EQ(r.status, 1) << r.err;
    EXPECT_NE(r.err.find("no checkpoint was written"), std::string::npos) << r.err;
    EXPECT_FALSE(fs::exists(folder / "out/frames/000000.vtp"));
}

TEST(Failure, OutputOfTheCommandItself) {
    const Folder folder;
    folder.write("pair.toml", two_spheres());
    EXPECT_EQ(folder.grainray({"bench", "step", "--scene", "pair.toml", "--steps", "5", "--json", "absent/figures.json"}).status, 2);
}

}  // namespace
}  // namespace grainray::cli_test
