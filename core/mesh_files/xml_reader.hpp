// SPDX-License-Identifier: MIT
/// Reads XML that may come from anywhere, by expat: elements and attributes; text between elements is passed over. What is not well formed
/// is refused but for blanks before the declaration, and so is a document type (and with it every entity of a file's own), nesting deeper
/// than 100, more than 100 attributes in a tag, and a tag, comment or the like of more than a megabyte, so that reading takes linear time.
/// For 3MF, AMF and URDF.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"

struct XML_ParserStruct;

namespace fettle::core::mesh_files {

/// Visits the tags of a text:
///
///     xml.read([&] { if (xml.opens() && xml.name() == "vertex") x = xml.attribute("x"); });
///     if (!xml.errors().empty()) ...
///
/// A tag that closes itself opens and closes: two visits. `name` and what is said of attributes hold within a visit.
class XmlReader {
public:
    /// @param text  Outlives this object. @param where  The path, for messages.
    XmlReader(std::string_view text, std::string where);

    /// To the end, or to the first fault, that of a visit included. Contract: once.
    void read(const std::function<void()>& visit);
    /// Within a visit: this was the last one.
    void stop();

    bool opens() const { return opens_; }            ///< else this is an end tag
    std::string_view name() const { return name_; }  ///< of the element, without its prefix ("p:item": "item")
    int depth() const { return depth_; }             ///< of the element, the root's is 1

    /// By its full name ("p:path").
    std::optional<std::string_view> attribute(std::string_view name) const;
    /// Full names, in order.
    std::vector<std::string_view> attribute_names() const;

    /// "path:12": the line of the tag.
    std::string where() const;
    void fail(ErrorCode code, const std::string& message);
    const Errors& errors() const { return errors_; }

private:
    struct Handlers;
    void take(const char* name, const char** attributes);
    void fault(const std::string& message) { fail(ErrorCode::parse, "not valid XML: " + message); }

    std::string_view text_;
    std::uint64_t lines_before_;  ///< its XML declaration
    std::string where_;
    std::shared_ptr<XML_ParserStruct> parser_;
    const std::function<void()>* visit_ = nullptr;
    std::exception_ptr thrown_;  ///< by a visit: past expat, which is written in C
    bool opens_ = false, stopped_ = false;
    int depth_ = 0, open_ = 0;
    std::string_view name_;
    const char** attributes_ = nullptr;  ///< name, value, name, value, ..., null
    Errors errors_;
};

}  // namespace fettle::core::mesh_files
