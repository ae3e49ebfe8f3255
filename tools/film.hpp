// Frames of a run as a film by ffmpeg, where that is installed; else as numbered pictures in a folder.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "grainray/render.hpp"

namespace grainray::cli {

class Film {
public:
    /// Throws InputError: a name that is no film's, a frame rate that is none.
    Film(std::filesystem::path file, double frames_per_second);
    ~Film();
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;

    /// All pictures have the size of the first. Throws SimulationError with what ffmpeg said.
    void add(const Image&);
    /// The film appears under its name. Returns one sentence for the user. Throws SimulationError.
    std::string finish();

private:
    void start(int width, int height);
    [[noreturn]] void fail();
    std::filesystem::path temporary() const;

    std::filesystem::path file_, ffmpeg_, folder_;  ///< folder of the pictures where there is no ffmpeg
    double rate_;
    std::uint64_t count_ = 0;
    int pipe_ = -1, messages_ = -1;  ///< descriptors: pictures to ffmpeg, a file with what it says
    pid_t process_ = -1;
};

}  // namespace grainray::cli
