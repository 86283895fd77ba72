// SPDX-License-Identifier: MIT
#include "core/files/json_text.hpp"

namespace fettle::core::files {

bool is_safe_json_text(std::string_view text) {
    if (text.find('\0') != std::string_view::npos) return false;
    std::size_t depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > deepest_json) return false;
        } else if ((c == '}' || c == ']') && depth > 0) {
            --depth;
        }
    }
    return true;
}

}  // namespace fettle::core::files
