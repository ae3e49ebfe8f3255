// The formats the registry knows.
#pragma once

#include <filesystem>

#include "grainray/output.hpp"

namespace grainray {

/// VTK XML PolyData, a vertex a particle. OVITO refuses compressed arrays, so the plain one is the default format.
const Writer& vtp_writer();
const Writer& compressed_vtp_writer();
Frame read_vtp(const std::filesystem::path&);

const Writer& csv_writer();
Frame read_csv(const std::filesystem::path&);

}  // namespace grainray
