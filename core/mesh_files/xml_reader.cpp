// SPDX-License-Identifier: MIT
#include "core/mesh_files/xml_reader.hpp"

#include <expat.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <new>

namespace fettle::core::mesh_files {
namespace {

constexpr int deepest = 100, most_attributes = 100;
/// Fed at once: expat begins anew with what is not complete at the end of a piece, so longer tokens than this are refused.
constexpr std::size_t piece = 1 << 20;

/// XML allows nothing before its declaration; blanks there are common, and mean nothing.
std::string_view from_declaration(std::string_view text) {
    constexpr std::string_view mark = "\xEF\xBB\xBF", declaration = "<?xml";
    std::string_view rest = text.substr(text.starts_with(mark) ? mark.size() : 0);
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n"), rest.size()));
    return rest.starts_with(declaration) ? rest : text;
}

}  // namespace

struct XmlReader::Handlers {
    static XmlReader& reader(void* data) { return *static_cast<XmlReader*>(data); }

    static void start(void* data, const char* name, const char** attributes) {
        XmlReader& xml = reader(data);
        if (xml.stopped_) return;
        xml.opens_ = true;
        xml.depth_ = ++xml.open_;
        xml.take(name, attributes);
    }
    static void end(void* data, const char* name) {
        XmlReader& xml = reader(data);
        if (xml.stopped_) return;
        xml.opens_ = false;
        xml.depth_ = xml.open_--;
        xml.take(name, nullptr);
    }
    static void document_type(void* data, const char*, const char*, const char*, int) {
        reader(data).fault("a document type is not read");
        reader(data).stop();
    }
};

XmlReader::XmlReader(std::string_view text, std::string where)
    : text_(from_declaration(text)),
      lines_before_(static_cast<std::uint64_t>(std::count(text.data(), text_.data(), '\n'))),
      where_(std::move(where)),
      parser_(XML_ParserCreate(nullptr), XML_ParserFree) {
    if (!parser_) throw std::bad_alloc();
    XML_SetElementHandler(parser_.get(), Handlers::start, Handlers::end);
    XML_SetStartDoctypeDeclHandler(parser_.get(), Handlers::document_type);
}

void XmlReader::take(const char* name, const char** attributes) {
    name_ = name;
    name_.remove_prefix(name_.find(':') + 1);
    attributes_ = attributes;
    if (depth_ > deepest) fault("elements nested deeper than 100");
    if (attributes != nullptr && XML_GetSpecifiedAttributeCount(parser_.get()) > 2 * most_attributes)
        fault("a tag with more than 100 attributes");
    try {
        if (errors_.empty()) (*visit_)();
    } catch (...) {
        thrown_ = std::current_exception();
    }
    attributes_ = nullptr;
    if (thrown_ || !errors_.empty()) stop();
}

void XmlReader::read(const std::function<void()>& visit) {
    visit_ = &visit;
    XML_SetUserData(parser_.get(), this);
    for (std::size_t at = 0; !stopped_; at += piece) {
        const std::size_t size = std::min(piece, text_.size() - at);
        const bool is_last = at + size == text_.size();
        const XML_Status status = XML_Parse(parser_.get(), text_.data() + at, static_cast<int>(size), is_last);
        if (thrown_) std::rethrow_exception(thrown_);
        if (stopped_ || (status == XML_STATUS_OK && is_last)) return;
        if (status != XML_STATUS_OK) return fault(XML_ErrorString(XML_GetErrorCode(parser_.get())));
        if (XML_GetCurrentByteIndex(parser_.get()) + static_cast<XML_Index>(piece) < static_cast<XML_Index>(at))
            return fault("a tag or a comment of more than a megabyte");
    }
}

void XmlReader::stop() {
    stopped_ = true;
    XML_StopParser(parser_.get(), XML_FALSE);
}

std::optional<std::string_view> XmlReader::attribute(std::string_view name) const {
    for (const char** at = attributes_; at != nullptr && *at != nullptr; at += 2)
        if (*at == name) return at[1];
    return std::nullopt;
}

std::vector<std::string_view> XmlReader::attribute_names() const {
    std::vector<std::string_view> names;
    for (const char** at = attributes_; at != nullptr && *at != nullptr; at += 2) names.emplace_back(*at);
    return names;
}

std::string XmlReader::where() const { return where_ + ":" + std::to_string(lines_before_ + XML_GetCurrentLineNumber(parser_.get())); }

void XmlReader::fail(ErrorCode code, const std::string& message) { errors_.push_back({code, where(), message}); }

}  // namespace fettle::core::mesh_files
