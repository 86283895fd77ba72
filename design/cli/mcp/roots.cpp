// SPDX-License-Identifier: MIT
#include "design/cli/mcp/roots.hpp"

#include <algorithm>
#include <system_error>

#include "core/base/text.hpp"

namespace fettle::design::cli::mcp {

namespace fs = std::filesystem;

namespace {

int hexadecimal(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

bool is_below(const fs::path& path, const fs::path& root) {
    return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first == root.end();
}

}  // namespace

Roots::Roots(const std::vector<std::string>& folders) {
    for (const std::string& folder : folders) {
        std::error_code fault;
        const fs::path whole = fs::canonical(folder, fault);
        if (!fault && fs::is_directory(whole, fault)) folders_.push_back(whole);
    }
}

Result<std::string> Roots::inside(const std::string& path, const std::string& where) const {
    if (folders_.empty()) return Error{ErrorCode::unsupported, where, "no folder is open to the tools: the client states none"};
    if (path.empty() || path.find('\0') != std::string::npos) return Error{ErrorCode::unsupported, where, "a path is expected"};
    std::error_code fault;
    const fs::path whole = fs::weakly_canonical(folders_.front() / path, fault);  // an absolute path stays what it is
    if (!fault && std::any_of(folders_.begin(), folders_.end(), [&](const fs::path& root) { return is_below(whole, root); }))
        return whole.string();
    return Error{ErrorCode::unsupported, where, path + " is not below a folder that is open to the tools: " + named()};
}

std::string Roots::named() const {
    std::vector<std::string> names;
    for (const fs::path& folder : folders_) names.push_back(folder.string());
    return core::base::joined(names);
}

std::string path_of_address(const std::string& address) {
    constexpr std::string_view scheme = "file://";
    if (!address.starts_with(scheme)) return {};
    const std::size_t slash = address.find('/', scheme.size());
    const std::string host = address.substr(scheme.size(), slash == std::string::npos ? slash : slash - scheme.size());
    if (slash == std::string::npos || !(host.empty() || host == "localhost")) return {};
    std::string path;
    for (std::size_t k = slash; k < address.size(); ++k) {
        if (address[k] != '%') {
            path += address[k];
            continue;
        }
        if (k + 2 >= address.size() || hexadecimal(address[k + 1]) < 0 || hexadecimal(address[k + 2]) < 0) return {};
        path += static_cast<char>(16 * hexadecimal(address[k + 1]) + hexadecimal(address[k + 2]));
        k += 2;
    }
    return path;
}

}  // namespace fettle::design::cli::mcp
