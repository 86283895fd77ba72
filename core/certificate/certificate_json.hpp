// SPDX-License-Identifier: MIT
/// What the files of both kinds of certificate (certificate.hpp, range_certificate.hpp) have in common; certificate_json.cpp reads and
/// writes the first kind.
#pragma once

#include <cstdint>
#include <vector>

#include "fettle/core/certificate/certificate.hpp"
#include "fettle/core/files/json_document.hpp"
#include "fettle/core/files/json_writer.hpp"

namespace fettle::core::certificate {

/// `"name": {kind, index, weight}`.
void write_point(files::JsonWriter& out, const char* name, const CertifiedPoint& point);
CertifiedPoint read_point(const files::JsonNode& node);

/// [{elements, cuts}].
void write_pieces(files::JsonWriter& out, const std::vector<BodyPieces>& bodies);
std::vector<BodyPieces> read_pieces(const files::JsonNode& node);

Solids read_solids(const files::JsonNode& node);

/// Hexadecimal.
std::uint64_t read_hash(const files::JsonNode& node);

}  // namespace fettle::core::certificate
