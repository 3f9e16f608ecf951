// SPDX-License-Identifier: BSD-3-Clause
// Velocities and forces along and about the body axes, as plain numbers that a compiler keeps in registers.
//
// An Eigen vector whose coefficients are set one by one and then added as a whole goes through memory and
// waits there for each coefficient, which made the right-hand side of the equations of motion a third slower.
// Names are those of SNAME 1950 (Fossen 2021, table 2.1). Frame: body, about CO, x forward, y starboard, z
// down. SI units and radians.
#pragma once

#include <cmath>

#include "core/frames.h"
#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {

// Vector in the body frame.
struct Axes {
  double x = 0, y = 0, z = 0;

  Axes() = default;
  Axes(double along_x, double along_y, double along_z) : x(along_x), y(along_y), z(along_z) {}
  Axes(const Vec3& v) : x(v[0]), y(v[1]), z(v[2]) {}  // NOLINT(google-explicit-constructor)
};

inline Axes operator+(const Axes& a, const Axes& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Axes operator-(const Axes& a, const Axes& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Axes operator*(double s, const Axes& a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(const Axes& a, const Axes& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double length(const Axes& a) { return std::sqrt(dot(a, a)); }
inline Axes cross(const Axes& a, const Axes& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Velocities of surge, sway and heave, m/s, and rates of roll, pitch and yaw, rad/s; or their time
// derivatives.
struct BodyVelocity {
  double u = 0, v = 0, w = 0, p = 0, q = 0, r = 0;

  BodyVelocity() = default;
  BodyVelocity(const Axes& linear, const Axes& angular)
      : u(linear.x), v(linear.y), w(linear.z), p(angular.x), q(angular.y), r(angular.z) {}
  BodyVelocity(const Vec6& nu)  // NOLINT(google-explicit-constructor)
      : u(nu[0]), v(nu[1]), w(nu[2]), p(nu[3]), q(nu[4]), r(nu[5]) {}

  Axes linear() const { return {u, v, w}; }
  Axes angular() const { return {p, q, r}; }
  Vec6 vector() const { return Vec6{{u, v, w, p, q, r}}; }
};

inline BodyVelocity operator+(const BodyVelocity& a, const BodyVelocity& b) {
  return {a.linear() + b.linear(), a.angular() + b.angular()};
}
inline BodyVelocity operator*(double s, const BodyVelocity& v) { return {s * v.linear(), s * v.angular()}; }

// Forces, N, and moments, N m.
struct BodyForce {
  double x = 0, y = 0, z = 0, k = 0, m = 0, n = 0;

  BodyForce() = default;
  BodyForce(double fx, double fy, double fz, double mx, double my, double mz)
      : x(fx), y(fy), z(fz), k(mx), m(my), n(mz) {}
  BodyForce(const Axes& force, const Axes& moment)
      : x(force.x), y(force.y), z(force.z), k(moment.x), m(moment.y), n(moment.z) {}

  Vec6 vector() const { return Vec6{{x, y, z, k, m, n}}; }
};

inline BodyForce operator+(const BodyForce& a, const BodyForce& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z, a.k + b.k, a.m + b.m, a.n + b.n};
}
inline BodyForce operator*(double s, const BodyForce& f) {
  return {s * f.x, s * f.y, s * f.z, s * f.k, s * f.m, s * f.n};
}

// Returns `matrix` times a vector of six numbers, summed column by column.
inline Vec6 times(const Mat6& matrix, double c0, double c1, double c2, double c3, double c4, double c5) {
  Vec6 sum = matrix.col(0) * c0;
  sum += matrix.col(1) * c1;
  sum += matrix.col(2) * c2;
  sum += matrix.col(3) * c3;
  sum += matrix.col(4) * c4;
  sum += matrix.col(5) * c5;
  return sum;
}
inline Vec6 times(const Mat6& matrix, const BodyVelocity& nu) {
  return times(matrix, nu.u, nu.v, nu.w, nu.p, nu.q, nu.r);
}
inline Vec6 times(const Mat6& matrix, const BodyForce& f) {
  return times(matrix, f.x, f.y, f.z, f.k, f.m, f.n);
}

}  // namespace halocline::vehicle_sim
