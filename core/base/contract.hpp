// SPDX-License-Identifier: MIT
/// Contracts between our own functions. A broken one is a bug of ours, never a user's mistake (that is Result, result.hpp):
/// it throws ContractError in every build type, which the program turns into exit code 4.
#pragma once

#include <stdexcept>
#include <string>

namespace fettle::core::base {

class ContractError : public std::logic_error {
public:
    using std::logic_error::logic_error;
};

[[noreturn]] void fail_contract(const char* condition, const char* file, int line, const std::string& message);

}  // namespace fettle::core::base

/// Checks a contract in every build type; `message` is evaluated only when it is broken.
#define FETTLE_ASSERT(condition, message) \
    ((condition) ? static_cast<void>(0) : ::fettle::core::base::fail_contract(#condition, __FILE__, __LINE__, (message)))
