// SPDX-License-Identifier: BSD-3-Clause
// Minimum of a function of a few variables, and its curvature there.
#pragma once

#include <functional>

#include <Eigen/Core>

namespace halocline::clients {

using FunctionOfVector = std::function<double(const Eigen::VectorXd&)>;

// Returns where the function is least, by the simplex of Nelder and Mead 1965 (Computer Journal 7, 308) from
// `start` with edges `steps` (none 0), until its corners agree within 1e-7 or after `most_values`
// evaluations.
Eigen::VectorXd minimum_of(const FunctionOfVector& f, const Eigen::VectorXd& start,
                           const Eigen::VectorXd& steps, int most_values);

// Returns the matrix of second derivatives by central differences over `steps` (none 0).
Eigen::MatrixXd curvature_of(const FunctionOfVector& f, const Eigen::VectorXd& at,
                             const Eigen::VectorXd& steps);

}  // namespace halocline::clients
