// SPDX-License-Identifier: MIT
#include "core/certificate/certificate.hpp"

#include <algorithm>
#include <set>

namespace fettle::core::certificate {

char split_along(int k) { return static_cast<char>(k < 10 ? '0' + k : 'A' + (k - 10)); }

int variable_of_split(char kind) {
    if (kind >= '0' && kind <= '9') return kind - '0';
    return kind >= 'A' && kind < 'A' + most_variables - 10 ? kind - 'A' + 10 : -1;
}

void add_leaf(BoxProof& proof, const LeafPlane& plane) {
    const bool is_one = plane.n0 == plane.n1;
    proof.splits += is_one ? '.' : ':';
    proof.normals.push_back(plane.n0);
    if (!is_one) proof.normals.push_back(plane.n1);
}

std::vector<std::array<int, 2>> uncovered_pairs(const Certificate& certificate, int bodies) {
    std::set<std::array<int, 2>> covered;
    for (const PairCertificate& pair : certificate.pairs) covered.insert({std::min(pair.a, pair.b), std::max(pair.a, pair.b)});
    std::vector<std::array<int, 2>> uncovered;
    for (int a = 0; a < bodies; ++a)
        for (int b = a + 1; b < bodies; ++b)
            if (covered.count({a, b}) == 0) uncovered.push_back({a, b});
    return uncovered;
}

}  // namespace fettle::core::certificate
