#include "film.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "output/files.hpp"

namespace grainray::cli {

namespace fs = std::filesystem;

namespace {

constexpr std::array extensions{".mp4", ".mov", ".mkv", ".webm", ".avi", ".gif"};

/// Where ffmpeg is on PATH; empty: nowhere.
fs::path find_ffmpeg() {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const fs::path program = fs::path(folder.empty() ? "." : folder) / "ffmpeg";
        struct stat status {};
        if (stat(program.c_str(), &status) == 0 && S_ISREG(status.st_mode) && access(program.c_str(), X_OK) == 0) return program;
    }
    return {};
}

/// An even number of rows and columns, which most films need; bits enough for moving grains.
std::vector<std::string> ffmpeg_arguments(const fs::path& to, int width, int height, double rate) {
    std::vector<std::string> words{"ffmpeg", "-loglevel", "error", "-y", "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", fmt::format("{}x{}", width, height),
                                   "-framerate", fmt::format("{}", rate), "-i", "-", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white"};
    if (to.extension() != ".gif")
        for (const std::string& word : {std::string("-pix_fmt"), std::string("yuv420p"), std::string("-b:v"), fmt::format("{:.0f}k", 0.2e-3 * width * height * std::max(rate, 10.0))})
            words.push_back(word);
    words.push_back(to.string());
    return words;
}

[[noreturn]] void run_in_child(const fs::path& program, std::vector<std::string> words, int input, int messages) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    dup2(input, STDIN_FILENO);
    dup2(messages, STDOUT_FILENO);
    dup2(messages, STDERR_FILENO);
    execv(program.c_str(), arguments.data());
    _exit(127);
}

}  // namespace

Film::Film(fs::path file, double frames_per_second) : file_(std::move(file)), ffmpeg_(find_ffmpeg()), rate_(frames_per_second) {
    if (std::find(extensions.begin(), extensions.end(), file_.extension()) == extensions.end())
        throw InputError(fmt::format("--movie: {} does not end in one of {}", file_.string(), fmt::join(extensions, ", ")));
    if (!(rate_ >= 0.01 && rate_ <= 1000)) throw InputError(fmt::format("--fps: {} must be from 0.01 to 1000 frames a second", rate_));
    if (fs::is_directory(file_)) throw InputError(fmt::format("--movie: {} is a folder; give the name of a film", file_.string()));
    folder_ = fs::path(file_).replace_extension();
}

Film::~Film() {
    if (pipe_ >= 0) close(pipe_);
    if (process_ > 0) waitpid(process_, nullptr, 0);
    if (messages_ >= 0) close(messages_);
    std::error_code ignored;
    fs::remove(temporary(), ignored);
}

/// The extension says to ffmpeg what to make.
fs::path Film::temporary() const { return fs::path(file_).replace_extension(".part" + file_.extension().string()); }

void Film::start(int width, int height) {
    std::signal(SIGPIPE, SIG_IGN);  // an ffmpeg that has ended is then an error of write()
    int ends[2];
    char name[] = "/tmp/grainray_ffmpeg_XXXXXX";
    messages_ = mkostemp(name, O_CLOEXEC);
    if (messages_ < 0 || pipe2(ends, O_CLOEXEC) != 0) throw SimulationError(fmt::format("ffmpeg cannot be started: {}", std::generic_category().message(errno)));
    unlink(name);
    const auto words = ffmpeg_arguments(temporary(), width, height, rate_);
    process_ = fork();
    if (process_ == 0) run_in_child(ffmpeg_, words, ends[0], messages_);
    close(ends[0]);
    pipe_ = ends[1];
    if (process_ < 0) throw SimulationError(fmt::format("ffmpeg cannot be started: {}", std::generic_category().message(errno)));
}

void Film::fail() {
    std::string said(400, '\0');
    const ssize_t size = pread(messages_, said.data(), said.size(), 0);
    said.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    while (!said.empty() && said.back() == '\n') said.pop_back();
    std::replace(said.begin(), said.end(), '\n', ' ');
    throw SimulationError(fmt::format("ffmpeg could not make {}: {}", file_.string(), said.empty() ? "it ended without a word" : said));
}

void Film::add(const Image& image) {
    ++count_;
    if (ffmpeg_.empty()) {
        std::error_code error;
        fs::create_directories(folder_, error);
        if (error) throw InputError(fmt::format("folder {}: cannot be made: {}", folder_.string(), error.message()));
        return write_png(folder_ / fmt::format("{:06}.png", count_ - 1), image);
    }
    if (process_ < 0) start(image.width, image.height);
    if (!write_all(pipe_, {reinterpret_cast<const char*>(image.rgb.data()), image.rgb.size()})) fail();
}

std::string Film::finish() {
    const std::string how = fmt::format("{} frames, {:g} a second", count_, rate_);
    if (ffmpeg_.empty())
        return fmt::format("there is no ffmpeg here, so {} holds {} pictures; where there is one: ffmpeg -framerate {:g} -i {}/%06d.png -pix_fmt yuv420p {}", folder_.string(),
                           count_, rate_, folder_.string(), file_.string());
    if (pipe_ >= 0) close(pipe_);
    pipe_ = -1;
    int status = 1;
    if (process_ > 0) waitpid(process_, &status, 0);
    process_ = -1;
    if (status != 0) fail();
    std::error_code error;
    fs::rename(temporary(), file_, error);
    if (error) throw SimulationError(fmt::format("cannot write {}: {}", file_.string(), error.message()));
    return fmt::format("{}: {}", file_.string(), how);
}

}  // namespace grainray::cli
