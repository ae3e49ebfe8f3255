// Machines without a GPU that CUDA can use: a sentence that says why, and `--device auto` runs on the CPU.
#include <cstdlib>

#include "folders.hpp"
#include "grainray/device.hpp"
#include "process.hpp"

namespace grainray::cli_test {
namespace {

/// Sets a variable for the processes a test starts.
class Environment {
public:
    Environment(const char* name, const std::string& value) : name_(name) {
        if (const char* before = std::getenv(name)) before_ = before, had_ = true;
        setenv(name, value.c_str(), 1);
    }
    ~Environment() { had_ ? setenv(name_, before_.c_str(), 1) : unsetenv(name_); }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

private:
    const char* name_;
    std::string before_;
    bool had_ = false;
};

void expect_cpu(const std::vector<std::string>& words) {
    const Folder folder;
    folder.write("pair.toml", two_spheres());
    const Result info = folder.grainray({"info"});
    EXPECT_EQ(info.status, 0) << info.err;
    EXPECT_NE(info.out.find("runs         on cpu"), std::string::npos) << info.out;

    const Result run = folder.grainray({"run", "pair.toml", "--out", "out", "--steps", "5"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(folder.summary("out")["device"], "cpu");
    const std::string said = folder.summary("out")["device_reason"];
    for (const std::string& word : words) EXPECT_NE(said.find(word), std::string::npos) << "no '" << word << "' in " << said;
    EXPECT_NE(info.out.find("device cuda  " + said + '\n'), std::string::npos) << said << "\nis not in\n" << info.out;

    const Result insisted = folder.grainray({"run", "pair.toml", "--out", "no", "--device", "cuda"});
    EXPECT_EQ(insisted.status, 2);
    EXPECT_EQ(insisted.err, "grainray: --device cuda: " + said + '\n');
    EXPECT_FALSE(std::filesystem::exists(folder / "no"));
}

TEST(NoGpu, HiddenByTheEnvironment) {
    const Environment hide("CUDA_VISIBLE_DEVICES", "");
    const bool driver = cuda_available(), built = cuda_report().runtime_version != 0;
    expect_cpu({driver ? "no NVIDIA GPU is visible" : built ? "NVIDIA" : "this build has no CUDA"});
}

/// What a driver of that version says when it starts with that status of the driver's interface.
void expect_with_driver(int version, int init, const std::vector<std::string>& words) {
    const std::filesystem::path folder = test::program_folder() / "fake_driver";
    if (cuda_report().runtime_version == 0 || !std::filesystem::exists(folder)) GTEST_SKIP() << "built without CUDA, or without the fake driver";
    const char* others = std::getenv("LD_LIBRARY_PATH");
    const Environment path("LD_LIBRARY_PATH", folder.string() + (others ? std::string(":") + others : "")), answer("FAKE_DRIVER_VERSION", std::to_string(version)),
        status("FAKE_DRIVER_INIT", std::to_string(init));
    expect_cpu(words);
}

constexpr int new_enough = 99000;

TEST(NoGpu, OldDriver) { expect_with_driver(11040, 0, {"the NVIDIA driver", "too old: it serves CUDA 11.4, this build needs"}); }
TEST(NoGpu, DriverWithoutAGpu) { expect_with_driver(new_enough, 100, {"no NVIDIA GPU is visible"}); }
TEST(NoGpu, DriverThatWasReplaced) { expect_with_driver(new_enough, 803, {"the NVIDIA driver was changed while it was in use"}); }
TEST(NoGpu, GpuTakenByAnother) { expect_with_driver(new_enough, 46, {"the GPU is taken by another process"}); }
TEST(NoGpu, DriverThatDoesNotStart) { expect_with_driver(new_enough, 999, {"CUDA does not start: "}); }

}  // namespace
}  // namespace grainray::cli_test
