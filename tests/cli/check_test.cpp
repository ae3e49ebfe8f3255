// grainray check: what it reports and what it refuses; `run` refuses the same.
#include "folders.hpp"
#include "process.hpp"

namespace grainray::cli_test {
namespace {

const std::string examples = test::project_folder() / "examples";

/// As `says` with words on stdout.
void expect_words(const Result& r, const std::vector<std::string>& words) {
    for (const std::string& word : words) EXPECT_NE(r.out.find(word), std::string::npos) << "no '" << word << "' in\n" << r.out;
}

TEST(Check, ReportsCountsBoundsStepsMemoryAndTime) {
    const Folder folder;
    folder.write("bed.toml", bed());
    const Result r = folder.grainray({"check", "bed.toml"});
    ASSERT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(r.err, "");
    expect_words(r, {"216 of material grain", "material grain   216 particles", "bounds", "0 pairs", "critical dt", "materials.grain.",
                     "100000 steps", "memory", "wall time", "particle-steps/s", "verdict      ok"});
    EXPECT_FALSE(fs::exists(folder / "bed-out"));
}

TEST(Check, LiteralTableIsRefusedAtTheStepOfTheStableOne) {
    const Folder folder;
    const std::string literal = examples + "/column_collapse_literal.toml";
    const Result refused = folder.grainray({"check", literal, "--set", "simulation.dt=1e-3"});
    EXPECT_EQ(refused.status, 2);
    EXPECT_NE(refused.err.find("materials.wall.tangential_damping"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("simulation.dt"), std::string::npos) << refused.err;
    expect_words(refused, {"unstable", "materials.grain.tangential_damping", "verdict      refused"});
    EXPECT_EQ(folder.grainray({"check", literal, "--set", "particles.column.count=[4,4,4]"}).status, 0);
    EXPECT_EQ(folder.grainray({"check", examples + "/column_collapse.toml", "--set", "particles.column.count=[4,4,4]"}).status, 0);
}

TEST(Check, WorstOverlapsAreNamed) {
    const Folder folder;
    folder.write("pair.toml", two_spheres());
    const Result r = folder.grainray({"check", "pair.toml", "--set", "particles.pair.positions=[[0,0,0.009],[0.012,0,0.02],[1,0,1]]", "--set",
                                      "particles.pair.velocities=[]"});
    EXPECT_EQ(r.status, 0) << r.err;
    expect_words(r, {"1 pairs, 1 with planes", "particles 0 and 1: 0.003721 m, 0.372", "particle 0 in 'floor': 0.001 m, 0.1", "they will fly apart", "1 warning"});
}

struct Refusal {
    const char* name;
    Arguments settings;
    std::vector<std::string> says;
};
void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.name; }

class RefusedScene : public testing::TestWithParam<Refusal> {};

TEST_P(RefusedScene, ByCheckAndByRunAlike) {
    const Folder folder;
    folder.write("pair.toml", two_spheres());
    Arguments settings;
    for (const std::string& setting : GetParam().settings) settings.insert(settings.end(), {"--set", setting});
    for (const char* command : {"check", "run"}) {
        Arguments arguments{command, "pair.toml"};
        arguments.insert(arguments.end(), settings.begin(), settings.end());
        const Result r = folder.grainray(arguments);
        EXPECT_EQ(r.status, 2) << r.err;
        for (const std::string& word : GetParam().says) EXPECT_NE(r.err.find(word), std::string::npos) << "no '" << word << "' in " << r.err;
        EXPECT_FALSE(fs::exists(folder / "pair-out"));
    }
}

INSTANTIATE_TEST_SUITE_P(All, RefusedScene, testing::Values(
    Refusal{"step_above_critical", {"simulation.dt=0.01"}, {"simulation.dt = 0.01 s", "critical time step", "materials.glass."}},
    Refusal{"one_place_for_two", {"particles.pair.positions=[[0,0,1],[0,0,1]]"}, {"particles 0 and 1", "limits.overlap"}},
    Refusal{"behind_a_plane", {"planes.floor.normal=[0,0,-1]"}, {"plane 'floor'", "normal"}},
    Refusal{"outside_the_domain", {"domain.lower=[-1,-1,0]", "domain.upper=[0,1,1]"}, {"particle 1", "outside the domain"}},
    Refusal{"too_fast", {"particles.pair.velocities=[[500,0,0],[0,0,0]]"}, {"particle 0", "limits.speed", "simulation.dt"}},
    Refusal{"too_many", {"particles.more={type=\"lattice\",material=\"glass\",radius=1,count=[1000000,1000,1],spacing=[3,3,3],origin=[0,0,1]}"},
            {"1e+09 particles", "needs"}}),
    [](const auto& chosen) { return std::string(chosen.param.name); });

}  // namespace
}  // namespace grainray::cli_test
