#include "process.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

#include "folders.hpp"

namespace grainray::cli_test {

Folder::Folder() {
    std::string name = (fs::temp_directory_path() / "grainray-cli-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path_ = name;
}

Folder::~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

void Folder::write(const fs::path& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
}

std::string Folder::read(const fs::path& name) const {
    std::ifstream in(path_ / name, std::ios::binary);
    EXPECT_TRUE(in) << (path_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
}

pid_t Folder::start(const Arguments& arguments, std::size_t file_size_limit) const {
    std::vector<std::string> words{test::program_folder() / "grainray"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const std::string out = path_ / ".out", err = path_ / ".err";
    const pid_t child = fork();
    if (child != 0) return child;
    const int to_out = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), to_err = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (to_out < 0 || to_err < 0 || dup2(to_out, 1) < 0 || dup2(to_err, 2) < 0 || chdir(path_.c_str()) != 0) _exit(126);
    if (file_size_limit) {
        const rlimit limit{file_size_limit, file_size_limit};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    execv(argv[0], argv.data());
    _exit(127);
}

Result Folder::finish(pid_t child) const {
    int status = 0;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read(".out"), read(".err")};
}

Result Folder::grainray(const Arguments& arguments, std::size_t file_size_limit) const { return finish(start(arguments, file_size_limit)); }

bool wait_for_file(const fs::path& file, pid_t child) {
    for (int i = 0; i < 1000; ++i) {
        if (fs::exists(file)) return true;
        siginfo_t info{};
        if (waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == child) return fs::exists(file);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

std::string two_spheres() {
    return R"toml(title = "two spheres on a floor"
[simulation]
dt = 1e-4
duration = 0.02
[output]
frames = 0.004
history = 0.001
[materials.glass]
normal_stiffness = 1e3
tangential_stiffness = 3e2
[particles.pair]
type = "list"
material = "glass"
positions = [[-0.011, 0, 0.02], [0.011, 0.002, 0.02]]
radii = 0.01
velocities = [[0.5, 0, 0], [-0.5, 0, -0.5]]
[planes.floor]
material = "glass"
)toml";
}

std::string bed() {
    return R"toml(title = "bed"
[simulation]
dt = 1e-4
duration = 10.0
[contact]
mass_damping = 0.1
[materials.grain]
normal_stiffness = 1e4
tangential_stiffness = 3e3
[particles.grains]
type = "lattice"
material = "grain"
radius = 0.02
count = [6, 6, 6]
spacing = [0.042, 0.042, 0.042]
origin = [0.021, 0.021, 0.021]
jitter = [0.002, 0.002, 0]
[planes.floor]
material = "grain"
[planes.left]
material = "grain"
normal = [1, 0, 0]
[planes.back]
material = "grain"
normal = [0, 1, 0]
)toml";
}

}  // namespace grainray::cli_test
