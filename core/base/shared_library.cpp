// SPDX-License-Identifier: MIT
#include "core/base/shared_library.hpp"

#include <dlfcn.h>

#include <new>
#include <string_view>

namespace fettle::core::base {
namespace {

std::string last_fault() {
    const char* fault = dlerror();
    return fault != nullptr ? fault : "no reason was given";
}

// The loader has no code for it; a folder whose files may not be run says that it is not permitted.
bool is_want_of_memory(std::string_view fault) {
    const auto says = [fault](const char* words) { return fault.find(words) != std::string_view::npos; };
    return says("annot allocate memory") || (says("failed to map segment") && !says("not permitted"));
}

}  // namespace

SharedLibrary::SharedLibrary(const std::string& name, const std::string& path) : name_(name) {
    // Not for others to find symbols in, and with all of its own bound when they are called.
    handle_ = dlopen(name.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (handle_ != nullptr) return;
    const std::string fault = last_fault();
    if (is_want_of_memory(fault)) throw std::bad_alloc();
    if (!path.empty()) handle_ = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (handle_ == nullptr)
        throw MissingLibrary("the library " + name + ", which this needs, cannot be loaded: " + fault +
                             "; install it, or say where it is with LD_LIBRARY_PATH");
}

void* SharedLibrary::find_any(const char* symbol) const { return dlsym(handle_, symbol); }

void* SharedLibrary::address(const char* symbol) const {
    void* const found = find_any(symbol);
    if (found == nullptr)
        throw MissingLibrary("the library " + name_ + " is not the one that this needs: " + last_fault() +
                             "; install the version that fettle was built with");
    return found;
}

}  // namespace fettle::core::base
