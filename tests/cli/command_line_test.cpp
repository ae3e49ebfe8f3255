// Wrong command lines: exit status 2, one line on stderr that names what is wrong and the remedy, nothing written.
#include "process.hpp"

namespace grainray::cli_test {
namespace {

struct Mistake {
    const char* name;
    Arguments arguments;
    std::vector<std::string> says;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class WrongCommandLine : public testing::TestWithParam<Mistake> {};

TEST_P(WrongCommandLine, IsOneLineAndStatusTwo) {
    const Folder folder;
    folder.write("scene.toml", two_spheres());
    folder.write("folder/other.txt", "not a scene");
    const Result r = folder.grainray(GetParam().arguments);
    EXPECT_EQ(r.status, 2) << r.err;
    EXPECT_EQ(r.out, "");
    EXPECT_TRUE(r.err.starts_with("grainray: ")) << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    for (const std::string& word : GetParam().says) EXPECT_NE(r.err.find(word), std::string::npos) << "no '" << word << "' in " << r.err;
    EXPECT_FALSE(fs::exists(folder / "scene-out"));
}

const Mistake mistakes[] = {
    {"nothing", {}, {"no command", "--help"}},
    {"unknown_command", {"rnu", "scene.toml"}, {"'rnu'", "did you mean 'run'"}},
    {"unknown_option", {"run", "scene.toml", "--stepz", "5"}, {"'--stepz'", "did you mean '--steps'", "grainray run --help"}},
    {"unknown_option_with_value", {"run", "scene.toml", "--outt=x"}, {"'--outt'", "'--out'"}},
    {"no_scene", {"run"}, {"SCENE"}},
    {"two_scenes", {"run", "scene.toml", "second.toml"}, {"second.toml"}},
    {"no_such_scene", {"run", "absent.toml"}, {"absent.toml"}},
    {"folder_as_scene", {"run", "folder"}, {"folder"}},
    {"steps_no_number", {"run", "scene.toml", "--steps", "many"}, {"--steps", "many"}},
    {"steps_says_integer", {"run", "scene.toml", "--steps", "abc"}, {"an integer is wanted"}},
    {"steps_too_many", {"run", "scene.toml", "--steps", "1000000000000001"}, {"--steps", "1e15"}},
    {"out_empty", {"run", "scene.toml", "--out", ""}, {"--out", "empty"}},
    {"less_than_half_a_step", {"run", "scene.toml", "--set", "simulation.duration=4e-5"}, {"simulation.duration", "no step"}},
    {"bench_json_nowhere", {"bench", "step", "--scene", "scene.toml", "--json", "absent/a.json"}, {"--json", "absent/a.json"}},
    {"steps_negative", {"run", "scene.toml", "--steps", "-3"}, {"--steps", "-3"}},
    {"threads_negative", {"run", "scene.toml", "--threads", "-1"}, {"--threads", "-1"}},
    {"unknown_device", {"run", "scene.toml", "--device", "gpu"}, {"--device", "'gpu'", "cuda"}},
    {"unknown_search", {"run", "scene.toml", "--search", "cell"}, {"--search", "'cell'", "did you mean 'cells'"}},
    {"nearly_rays", {"run", "scene.toml", "--search", "ray"}, {"'ray'", "did you mean 'rays'"}},
    {"unknown_variant", {"run", "scene.toml", "--set", "search.rays.variant=publshed"}, {"search.rays.variant", "did you mean 'published'"}},
    {"set_without_value", {"run", "scene.toml", "--set", "simulation.dt"}, {"--set simulation.dt", "key=value"}},
    {"set_unknown_key", {"run", "scene.toml", "--set", "simulation.dtt=1"}, {"simulation.dtt", "did you mean"}},
    {"set_wrong_value", {"run", "scene.toml", "--set", "simulation.dt=-1"}, {"simulation.dt", "-1"}},
    {"no_such_checkpoint", {"run", "scene.toml", "--restart", "absent.h5"}, {"absent.h5"}},
    {"restart_from_text", {"run", "scene.toml", "--restart", "scene.toml", "--out", "x"}, {"scene.toml", "checkpoint"}},
    {"out_is_a_file", {"run", "scene.toml", "--out", "scene.toml"}, {"scene.toml", "--out"}},
    {"out_is_not_empty", {"run", "scene.toml", "--out", "folder"}, {"folder", "not empty", "--force"}},
    {"check_no_scene", {"check"}, {"SCENE"}},
    {"check_unknown_search", {"check", "scene.toml", "--search", "tree"}, {"'tree'", "brute"}},
    {"info_unknown_option", {"info", "--shema"}, {"--shema", "did you mean '--schema'"}},
    {"render_no_frame", {"render", "absent.vtp"}, {"absent.vtp"}},
    {"render_folder_without_frames", {"render", "folder"}, {"no frames"}},
    {"bench_nothing", {"bench"}, {"bench step", "bench neighbors"}},
    {"bench_unknown", {"bench", "stp"}, {"'stp'", "did you mean 'step'"}},
    {"bench_settled_needs_init", {"bench", "step", "--scene", "settled"}, {"--init"}},
    {"bench_unknown_scene", {"bench", "step", "--scene", "colapse"}, {"did you mean 'collapse'"}},
    {"bench_no_steps", {"bench", "step", "--steps", "0"}, {"--steps"}},
    {"bench_wrong_points", {"bench", "neighbors", "--points", "0"}, {"--points"}},
    {"bench_wrong_kind", {"bench", "neighbors", "--points", "10", "--kind", "halve"}, {"--kind", "half"}},
    {"validate_unknown_case", {"validate", "no such case"}, {"no such case"}},
};

INSTANTIATE_TEST_SUITE_P(All, WrongCommandLine, testing::ValuesIn(mistakes), [](const auto& chosen) { return std::string(chosen.param.name); });

TEST(Help, EveryCommandTeachesWithAnExample) {
    const Folder folder;
    for (const Arguments& command : std::vector<Arguments>{{"run"}, {"check"}, {"info"}, {"render"}, {"deposit"}, {"bench"}, {"bench", "step"}, {"bench", "neighbors"}, {"validate"}}) {
        Arguments arguments = command;
        arguments.push_back("--help");
        const Result r = folder.grainray(arguments);
        EXPECT_EQ(r.status, 0) << command[0];
        EXPECT_NE(r.out.find("Example: grainray " + command[0]), std::string::npos) << r.out;
    }
}

TEST(Help, VersionAndOverview) {
    const Folder folder;
    EXPECT_TRUE(folder.grainray({"--version"}).out.starts_with("grainray 0."));
    const Result help = folder.grainray({"--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_NE(help.out.find("Exit status"), std::string::npos);
}

}  // namespace
}  // namespace grainray::cli_test
