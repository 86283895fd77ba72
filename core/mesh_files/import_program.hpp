// SPDX-License-Identifier: MIT
/// What the programs have in common that read files for import_process.hpp: their limits, and how they write to their parent.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/mesh_files/import_format.hpp"

namespace fettle::core::mesh_files {

/// Where the answer is written: 1 is what libraries print to.
class ImportPipe {
public:
    explicit ImportPipe(int descriptor = STDOUT_FILENO) : descriptor_(descriptor) {}

    bool write(const void* data, std::size_t size) const {
        const char* at = static_cast<const char*>(data);
        while (size > 0) {
            const ssize_t written = ::write(descriptor_, at, size);
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) return false;
            at += written;
            size -= static_cast<std::size_t>(written);
        }
        return true;
    }
    template <class Value>
    bool write_list(const std::vector<Value>& values) const {
        return write(values.data(), values.size() * sizeof(Value));
    }
    bool write_texts(const std::vector<std::string>& texts) const {
        bool good = true;
        for (const std::string& text : texts) {
            const auto length = static_cast<std::uint32_t>(text.size());
            good = good && write(&length, sizeof length) && write(text.data(), text.size());
        }
        return good;
    }
    bool write_end() const { return write(&import_end, sizeof import_end); }
    /// @return `code`
    int write_failure(const std::string& reason, int code) const {
        ImportHeader header;
        header.mark = import_is_failure;
        write(&header, sizeof header);
        write(reason.data(), reason.size());
        return code;
    }

private:
    int descriptor_;
};

/// Takes the limits that stand in the words behind FILE: SECONDS BYTES.
inline void take_limits(char** arguments) {
    const auto limit = [](__rlimit_resource_t what, rlim_t most, rlim_t last = 0) {
        const rlimit limits{most, std::max(most, last)};
        ::setrlimit(what, &limits);
    };
    const rlim_t seconds = std::strtoull(arguments[2], nullptr, 10);
    limit(RLIMIT_CPU, seconds, seconds + 1);  // SIGXCPU tells why
    limit(RLIMIT_AS, std::strtoull(arguments[3], nullptr, 10));
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);  // it reads
}

}  // namespace fettle::core::mesh_files
