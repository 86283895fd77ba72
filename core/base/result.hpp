// SPDX-License-Identifier: MIT
/// Errors in input from outside (files, options, meshes): a value or the list of everything that is wrong with it.
/// Numerical outcomes are reports with a status; broken contracts of our own are contract.hpp.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/contract.hpp"

namespace fettle::core::base {

enum class ErrorCode {
    file_not_found,    ///< no such file, or not where it was looked for
    file_unreadable,   ///< exists but cannot be read
    file_unwritable,   ///< a file, a folder or standard output that cannot be written: no permission, a full disk
    out_of_memory,     ///< the request needs more memory than there is
    parse,             ///< not valid JSON, not a mesh of its format
    unknown_key,       ///< a key that the format does not have
    missing_key,       ///< a key that the format requires
    wrong_type,        ///< a string where a number is wanted, and so on
    out_of_range,      ///< a number outside what is allowed
    not_finite,        ///< NaN or infinity
    mesh_invalid,      ///< open, inconsistently oriented, degenerate, self-intersecting
    bodies_intersect,  ///< two bodies intersect, or are closer than the minimum separation, at the start
    inconsistent,      ///< parts of the input contradict each other
    unsupported        ///< valid, but not something this version does
};

struct Error {
    ErrorCode code = ErrorCode::parse;
    std::string where;    ///< file and JSON pointer ("a.scene.json#/bodies/3/density"), or mesh and element
    std::string message;  ///< the fault, what is allowed, and the remedy
};

using Errors = std::vector<Error>;

/// A value, or at least one Error.
template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : data_(std::move(value)) {}              // NOLINT: implicit by design, `return value;`
    Result(Error error) : data_(Errors{std::move(error)}) {}  // NOLINT
    Result(Errors errors) : data_(std::move(errors)) {        // NOLINT
        FETTLE_ASSERT(!std::get<Errors>(data_).empty(), "a failed Result needs an error");
    }

    bool has_value() const { return data_.index() == 0; }
    explicit operator bool() const { return has_value(); }

    const T& value() const& {
        check();
        return std::get<0>(data_);
    }
    T& value() & {
        check();
        return std::get<0>(data_);
    }
    T&& value() && {
        check();
        return std::get<0>(std::move(data_));
    }
    const T& operator*() const& { return value(); }
    T& operator*() & { return value(); }
    T&& operator*() && { return std::move(*this).value(); }
    const T* operator->() const { return &value(); }
    T* operator->() { return &value(); }

    /// All errors, empty when there is a value.
    const Errors& errors() const {
        static const Errors none;
        return has_value() ? none : std::get<1>(data_);
    }

private:
    void check() const { FETTLE_ASSERT(has_value(), "value() of a failed Result: " + errors().front().message); }
    std::variant<T, Errors> data_;
};

}  // namespace fettle::core::base
