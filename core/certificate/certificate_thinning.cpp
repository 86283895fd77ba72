// SPDX-License-Identifier: MIT
#include "fettle/core/certificate/certificate_thinning.hpp"

#include <array>
#include <cmath>
#include <initializer_list>

#include "fettle/core/certificate/interval_motion.hpp"

namespace fettle::core::certificate {
namespace {

struct Cell {
    CoordinateBox box;
    int a = 0, b = 0;
};

// A proof whose leaves all have two vectors.
struct PlaneTree {
    std::string splits;  // leaves are `.`
    std::vector<LeafPlane> planes;
};

PlaneTree planes_of(const BoxProof& proof) {
    PlaneTree out{proof.splits, {}};
    std::size_t used = 0;
    for (char& kind : out.splits) {
        if (kind != '.' && kind != ':') continue;
        const std::size_t last = kind == ':' ? used + 1 : used;
        out.planes.push_back({proof.normals[used], proof.normals[last]});
        used = last + 1;
        kind = '.';
    }
    return out;
}

BoxProof proof_of(const PlaneTree& tree) {
    BoxProof out;
    std::size_t leaf = 0;
    for (const char kind : tree.splits) {
        if (kind == '.')
            add_leaf(out, tree.planes[leaf++]);
        else
            out.splits += kind;
    }
    return out;
}

Vector3 rounded(const Vector3& n, double scale) { return (n * scale).array().round() / scale; }

class Thinner {
public:
    Thinner(const CertifiedBody& a, const CertifiedBody& b, const BodyPath& path_a, const BodyPath& path_b, double claim)
        : a_(a), b_(b), prover_(path_a, path_b), claim_(claim) {}

    // Both passes read one proof and write another.
    PlaneTree merged(const PlaneTree& proof) { return pass(proof, &Thinner::keep, &Thinner::merge); }
    PlaneTree shortened(const PlaneTree& proof) { return pass(proof, &Thinner::shorten, nullptr); }

private:
    using OnLeaf = LeafPlane (Thinner::*)(const Cell&, const LeafPlane&);
    using OnTwoLeaves = bool (Thinner::*)(const Cell&, char, LeafPlane&, const LeafPlane&);

    PlaneTree pass(const PlaneTree& proof, OnLeaf on_leaf, OnTwoLeaves on_two_leaves) {
        from_ = &proof;
        to_ = {};
        next_split_ = next_plane_ = 0;
        visit({PathProver::box(), 0, 0}, on_leaf, on_two_leaves);
        return std::move(to_);
    }

    // The cell whose turn it is in `from_`, and all below it. As deep as the search went: 48 halvings and both hierarchies.
    void visit(const Cell& cell, OnLeaf on_leaf, OnTwoLeaves on_two_leaves) {
        const char kind = from_->splits[next_split_++];
        const std::size_t start = to_.splits.size();
        to_.splits += kind;
        if (kind == '.') {
            to_.planes.push_back((this->*on_leaf)(cell, from_->planes[next_plane_++]));
            return;
        }
        Cell first = cell, second = cell;
        if (kind == '0') first.box.high[0] = second.box.low[0] = 0.5 * (cell.box.low[0] + cell.box.high[0]);
        if (kind == 'a') first.a = a_.parts()[cell.a].left, second.a = a_.parts()[cell.a].right;
        if (kind == 'b') first.b = b_.parts()[cell.b].left, second.b = b_.parts()[cell.b].right;
        visit(first, on_leaf, on_two_leaves);
        visit(second, on_leaf, on_two_leaves);
        if (on_two_leaves == nullptr || to_.splits.size() - start != 3) return;
        const std::size_t count = to_.planes.size();
        if (!(this->*on_two_leaves)(cell, kind, to_.planes[count - 2], to_.planes[count - 1])) return;
        to_.planes.pop_back();
        to_.splits.resize(start);
        to_.splits += '.';
    }

    bool is_proven(const Cell& cell, const LeafPlane& plane) {
        const std::array<Vector3, 2> normals{plane.n0, plane.n1};
        return prover_.prove(a_.parts()[cell.a].region, b_.parts()[cell.b].region, cell.box, normals, claim_, 0) > 0;
    }

    LeafPlane keep(const Cell&, const LeafPlane& plane) { return plane; }

    // The plane that proves both goes to the place of the first.
    bool merge(const Cell& cell, char kind, LeafPlane& first, const LeafPlane& second) {
        const LeafPlane both{first.n0, second.n1};
        if (kind == '0' && is_proven(cell, both)) return first = both, true;
        if (is_proven(cell, first)) return true;
        if (is_proven(cell, second)) return first = second, true;
        const LeafPlane mean{0.5 * (first.n0 + second.n0), 0.5 * (first.n1 + second.n1)};
        return kind != '0' && is_proven(cell, mean) ? (first = mean, true) : false;
    }

    LeafPlane shorten(const Cell& cell, const LeafPlane& plane) {
        for (const double scale : {1e2, 1e4, 1e6, 1e9}) {
            const LeafPlane shorter{rounded(plane.n0, scale), rounded(plane.n1, scale)};
            if (is_proven(cell, shorter)) return shorter;
        }
        return plane;
    }

    const CertifiedBody &a_, &b_;
    PathProver prover_;
    double claim_;
    const PlaneTree* from_ = nullptr;
    PlaneTree to_;
    std::size_t next_split_ = 0, next_plane_ = 0;
};

}  // namespace

BoxProof thinned(const BoxProof& proof, const CertifiedBody& a, const CertifiedBody& b, const BodyPath& path_a, const BodyPath& path_b,
                 double distance) {
    Thinner thinner(a, b, path_a, path_b, distance);
    return proof_of(thinner.shortened(thinner.merged(planes_of(proof))));
}

}  // namespace fettle::core::certificate
