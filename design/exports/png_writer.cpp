// SPDX-License-Identifier: MIT
// PNG specification, third edition: signature, IHDR, one IDAT, IEND.
#include "fettle/design/exports/png_writer.hpp"

#include <zlib.h>

#include <cstdint>

#include "fettle/core/base/contract.hpp"

namespace fettle::design::exports {

namespace {

void append_big_endian(std::string& out, std::uint32_t word) {
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(word >> shift & 255);
}

void append_chunk(std::string& out, const std::string& type, const std::string& data) {
    append_big_endian(out, static_cast<std::uint32_t>(data.size()));
    const std::string body = type + data;
    out += body;
    append_big_endian(out,
                      static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()))));
}

std::string compressed(const std::string& data) {
    uLongf size = compressBound(static_cast<uLong>(data.size()));
    std::string out(size, '\0');
    const int code = compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(data.data()),
                               static_cast<uLong>(data.size()), 6);
    FETTLE_ASSERT(code == Z_OK, "compressBound is enough");
    out.resize(size);
    return out;
}

}  // namespace

std::string png_bytes(const Image& image) {
    FETTLE_ASSERT(image.width > 0 && image.height > 0, "a picture without pixels");
    std::string header;
    append_big_endian(header, static_cast<std::uint32_t>(image.width));
    append_big_endian(header, static_cast<std::uint32_t>(image.height));
    header += std::string("\x08\x02\x00\x00\x00", 5);  // 8 bits, RGB, deflate, the one filter method, not interlaced
    std::string rows;
    for (int y = 0; y < image.height; ++y) {
        rows += '\1';  // filter: difference to the pixel on the left
        core::mesh_files::Colour left{};
        for (int x = 0; x < image.width; ++x) {
            for (std::size_t k = 0; k < 3; ++k) rows += static_cast<char>(image.at(x, y)[k] - left[k]);
            left = image.at(x, y);
        }
    }
    std::string out = "\x89PNG\r\n\x1a\n";
    append_chunk(out, "IHDR", header);
    append_chunk(out, "IDAT", compressed(rows));
    append_chunk(out, "IEND", "");
    return out;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

}  // namespace fettle::design::exports
