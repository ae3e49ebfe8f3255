#include "run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cctype>
#include <utility>

#include <fmt/format.h>

#include "grainray/output.hpp"

namespace grainray::cli {

namespace fs = std::filesystem;

namespace {

constexpr const char* lock_name = ".lock";

bool is_empty_but_for_a_lock(const fs::path& folder, std::error_code& error) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
        if (entry.path().filename() != lock_name) return false;
    return true;
}

/// Is the file that is open still the one of that name? The run before may have removed it meanwhile.
bool is_still_there(int file, const std::string& path) {
    struct stat open_one {}, named {};
    return fstat(file, &open_one) == 0 && stat(path.c_str(), &named) == 0 && open_one.st_ino == named.st_ino && open_one.st_dev == named.st_dev;
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder) : path_((folder / lock_name).string()) {
    while (true) {
        file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (file_ < 0) return;  // writing there will say why it fails
        if (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            close(file_);
            throw InputError(fmt::format("output folder {}: a run is writing to it; wait for its end or give another folder with --out", folder.string()));
        }
        if (is_still_there(file_, path_)) return;
        close(file_);
    }
}

FolderLock::~FolderLock() {
    if (file_ < 0) return;
    struct stat status {};
    if (fstat(file_, &status) == 0 && status.st_size == 0) unlink(path_.c_str());  // a file with content is not ours
    close(file_);
}

std::int64_t frame_number(const fs::path& path) {
    const std::string name = path.filename().string();
    const auto dot = name.find('.');
    if (dot == std::string::npos || dot < 6 || dot > 18) return -1;
    if (!std::all_of(name.begin(), name.begin() + static_cast<std::ptrdiff_t>(dot), [](unsigned char c) { return std::isdigit(c); })) return -1;
    std::string extension = name.substr(dot + 1);
    if (extension.ends_with(".tmp")) extension.resize(extension.size() - 4);  // left by a run that was killed
    const auto known = writer_extensions();
    return std::find(known.begin(), known.end(), extension) == known.end() ? -1 : std::stoll(name);
}

RunFolder::RunFolder(fs::path folder, std::string extension) : folder_(std::move(folder)), extension_(std::move(extension)) {}

fs::path RunFolder::frame(std::uint64_t index) const { return folder_ / "frames" / fmt::format("{:06}.{}", index, extension_); }

bool RunFolder::goes_on_from(const fs::path& restart) const {
    std::error_code ignored;
    return !restart.empty() && fs::equivalent(fs::absolute(restart).parent_path(), folder_, ignored);
}

void RunFolder::check(bool force, bool goes_on) const {
    std::error_code error;
    const fs::file_status status = fs::status(folder_, error);
    if (!fs::exists(status)) return;
    if (!fs::is_directory(status))
        throw InputError(fmt::format("output folder {}: there is a file of that name; give another folder with --out", folder_.string()));
    const bool empty = is_empty_but_for_a_lock(folder_, error);
    if (error) throw InputError(fmt::format("output folder {}: {}; give another folder with --out", folder_.string(), error.message()));
    if (empty || goes_on) return;
    if (force) {
        const fs::path file = is_of_a_run() ? fs::path() : first_to_replace();
        if (file.empty()) return;
        throw InputError(fmt::format("output folder {} does not look like one of a run, and {} would be replaced; give another folder with --out, or move that file",
                                     folder_.string(), file.string()));
    }
    const std::string checkpoint_hint =
        fs::exists(checkpoint(), error) ? fmt::format(", or go on from where it stopped with --restart {}", checkpoint().string()) : "";
    throw InputError(fmt::format("output folder {} is not empty; give another one with --out, or replace the files of its run with --force{}",
                                 folder_.string(), checkpoint_hint));
}

/// A run writes its scene and makes frames/ first; the others follow.
bool RunFolder::is_of_a_run() const {
    std::error_code ignored;
    return fs::exists(summary(), ignored) || fs::exists(checkpoint(), ignored) || (fs::exists(scene(), ignored) && fs::is_directory(folder_ / "frames", ignored));
}

fs::path RunFolder::first_to_replace() const {
    std::error_code ignored;
    for (const fs::path& file : {scene(), history(), lost(), removed(), checkpoint(), summary()})
        for (const fs::path& name : {file, fs::path(file.string() + ".tmp")})
            if (fs::exists(fs::symlink_status(name, ignored))) return name;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "frames", ignored))
        if (frame_number(entry.path()) >= 0) return entry.path();
    return {};
}

void RunFolder::create() const {
    std::error_code error;
    fs::create_directories(folder_ / "frames", error);
    if (error) throw InputError(fmt::format("output folder {}: cannot be made: {}; give another one with --out", folder_.string(), error.message()));
}

void RunFolder::check_still_empty() const {
    if (const fs::path file = first_to_replace(); !file.empty())
        throw InputError(fmt::format("output folder {}: another run has just written {}; give another folder with --out", folder_.string(), file.string()));
}

void RunFolder::clear() const {
    std::error_code ignored;
    for (const fs::path& file : {scene(), history(), lost(), removed(), checkpoint(), summary()}) {
        fs::remove(file, ignored);
        fs::remove(file.string() + ".tmp", ignored);
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "frames", ignored))
        if (entry.is_regular_file(ignored) && frame_number(entry.path()) >= 0) fs::remove(entry.path(), ignored);
}

void RunFolder::remove_frames_after(std::uint64_t last) const {
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "frames", ignored)) {
        const std::int64_t number = frame_number(entry.path());
        if (number >= 0 && static_cast<std::uint64_t>(number) > last && entry.is_regular_file(ignored)) fs::remove(entry.path(), ignored);
    }
}

}  // namespace grainray::cli
