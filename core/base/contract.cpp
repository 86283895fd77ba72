// SPDX-License-Identifier: MIT
#include "core/base/contract.hpp"

namespace fettle::core::base {

void fail_contract(const char* condition, const char* file, int line, const std::string& message) {
    throw ContractError(std::string(file) + ":" + std::to_string(line) + ": broken contract `" + condition + "`: " + message);
}

}  // namespace fettle::core::base
