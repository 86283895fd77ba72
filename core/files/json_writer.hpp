// SPDX-License-Identifier: MIT
/// JSON as text, written front to back: what fettle's own formats (trajectories, certificates) are made of. Every number is the shortest
/// decimal that reads back to the same double, bit for bit. Reading is json_document.hpp.
///
///     JsonWriter out;
///     out.text = "{";
///     out.key("weights");
///     out.numbers(weights);
///     out.text += "}\n";
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fettle::core::files {

/// Appends to `text`. Braces are the caller's, put into `text` as they are.
class JsonWriter {
public:
    std::string text;

    /// Contract: finite. -0 keeps its sign.
    void number(double x);
    /// Quoted and escaped.
    void string(std::string_view value);
    /// Begins a member of the object that `text` is in: a comma and a new line unless it is its first, then `"name": `.
    void key(std::string_view name);
    /// "[", one item after the other as `write(i)` puts them, "]".
    template <class Write>
    void list(std::size_t count, std::string_view separator, const Write& write) {
        text += '[';
        for (std::size_t i = 0; i < count; ++i) {
            if (i > 0) text += separator;
            write(i);
        }
        text += ']';
    }
    /// A list of numbers: an Eigen vector or a standard container.
    template <class Values>
    void numbers(const Values& values) {
        text += '[';
        for (const auto& value : values) {
            if (text.back() != '[') text += ',';
            number(static_cast<double>(value));
        }
        text += ']';
    }
};

}  // namespace fettle::core::files
