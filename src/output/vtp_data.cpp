#include "output/vtp_data.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <zlib.h>

namespace grainray {

static_assert(std::endian::native == std::endian::little, "files are little endian");

namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::size_t block_size = std::size_t{1} << 18;  // uncompressed bytes of a zlib block
constexpr int compression_level = 1;                      // floats hardly shrink further at higher ones
constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr auto digits = [] {
    std::array<unsigned char, 256> table{};
    table.fill(255);
    for (std::size_t i = 0; i < alphabet.size(); ++i) table[static_cast<unsigned char>(alphabet[i])] = static_cast<unsigned char>(i);
    return table;
}();

std::size_t base64_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

void encode_triple(const unsigned char* in, std::size_t count, char* out) {
    const unsigned bits = in[0] << 16 | (count > 1 ? in[1] << 8 : 0) | (count > 2 ? in[2] : 0);
    out[0] = alphabet[bits >> 18];
    out[1] = alphabet[bits >> 12 & 63];
    out[2] = count > 1 ? alphabet[bits >> 6 & 63] : '=';
    out[3] = count > 2 ? alphabet[bits & 63] : '=';
}

void append_base64(std::string& text, const Bytes& data) {
    const std::size_t start = text.size(), triples = data.size() / 3;
    text.resize(start + base64_size(data.size()));
    char* const out = text.data() + start;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, triples, 1 << 14), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) encode_triple(&data[3 * i], 3, out + 4 * i);
    });
    if (data.size() > 3 * triples) encode_triple(&data[3 * triples], data.size() - 3 * triples, out + 4 * triples);
}

/// Decodes `count` bytes from the front of text and drops the characters used; false where they are not there.
bool take_base64(std::string_view& text, std::size_t count, unsigned char* out) {
    if (count / 3 > text.size() / 4 || base64_size(count) > text.size()) return false;
    std::atomic<bool> good = true;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, (count + 2) / 3, 1 << 14), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const std::size_t n = std::min<std::size_t>(3, count - 3 * i);
            std::uint32_t bits = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                const char c = text[4 * i + k];
                const unsigned char digit = digits[static_cast<unsigned char>(c)];
                if (k <= n ? digit > 63 : c != '=') good = false;
                bits = bits << 6 | (digit & 63u);
            }
            for (std::size_t k = 0; k < n; ++k) out[3 * i + k] = static_cast<unsigned char>(bits >> (16 - 8 * k));
        }
    });
    text.remove_prefix(base64_size(count));
    return good;
}

Bytes to_bytes(const std::vector<std::uint64_t>& words) {
    Bytes bytes(words.size() * 8);
    std::memcpy(bytes.data(), words.data(), bytes.size());
    return bytes;
}

Bytes compress_block(std::span<const std::byte> data) {
    uLongf size = compressBound(data.size());
    Bytes result(size);
    if (compress2(result.data(), &size, reinterpret_cast<const Bytef*>(data.data()), data.size(), compression_level) != Z_OK)
        throw std::bad_alloc();  // the only way it can fail
    result.resize(size);
    return result;
}

/// Header: number of blocks, their size, size of the last one if smaller (else 0), compressed size of each.
std::string encode_compressed(std::span<const std::byte> data) {
    const std::size_t blocks = (data.size() + block_size - 1) / block_size;
    std::vector<Bytes> packed(blocks);
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t i) {
        packed[i] = compress_block(data.subspan(i * block_size, std::min(block_size, data.size() - i * block_size)));
    });
    std::vector<std::uint64_t> header{blocks, block_size, data.size() % block_size};
    Bytes body;
    for (const Bytes& block : packed) {
        header.push_back(block.size());
        body.insert(body.end(), block.begin(), block.end());
    }
    std::string text;
    append_base64(text, to_bytes(header));
    append_base64(text, body);
    return text;
}

bool uncompress_block(std::span<const unsigned char> packed, std::span<std::byte> data) {
    uLongf size = data.size();
    const int status = uncompress(reinterpret_cast<Bytef*>(data.data()), &size, packed.data(), packed.size());
    return status == Z_OK && size == data.size();
}

bool decode_compressed(std::string_view text, std::span<std::byte> data) {
    // The header is one base64 string; the first three words (24 bytes, 32 characters) say how long it is.
    std::array<std::uint64_t, 3> start{};
    std::string_view peek = text;
    if (!take_base64(peek, sizeof start, reinterpret_cast<unsigned char*>(start.data()))) return false;
    const std::uint64_t blocks = start[0], size = start[1], last = start[2];
    if (blocks == 0) return data.empty();
    if (size == 0 || blocks != (data.size() + size - 1) / size || last != data.size() % size) return false;
    if (blocks > text.size()) return false;
    std::vector<std::uint64_t> header(3 + blocks);
    if (!take_base64(text, header.size() * 8, reinterpret_cast<unsigned char*>(header.data()))) return false;
    std::vector<std::size_t> offset(1, 0);
    for (std::size_t i = 3; i < header.size(); ++i) {
        if (header[i] > text.size()) return false;
        offset.push_back(offset.back() + header[i]);
    }
    if (base64_size(offset.back()) != text.size()) return false;
    Bytes body(offset.back());
    if (!take_base64(text, body.size(), body.data())) return false;
    std::atomic<bool> good = true;
    tbb::parallel_for(std::size_t{0}, std::size_t{blocks}, [&](std::size_t i) {
        const auto packed = std::span<const unsigned char>(body).subspan(offset[i], offset[i + 1] - offset[i]);
        if (!uncompress_block(packed, data.subspan(i * size, std::min<std::size_t>(size, data.size() - i * size)))) good = false;
    });
    return good;
}

/// One base64 string: the number of bytes, then the bytes.
std::string encode_plain(std::span<const std::byte> data) {
    Bytes all = to_bytes({data.size()});
    const auto* first = reinterpret_cast<const unsigned char*>(data.data());
    all.insert(all.end(), first, first + data.size());
    std::string text;
    append_base64(text, all);
    return text;
}

bool decode_plain(std::string_view text, std::span<std::byte> data) {
    if (text.size() != base64_size(data.size() + 8)) return false;
    Bytes all(data.size() + 8);
    if (!take_base64(text, all.size(), all.data())) return false;
    std::uint64_t size = 0;
    std::memcpy(&size, all.data(), 8);
    if (!data.empty()) std::memcpy(data.data(), all.data() + 8, data.size());
    return size == data.size();
}

}  // namespace

std::string encode_vtk(std::span<const std::byte> data, bool compressed) {
    return compressed ? encode_compressed(data) : encode_plain(data);
}

bool decode_vtk(std::string_view text, bool compressed, std::span<std::byte> data) {
    return compressed ? decode_compressed(text, data) : decode_plain(text, data);
}

}  // namespace grainray
