// SPDX-License-Identifier: MIT
#include "adjoint/energy/term_adjoint.hpp"

namespace fettle::adjoint::energy {

core::base::Error refusal(const std::string& where, const std::string& what) {
    return {core::base::ErrorCode::unsupported, where, what + " cannot be differentiated"};
}

}  // namespace fettle::adjoint::energy
