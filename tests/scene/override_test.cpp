// --set key=value.
#include "scene_text.hpp"

namespace grainray::test {
namespace {

const std::string column = with_grain + R"([particles.column]
type = "lattice"
material = "grain"
radius = 0.1
count = [2, 2, 2]
spacing = [0.24, 0.24, 0.24]
origin = [0, 0, 0]

[[pairs]]
materials = ["grain", "grain"]
friction = 0.1
)";

TEST(Override, ReplacesAndCreatesKeys) {
    const Scene s = parse(column, {"particles.column.count=[71,80,141]", "simulation.dt = 2e-4", "output.frames=0.5",
                                   "materials.wall.friction=1.0"});
    EXPECT_EQ(std::get<Lattice>(s.particles[0].placement).count, (std::array<std::int64_t, 3>{71, 80, 141}));
    EXPECT_EQ(s.dt, 2e-4);
    EXPECT_EQ(s.output.frames, 0.5);
    ASSERT_EQ(s.materials.size(), 2u);
    EXPECT_EQ(s.materials[1].name, "wall");
}

TEST(Override, BareWordsAreStrings) {
    const Scene s =
        parse(column, {"search.backend=brute", "contact.mixing=series", "simulation.dt=5 ms", "title=a bare title"});
    EXPECT_EQ(s.search.backend, "brute");
    EXPECT_EQ(s.contact.mixing, Mixing::series);
    EXPECT_DOUBLE_EQ(s.dt, 5e-3);
    EXPECT_EQ(s.title, "a bare title");
}

TEST(Override, TakesTablesArraysAndElements) {
    const Scene s = parse(
        column, {"pairs.0.friction=0.7", "particles.column.jitter=[0.01, \"2 mm\", 0]", "particles.column.origin.2=1.5",
                 "planes.floor={material=\"grain\", normal=[0,0,2]}", "output.fields=[\"id\"]"});
    EXPECT_EQ(s.pairs[0].friction, 0.7);
    const auto& lattice = std::get<Lattice>(s.particles[0].placement);
    EXPECT_DOUBLE_EQ(lattice.jitter.y, 0.002);
    EXPECT_EQ(lattice.origin.z, 1.5);
    EXPECT_EQ(s.planes.at(0).normal, (Vec3d{0, 0, 1}));
    EXPECT_EQ(s.output.fields.size(), 1u);
}

TEST(Override, LaterOnesWin) { EXPECT_EQ(parse(minimal, {"simulation.seed=2", "simulation.seed=3"}).seed, 3u); }

TEST(Override, QuotedKeysMayHoldDots) {
    EXPECT_EQ(parse(minimal, {"materials.\"a.b\".friction=0.2"}).materials.at(0).name, "a.b");
}

TEST(Override, IsNotedInTheSource) {
    const Scene s = parse("simulation = {dt = 1, duration = 1}", {"simulation.seed=2"});
    EXPECT_EQ(s.source, "simulation = {dt = 1, duration = 1}\n# --set simulation.seed=2\n");
    EXPECT_NO_THROW(parse(s.source));
}

struct BadOverride {
    std::string setting;
    std::vector<std::string> expected;
};

class BadOverrides : public testing::TestWithParam<BadOverride> {};

TEST_P(BadOverrides, AreNamedWithTheSetting) {
    const auto& [setting, expected] = GetParam();
    const std::string message = parse_error(column, {setting});
    EXPECT_TRUE(message.starts_with("--set " + setting + ": ")) << message;
    for (const auto& part : expected)
        EXPECT_NE(message.find(part), std::string::npos) << "no '" << part << "' in: " << message;
}

INSTANTIATE_TEST_SUITE_P(
    All, BadOverrides,
    testing::Values(BadOverride{"simulation.dt", {"expected key=value", "--set simulation.dt=5e-4"}},
                    BadOverride{"simulation.dt=", {"no value after '='"}}, BadOverride{"=3", {"'' is not a key"}},
                    BadOverride{"a b=3", {"'a b' is not a key", "simulation.dt"}},
                    BadOverride{"simulation.dt=-1", {"key 'simulation.dt' = -1", "must be greater than 0 s"}},
                    BadOverride{"simulation.dt=fast", {"key 'simulation.dt' = \"fast\"", "accepted units: s, ms"}},
                    BadOverride{"simulation.dt=nan", {"must be a finite number"}},
                    BadOverride{"particles.column.count=[71,80", {"'[71,80' is not a TOML value", "brackets"}},
                    BadOverride{"particles.column.count=[71,80]",
                                {"key 'particles.column.count' = [71, 80]", "array of 3", "found 2"}},
                    BadOverride{"particles.colum.count=[1,1,1]",
                                {"key 'particles.colum.type' is missing", "lattice, list, file, fill"}},
                    BadOverride{"simulation.dt.x=1", {"key 'simulation.dt' is a number, not a table", "'x'"}},
                    BadOverride{"pairs.1.friction=1", {"'1' is no element of an array of 1", "numbered from 0"}},
                    BadOverride{"pairs.first.friction=1", {"'first' is no element"}},
                    BadOverride{"search.backend=cell",
                                {"key 'search.backend' = \"cell\"", "did you mean 'cells'?", "auto, brute, cells"}},
                    BadOverride{"serach.backend=cells", {"key 'serach': unknown key", "did you mean 'search'?"}},
                    BadOverride{"particles.column.material=gravel", {"unknown material 'gravel'", "Defined: grain"}}));

}  // namespace
}  // namespace grainray::test
