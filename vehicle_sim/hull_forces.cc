#include "vehicle_sim/hull_forces.h"

#include <cmath>
#include <numbers>

namespace halocline::vehicle_sim {

Vec6 coriolis_force(const Mat6& mass, const Vec6& nu) {
  const Vec6 momentum = mass * nu;
  const Vec3 v = nu.head<3>(), w = nu.tail<3>();
  const Vec3 p = momentum.head<3>(), h = momentum.tail<3>();
  Vec6 force;
  force << p.cross(w), h.cross(w) + p.cross(v);
  return force;
}

Vec6 roll_only_coriolis_force(const Mat6& mass, const Vec6& nu) {
  const Vec6 momentum = mass * nu;
  const Vec3 w = nu.tail<3>(), h = momentum.tail<3>();
  const double a2 = momentum[1], a3 = momentum[2], roll_rate = nu[3];
  // Rows of C: 2: -a3 p, 3: +a2 p, 4: a3 v - a2 w, and w x H in rotation.
  Vec6 force;
  force << 0, a3 * roll_rate, -a2 * roll_rate, h.cross(w);
  force[3] += a2 * nu[2] - a3 * nu[1];
  return force;
}

Vec6 body_lift_force(const BodyLift& b, double density, const Vec6& nu_r) {
  const double u = nu_r[0], v = nu_r[1], w = nu_r[2], q = nu_r[4], r = nu_r[5], x = b.center_aft_m;
  const double scale = -0.5 * density * b.reference_area_m2, lift = scale * b.lift_slope_per_rad;
  // |u| (v + x_l r) and, times x_l, its moment; x_l |u| = -x u, x_l^2 = x^2.
  const double speed = std::abs(u);
  Vec6 force;
  force << scale * b.axial_drag * speed * u, lift * (speed * v - x * u * r), lift * (speed * w + x * u * q),
      0, -lift * (-x * u * w - x * x * speed * q), lift * (-x * u * v + x * x * speed * r);
  return force;
}

Vec6 damping_force(const Damping& damping, const Vec6& nu_r, double relative_speed_mps) {
  Vec6 force = -damping.linear.cwiseProduct(nu_r);
  double last_decay = 0, attenuation = 1;
  for (int k = 0; k < 6; ++k) {
    const double decay = damping.decay_s_per_m[k];
    if (decay == 0) continue;
    if (decay != last_decay)
      attenuation = std::exp(-decay * relative_speed_mps);  // degrees of freedom share it
    last_decay = decay;
    force[k] *= attenuation;
  }
  return force;
}

Vec6 lift_drag_force(const LiftDrag& l, double density, const Vec6& nu_r, double relative_speed_mps) {
  const double u = nu_r[0], w = nu_r[2] + 0.0;  // -0 + 0 = +0: one branch of atan2 for both zeros
  const double alpha = std::atan2(w, u);
  const double in_plane = std::sqrt(u * u + w * w);
  const double cos_alpha = in_plane > 0 ? u / in_plane : 1, sin_alpha = in_plane > 0 ? w / in_plane : 0;
  const double cl = l.lift_slope_per_rad * alpha;
  const double cd = l.zero_lift_drag + cl * cl / (std::numbers::pi * l.oswald_efficiency * l.aspect_ratio);
  const double dynamic_force = 0.5 * density * relative_speed_mps * relative_speed_mps * l.reference_area_m2;
  const double lift = dynamic_force * cl, drag = dynamic_force * cd;
  Vec6 force = Vec6::Zero();
  force[0] = -cos_alpha * drag + sin_alpha * lift;
  force[2] = -sin_alpha * drag - cos_alpha * lift;
  return force;
}

namespace {

Vec6 cross_flow_in_sway(const CrossFlow& c, double v, double r) {
  const bool odd = c.strips % 2 == 1;
  double sway = odd ? std::abs(v) * v : 0, yaw = 0;  // sums of |v + x r| (v + x r) and of x times it
  const double innermost = odd ? c.strip_length_m : c.strip_length_m / 2;
  for (int i = 0; i < c.strips / 2; ++i) {  // the strips at x and -x
    const double x = innermost + i * c.strip_length_m;
    const double fore = v + x * r, aft = v - x * r;
    const double fore_square = std::abs(fore) * fore, aft_square = std::abs(aft) * aft;
    sway += fore_square + aft_square;
    yaw += x * (fore_square - aft_square);
  }
  Vec6 sums = Vec6::Zero();
  sums[1] = sway;
  sums[5] = yaw;
  return sums;
}

Vec6 cross_flow_in_both(const CrossFlow& c, const Vec6& nu_r) {
  const double v = nu_r[1], w = nu_r[2], q = nu_r[4], r = nu_r[5];
  double sway = 0, heave = 0, pitch = 0, yaw = 0;
  for (int i = 0; i < c.strips; ++i) {
    const double x = (i - 0.5 * (c.strips - 1)) * c.strip_length_m;
    const double y_speed = v + x * r, z_speed = w - x * q;
    const double speed = std::sqrt(y_speed * y_speed + z_speed * z_speed);
    sway += speed * y_speed;
    heave += speed * z_speed;
    pitch -= x * speed * z_speed;
    yaw += x * speed * y_speed;
  }
  Vec6 sums;
  sums << 0, sway, heave, 0, pitch, yaw;
  return sums;
}

}  // namespace

Vec6 cross_flow_force(const CrossFlow& c, double density, double diameter_m, const Vec6& nu_r) {
  const double scale = -0.5 * density * diameter_m * c.drag_coefficient * c.strip_length_m;
  return scale * (c.planes == CrossFlowPlanes::kSway ? cross_flow_in_sway(c, nu_r[1], nu_r[5])
                                                     : cross_flow_in_both(c, nu_r));
}

}  // namespace halocline::vehicle_sim
