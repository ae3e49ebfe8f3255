#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include <fmt/format.h>
#include <png.h>

#include "grainray/render.hpp"

namespace grainray {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
    throw SimulationError(fmt::format("cannot write {}: {}", path.string(), reason));
}

void write_all(const std::filesystem::path& temporary, const std::filesystem::path& path, const Image& image) {
    std::FILE* file = std::fopen(temporary.c_str(), "wb");
    if (!file) fail(path, std::strerror(errno));
    png_image head{};
    head.version = PNG_IMAGE_VERSION;
    head.width = static_cast<png_uint_32>(image.width);
    head.height = static_cast<png_uint_32>(image.height);
    head.format = PNG_FORMAT_RGB;
    errno = 0;
    const bool written = png_image_write_to_stdio(&head, file, 0, image.rgb.data(), 0, nullptr) && std::fflush(file) == 0;
    const int error = errno;
    const bool closed = std::fclose(file) == 0;
    if (!written) fail(path, error ? std::strerror(error) : head.message);
    if (!closed) fail(path, std::strerror(errno));
}

}  // namespace

void write_png(const std::filesystem::path& path, const Image& image) {
    if (image.width < 1 || image.height < 1 || image.rgb.size() != std::size_t{3} * image.width * image.height)
        fail(path, "the image is empty or its pixels do not match its size");
    std::filesystem::path temporary = path;
    temporary += ".part";
    std::error_code error;
    try {
        write_all(temporary, path, image);
        std::filesystem::rename(temporary, path, error);
        if (error) fail(path, error.message());
    } catch (...) {
        std::filesystem::remove(temporary, error);
        throw;
    }
}

}  // namespace grainray
