// SPDX-License-Identifier: MIT
#include "fettle/core/mesh_files/xml_reader.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "fettle/core/base/text.hpp"

namespace fettle::core::mesh_files {
namespace {

constexpr std::string_view blanks = " \t\r\n";
constexpr std::string_view after_name = " \t\r\n=/><\"'";
constexpr std::size_t deepest = 100, most_attributes = 100;

std::string_view without_prefix(std::string_view name) { return name.substr(name.find(':') + 1); }

void append_utf8(std::string& out, unsigned long code) {
    if (code < 0x80) {
        out += static_cast<char>(code);
        return;
    }
    const int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    const unsigned long first = more == 1 ? 0xC0 : more == 2 ? 0xE0 : 0xF0;
    out += static_cast<char>(first | code >> (6 * more));
    for (int k = more - 1; k >= 0; --k) out += static_cast<char>(0x80 | (code >> (6 * k) & 0x3F));
}

/// "lt", "#60", "#x3C" -> "<"; what is not known stays as it is.
std::string resolved(std::string_view entity) {
    constexpr std::array<std::pair<std::string_view, char>, 5> known = {
        {{"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"quot", '"'}, {"apos", '\''}}};
    for (const auto& [name, character] : known) {
        if (entity == name) return std::string(1, character);
    }
    std::string out;
    if (entity.size() > 1 && entity[0] == '#') {
        const bool hexadecimal = entity[1] == 'x';
        const std::string_view digits = entity.substr(hexadecimal ? 2 : 1);
        unsigned long code = 0;
        const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), code, hexadecimal ? 16 : 10);
        if (status == std::errc() && end == digits.data() + digits.size() && code > 0 && code < 0x110000 &&
            (code < 0xD800 || code >= 0xE000))
            append_utf8(out, code);
    }
    return out.empty() ? "&" + std::string(entity) + ";" : out;
}

}  // namespace

bool XmlReader::next() {
    if (!errors_.empty()) return false;
    if (!std::exchange(known_as_utf8_, true) && !base::is_utf8(text_)) return fault("the file is not UTF-8");
    if (at_ == 0 && text_.find('\0') != std::string_view::npos) return fault("there is a NUL in it; is the file damaged?");
    if (std::exchange(closes_itself_, false)) {
        opens_ = false;
        attributes_.clear();
        depth_ = static_cast<int>(open_.size());
        open_.pop_back();
        return true;
    }
    if (!skip_to_tag()) return false;
    opens_ = text_[at_] != '/';
    if (!opens_) ++at_;
    const std::string_view full = word();
    name_ = without_prefix(full);
    attributes_.clear();
    if (full.empty()) return fault("a tag without a name");
    if (opens_) {
        if (open_.size() >= deepest) return fault("elements nested deeper than 100");
        open_.push_back(full);
        depth_ = static_cast<int>(open_.size());
        return read_attributes();
    }
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != '>') return fault("an end tag that does not end");
    ++at_;
    if (open_.empty() || open_.back() != full)
        return fault("the end tag </" + std::string(full.substr(0, 40)) + "> closes no element that is open");
    depth_ = static_cast<int>(open_.size());
    open_.pop_back();
    return true;
}

/// To the first character of the next tag's name (or its slash), past text, comments, declarations and CDATA.
bool XmlReader::skip_to_tag() {
    while (true) {
        tag_ = at_ = std::min(text_.find('<', at_), text_.size());
        if (at_ == text_.size())
            return open_.empty() ? false : fault("the file ends inside <" + std::string(open_.back().substr(0, 40)) + ">");
        const auto skip = [&](std::string_view begin, std::string_view end) {
            if (text_.substr(at_, begin.size()) != begin) return false;
            const std::size_t found = text_.find(end, at_ + begin.size());
            at_ = found == std::string_view::npos ? text_.size() : found + end.size();
            return true;
        };
        if (skip("<!--", "-->") || skip("<?", "?>") || skip("<![CDATA[", "]]>")) continue;
        ++at_;
        if (at_ >= text_.size()) return fault("the file ends inside a tag");
        if (text_[at_] == '!') return fault("a document type is not read");
        return true;
    }
}

bool XmlReader::read_attributes() {
    while (true) {
        skip_blanks();
        if (at_ >= text_.size()) return fault("the file ends inside a tag");
        if (text_[at_] == '>') {
            ++at_;
            return true;
        }
        if (text_.substr(at_, 2) == "/>") {
            at_ += 2;
            closes_itself_ = true;
            return true;
        }
        const std::string_view name = word();
        skip_blanks();
        if (name.empty() || at_ >= text_.size() || text_[at_] != '=') return fault("an attribute is a name, =, and a value in quotes");
        ++at_;
        skip_blanks();
        const char quote = at_ < text_.size() ? text_[at_] : ' ';
        const std::size_t end = quote == '"' || quote == '\'' ? text_.find(quote, at_ + 1) : std::string_view::npos;
        if (end == std::string_view::npos) return fault("the value of `" + std::string(name.substr(0, 40)) + "` is not in quotes");
        if (attributes_.size() >= most_attributes) return fault("a tag with more than 100 attributes");
        attributes_.push_back({name, text_.substr(at_ + 1, end - at_ - 1)});
        at_ = end + 1;
    }
}

void XmlReader::skip_blanks() { at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size()); }

std::string_view XmlReader::word() {
    const std::size_t end = std::min(text_.find_first_of(after_name, at_), text_.size());
    const std::string_view found = text_.substr(at_, end - at_);
    at_ = end;
    return found;
}

std::optional<std::string_view> XmlReader::raw_attribute(std::string_view name) const {
    for (const Attribute& attribute : attributes_) {
        if (attribute.name == name) return attribute.value;
    }
    return std::nullopt;
}

std::optional<std::string> XmlReader::attribute(std::string_view name) const {
    auto raw = raw_attribute(name);
    if (!raw) return std::nullopt;
    std::string out;
    for (std::size_t at = 0; at < raw->size(); ++at) {
        const std::size_t end = (*raw)[at] == '&' ? raw->find(';', at) : std::string_view::npos;
        if (end == std::string_view::npos) {
            out += (*raw)[at];
            continue;
        }
        out += resolved(raw->substr(at + 1, end - at - 1));
        at = end;
    }
    return out;
}

std::vector<std::string_view> XmlReader::attribute_names() const {
    std::vector<std::string_view> names;
    for (const Attribute& attribute : attributes_) names.push_back(attribute.name);
    return names;
}

std::string XmlReader::where() const {
    // Counted on from where it was asked last: a file may be asked for the line of every tag.
    const std::size_t end = std::min(tag_, text_.size());
    if (end < counted_to_) counted_to_ = lines_counted_ = 0;
    const auto from = [&](std::size_t at) { return text_.begin() + static_cast<std::ptrdiff_t>(at); };
    lines_counted_ += static_cast<std::size_t>(std::count(from(counted_to_), from(end), '\n'));
    counted_to_ = end;
    return where_ + ":" + std::to_string(1 + lines_counted_);
}

void XmlReader::fail(ErrorCode code, const std::string& message) { errors_.push_back({code, where(), message}); }

bool XmlReader::fault(const std::string& message) {
    fail(ErrorCode::parse, "not valid XML: " + message);
    return false;
}

}  // namespace fettle::core::mesh_files
