// SPDX-License-Identifier: MIT
/// The files that were read while something was made, with their contents: the thing made depends on these bytes. Whatever opens files to
/// read them reports it here (files/input_file.hpp), so that nobody has to list them.
///
///     const ReadRecord record;                                     // of this thread, and of those that help with its loops
///     design = read_design(path);
///     design.files = record.files();
#pragma once

#include <cstdint>
#include <mutex>
#include <set>
#include <string>
#include <utility>

namespace fettle::core::base {

/// While it lives, what its thread reads is recorded.
class ReadRecord {
public:
    /// Each path as it was opened, with a hash of what stood there; one that was read twice and had changed stands there twice.
    using Files = std::set<std::pair<std::string, std::uint64_t>>;
    enum class Outer {
        told,  ///< the record that it stands in gets its files too
        apart  ///< what is read is nobody else's: a file that was made to be read once
    };

    explicit ReadRecord(Outer outer = Outer::told) : outer_(innermost()), told_(outer == Outer::told) { innermost() = this; }
    ~ReadRecord() {
        innermost() = outer_;
        if (told_) tell(files_);
    }
    ReadRecord(const ReadRecord&) = delete;
    ReadRecord& operator=(const ReadRecord&) = delete;

    Files files() const {
        const std::lock_guard lock(mutex_);
        return files_;
    }

    /// Adds to the record of this thread, if there is one: of files that were read before, too.
    static void tell(const Files& files) {
        ReadRecord* const record = innermost();
        if (record == nullptr) return;
        const std::lock_guard lock(record->mutex_);
        record->files_.insert(files.begin(), files.end());
    }

    /// This thread's; null: nothing is recorded. Loops hand it to the threads that help (parallel.cpp).
    static ReadRecord*& innermost() {
        static thread_local ReadRecord* record = nullptr;
        return record;
    }

private:
    mutable std::mutex mutex_;
    Files files_;
    ReadRecord* outer_;
    bool told_;
};

}  // namespace fettle::core::base
