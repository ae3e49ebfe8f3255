#include "run_folder.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include <fmt/format.h>

#include "grainray/output.hpp"

namespace grainray::cli {

namespace fs = std::filesystem;

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
    const bool empty = fs::is_empty(folder_, error);
    if (error) throw InputError(fmt::format("output folder {}: {}; give another folder with --out", folder_.string(), error.message()));
    if (empty || force || goes_on) return;
    const std::string checkpoint_hint =
        fs::exists(checkpoint(), error) ? fmt::format(", or go on from where it stopped with --restart {}", checkpoint().string()) : "";
    throw InputError(fmt::format("output folder {} is not empty; give another one with --out, replace the files of its run with --force{}",
                                 folder_.string(), checkpoint_hint));
}

void RunFolder::create() const {
    std::error_code error;
    fs::create_directories(folder_ / "frames", error);
    if (error) throw InputError(fmt::format("output folder {}: cannot be made: {}; give another one with --out", folder_.string(), error.message()));
}

void RunFolder::clear() const {
    std::error_code ignored;
    for (const fs::path& file : {scene(), history(), checkpoint(), summary()}) {
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
