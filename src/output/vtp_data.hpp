// Contents of a VTK XML DataArray with format="binary": base64, plain or zlib blocks, UInt64 headers, little endian.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace grainray {

std::string encode_vtk(std::span<const std::byte> data, bool compressed);
/// False where the text is damaged or does not hold exactly data.size() bytes.
bool decode_vtk(std::string_view text, bool compressed, std::span<std::byte> data);

}  // namespace grainray
