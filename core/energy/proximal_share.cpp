// SPDX-License-Identifier: MIT
#include "fettle/core/energy/proximal_share.hpp"

#include <algorithm>

#include "fettle/core/energy/inertia.hpp"
#include "fettle/core/model/choose_proximal_weight.hpp"

namespace fettle::core::energy {

std::vector<double> proximal_shares(const StepProblem& problem, const std::vector<kinematics::ChartPoint>& points,
                                    const std::vector<kinematics::Pose>& poses) {
    const model::Model& model = *problem.model;
    const std::vector<double> loads = model::reference_loads(model);
    std::vector<double> shares(poses.size(), 0);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        if (!(loads[i] > 0)) continue;
        const model::Body& body = model.bodies[i];
        kinematics::PoseGradient gradient;
        add_inertia_gradient(poses[i], problem.pose_hat[i], body.moments, gradient);
        Vector6 carried = tangent_gradient(gradient) / problem.weight;
        carried.tail<3>() = kinematics::left_jacobian(points[i].rotation_vector).transpose() * carried.tail<3>();
        for (int k = 0; k < 6; ++k)
            if (!is_free(body, k)) carried[k] = 0;
        shares[i] = (carried.head<3>().norm() + carried.tail<3>().norm() / std::max(body.radius, model.dhat)) / loads[i];
    }
    return shares;
}

}  // namespace fettle::core::energy
