// SPDX-License-Identifier: MIT
#include "core/solver/coasting.hpp"

#include <cmath>

namespace fettle::core::solver {

using kinematics::ChartPoint;

std::vector<ChartPoint> coasted(const energy::StepProblem& problem, const std::vector<Vector6>& targets, const linear::FreeDofs& dofs) {
    const double widest_sine = std::sin(0.5);
    const model::Model& model = *problem.model;
    std::vector<ChartPoint> points(problem.poses_t0.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const kinematics::Pose& start = problem.poses_t0[i];
        Vector6 y;
        y << start.position, Vector3::Zero();
        if (energy::has_free_dof(model.bodies[i])) {
            const Matrix34& hat = problem.pose_hat[i];
            const Matrix3 turn = hat.leftCols<3>() * start.rotation.transpose();
            const Vector3 axis = 0.5 * Vector3(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
            const double sine = axis.norm();
            if (!(sine <= widest_sine)) return {};
            y.head<3>() = hat.col(3) - problem.weight * model.gravity;
            if (sine > 0) y.tail<3>() = std::asin(sine) / sine * axis;
        }
        for (int k = 0; k < 6; ++k)
            if (dofs.index[i][k] < 0) y[k] = targets[i][k];
        points[i] = {y.head<3>(), y.tail<3>()};
    }
    return points;
}

}  // namespace fettle::core::solver
