// SPDX-License-Identifier: MIT
/// A shared library that is loaded where it is first needed: what few commands use must not cost every start. Which libraries that are is
/// decided by the build (fettle_load_on_use in .cmake/load_on_use.cmake); a library that is linked as ever needs nothing of this.
#pragma once

#include <stdexcept>
#include <string>

namespace fettle::core::base {

/// A library, or a function in it, is not there. what() names it, quotes the loader and says how to mend it.
class MissingLibrary : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

class SharedLibrary {
public:
    /// Throws MissingLibrary; std::bad_alloc where there is no memory for it.
    /// @param name  As the loader looks for it: "libnlopt.so.0".
    /// @param path  Where it was when this program was built: tried second. Empty: nowhere.
    SharedLibrary(const std::string& name, const std::string& path);

    /// Sets `function` to the library's of this name. Throws MissingLibrary.
    template <class Function>
    void find(const char* symbol, Function*& function) const {
        function = reinterpret_cast<Function*>(address(symbol));
    }

    /// The address of what has this name in the library or in those that it needs; null: none has it.
    void* find_any(const char* symbol) const;

private:
    void* address(const char* symbol) const;

    std::string name_;
    void* handle_ = nullptr;  ///< never closed: libraries keep threads and memory of their own
};

}  // namespace fettle::core::base
