// SPDX-License-Identifier: MIT
#include "core/certificate/toleranced_chain.hpp"

namespace fettle::core::certificate {

ModelPose unmoved_pose() {
    ModelPose out;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) out.rotation[i][j] = TaylorModel(i == j ? 1 : 0);
    return out;
}

ModelPose composed(const ModelPose& outer, const ModelPose& inner) {
    return {product(outer.rotation, inner.rotation), times(outer.rotation, inner.place) + outer.place};
}

Model3 exact_model(const Vector3& x) { return {TaylorModel(x[0]), TaylorModel(x[1]), TaylorModel(x[2])}; }

Model3 cross(const Model3& a, const Model3& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }

geometry::Interval3 intervals(const Model3& x) { return {x[0].interval(), x[1].interval(), x[2].interval()}; }

ModelPose pose_along(const std::vector<ChainLink>& line, const std::vector<TaylorModel>& positions, std::vector<PlacedScrew>* screws) {
    ModelPose out = unmoved_pose();
    for (const ChainLink& link : line) {
        for (const ChainScrew& screw : link.screws) {
            if (screws != nullptr)
                screws->push_back({screw.position, screw.turn, screw.slide, times(out.rotation, screw.point) + out.place,
                                   times(out.rotation, screw.axis)});
            TaylorModel d = positions[static_cast<std::size_t>(screw.position)] - TaylorModel(screw.start);
            if (screw.driven) d = screw.driven->shift + screw.driven->scale * d;
            ModelPose motion = unmoved_pose();
            if (screw.turn != 0) {
                motion.rotation = turned_about(screw.axis, scaled(screw.turn, d));
                motion.place = screw.point - times(motion.rotation, screw.point);
            }
            if (screw.slide != 0) {
                const TaylorModel way = scaled(screw.slide, d);
                for (std::size_t i = 0; i < 3; ++i) motion.place[i] = motion.place[i] + way * screw.axis[i];
            }
            out = composed(out, motion);
        }
        out = composed(out, {link.rotation, link.place});
    }
    return out;
}

}  // namespace fettle::core::certificate
