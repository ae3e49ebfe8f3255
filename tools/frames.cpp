#include "frames.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "grainray/output.hpp"
#include "run_folder.hpp"

namespace grainray::cli {

namespace fs = std::filesystem;

std::vector<fs::path> frames_in(const fs::path& folder) {
    std::error_code error;
    const fs::path place = fs::is_directory(folder / "frames", error) ? folder / "frames" : folder;
    std::vector<fs::path> frames;
    for (const fs::directory_entry& entry : fs::directory_iterator(place, error))
        if (frame_number(entry.path()) >= 0 && entry.path().extension() != ".tmp") frames.push_back(entry.path());
    if (error) throw InputError(fmt::format("{}: cannot be read: {}", place.string(), error.message()));
    if (frames.empty()) throw InputError(fmt::format("{}: holds no frames (NNNNNN.vtp); give a frame or the folder of a run", folder.string()));
    std::sort(frames.begin(), frames.end(), [](const fs::path& a, const fs::path& b) { return frame_number(a) < frame_number(b); });
    return frames;
}

/// A frame names its time near its end (.vtp) or in its first line (.csv).
double time_of(const fs::path& frame) {
    std::ifstream in(frame, std::ios::binary | std::ios::ate);
    const auto size = static_cast<std::int64_t>(in.tellg());
    const bool at_end = frame.extension() == ".vtp";
    std::string text(static_cast<std::size_t>(std::clamp<std::int64_t>(size, 0, 1024)), '\0');
    if (in && in.seekg(at_end ? size - static_cast<std::int64_t>(text.size()) : 0) && in.read(text.data(), static_cast<std::streamsize>(text.size()))) {
        const std::string mark = at_end ? "Name=\"TimeValue\"" : ", time ";
        std::size_t start = text.find(mark);
        if (start != text.npos && at_end) start = text.find('>', start);
        if (start != text.npos) {
            const char* first = text.data() + start + (at_end ? 1 : mark.size());
            double time = 0;
            if (std::from_chars(first, text.data() + text.size(), time).ec == std::errc{}) return time;
        }
    }
    return read_frame(frame).time;
}

std::vector<fs::path> frames_at(const std::vector<fs::path>& frames, const std::vector<double>& times) {
    std::vector<double> there;
    for (const fs::path& frame : frames) there.push_back(time_of(frame));
    const auto [first, last] = std::minmax_element(there.begin(), there.end());
    const double tolerance = 1e-6 * (*last - *first);
    std::vector<fs::path> chosen;
    for (const double time : times) {
        if (!(time >= *first - tolerance && time <= *last + tolerance))
            throw InputError(fmt::format("--times: {} s is outside of the run, whose frames are from {:g} to {:g} s", time, *first, *last));
        const auto nearest = std::min_element(there.begin(), there.end(), [&](double a, double b) { return std::abs(a - time) < std::abs(b - time); });
        chosen.push_back(frames[static_cast<std::size_t>(nearest - there.begin())]);
    }
    return chosen;
}

std::vector<double> spread_times(const std::vector<fs::path>& frames, std::size_t count) {
    const double first = time_of(frames.front()), last = time_of(frames.back());
    count = std::min(count, frames.size());
    std::vector<double> times;
    for (std::size_t k = 0; k < count; ++k) times.push_back(count == 1 ? last : first + (last - first) * static_cast<double>(k) / static_cast<double>(count - 1));
    return times;
}

Scene scene_of(const fs::path& frame, const fs::path& given) {
    if (!given.empty()) return load_scene(given);
    const fs::path file = fs::absolute(frame).parent_path().parent_path() / "scene.toml";
    std::error_code error;
    if (!fs::exists(file, error))
        throw InputError(fmt::format("{}: no scene at {}; give the scene the frame belongs to with --scene", frame.string(), file.string()));
    return load_scene(file);
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    if (!folder.empty()) fs::create_directories(folder, error);
    if (error) throw InputError(fmt::format("folder {}: cannot be made: {}", folder.string(), error.message()));
}

}  // namespace grainray::cli
