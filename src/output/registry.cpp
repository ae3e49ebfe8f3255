// A row per output format: to add one, write its file, declare it in formats.hpp and add its row here.
#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "output/fields.hpp"
#include "output/files.hpp"
#include "output/formats.hpp"

namespace grainray {

namespace {

struct Format {
    const char* extension;
    const Writer& (*writer)();
    Frame (*read)(const std::filesystem::path&);
};

constexpr std::array formats{
    Format{"vtp", vtp_writer, read_vtp},
    Format{"zlib.vtp", compressed_vtp_writer, read_vtp},
    Format{"csv", csv_writer, read_csv},
};

}  // namespace

std::vector<std::string> writer_extensions() {
    std::vector<std::string> names;
    for (const Format& format : formats) names.emplace_back(format.extension);
    return names;
}

const Writer& writer_for(const std::string& extension) {
    const auto found = std::ranges::find(formats, extension, &Format::extension);
    if (found == formats.end()) throw InputError(unknown_name("output format", extension, writer_extensions()));
    return found->writer();
}

Frame read_frame(const std::filesystem::path& path) {
    const auto found = std::ranges::find_if(formats, [&](const Format& format) {
        return path.filename().string().ends_with(std::string(".") + format.extension);
    });
    if (found == formats.end())
        throw_read_error(path, fmt::format("a frame ends in one of: {}", fmt::join(writer_extensions(), ", ")));
    return found->read(path);
}

}  // namespace grainray
