// How sound gets from one point to another, behind one interface: what the packet medium and the link tables
// ask of the water, whichever model answers.
//
// An implementation may keep what it has computed; its answers depend on the arguments alone. Positions are
// world NED, m.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "acoustics/link_budget.h"
#include "acoustics/multipath.h"

namespace halocline::channel_server {

class Propagation {
 public:
  virtual ~Propagation() = default;

  // Travel time of the first arrival, s.
  virtual double delay_s(const Vec3& from_ned_m, const Vec3& to_ned_m) = 0;
  virtual acoustics::LinkBudget budget(const acoustics::Modem& transmitter, const acoustics::Modem& receiver,
                                       const Vec3& from_ned_m, const Vec3& to_ned_m) = 0;
  // Whether an echo off one of these points of the bottom reaches the receiver above its cut-off.
  virtual bool echo_is_receivable(const acoustics::Modem& transmitter, const acoustics::Modem& receiver,
                                  const Vec3& from_ned_m, const Vec3& to_ned_m,
                                  const std::vector<acoustics::BottomPoint>& points) = 0;
  virtual const acoustics::Environment& environment() const = 0;
};

// The straight path of acoustics/link_budget.h.
//
// A LinkModel takes a millisecond to make and microseconds to ask, so one is kept for each pair of different
// modems asked about; of more than `most_models`, the one that was asked longest ago makes room.
class StraightPropagation : public Propagation {
 public:
  static constexpr std::size_t kMostModels = 1024;
  // Throws InvalidArgument when the environment is out of range.
  explicit StraightPropagation(acoustics::Environment environment, std::size_t most_models = kMostModels);

  double delay_s(const Vec3& from_ned_m, const Vec3& to_ned_m) override;
  // Throws InvalidArgument when a modem is out of range.
  acoustics::LinkBudget budget(const acoustics::Modem& transmitter, const acoustics::Modem& receiver,
                               const Vec3& from_ned_m, const Vec3& to_ned_m) override;
  bool echo_is_receivable(const acoustics::Modem& transmitter, const acoustics::Modem& receiver,
                          const Vec3& from_ned_m, const Vec3& to_ned_m,
                          const std::vector<acoustics::BottomPoint>& points) override;
  const acoustics::Environment& environment() const override { return environment_; }

  std::size_t models_kept() const { return models_.size(); }

 private:
  using ModemKey = std::array<double, 7>;
  using PairKey = std::array<ModemKey, 2>;
  struct KeptModel {
    std::unique_ptr<acoustics::LinkModel> model;
    std::int64_t asked_last = 0;
  };
  static ModemKey key_of(const acoustics::Modem& modem);
  const acoustics::LinkModel& model_of(const acoustics::Modem& transmitter, const acoustics::Modem& receiver);
  void make_room();

  acoustics::Environment environment_;
  std::size_t most_models_;
  std::map<PairKey, KeptModel> models_;
  std::int64_t questions_ = 0;
};

}  // namespace halocline::channel_server
