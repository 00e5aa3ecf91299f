// SPDX-License-Identifier: MIT
#pragma once

namespace fragtrace {

/// Returns the probability that Student's t with `freedom` degrees of freedom (more than 0, not always whole)
/// is at least as far from 0 as `t` is, on either side. The relative error is below 1e-8 up to 1e8 degrees.
double studentTails(double t, double freedom);

}  // namespace fragtrace
