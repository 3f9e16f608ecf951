// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/send_register.h"

#include <algorithm>

namespace halocline::channel_server {

RequestName name_of(const SendRequest& request) {
  return {request.vehicle, request.session, request.packet_sequence,
          request.session == 0 ? request.start : SimTime()};
}

bool SendRegister::enter(const SendRequest& request) {
  const RequestName name = name_of(request);
  if (!entries_.emplace(name, Entry{request.start, false, {}}).second) return false;
  by_start_.emplace(request.start, name);
  if (entries_.size() > kMaxPackets) forget_earliest();
  return true;
}

void SendRegister::decide(const SendRequest& request, const Receipt& receipt) {
  const auto entry = entries_.find(name_of(request));
  if (entry == entries_.end()) return;
  entry->second.decided = true;
  entry->second.receipt = receipt;
}

const Receipt* SendRegister::receipt_of(const SendRequest& request) const {
  const auto entry = entries_.find(name_of(request));
  return entry == entries_.end() || !entry->second.decided ? nullptr : &entry->second.receipt;
}

bool SendRegister::is_busy(const std::string& vehicle, SimTime start, SimDuration duration) const {
  const auto known = occupations_.find(vehicle);
  if (known == occupations_.end()) return false;
  return std::any_of(known->second.begin(), known->second.end(), [&](const Occupation& o) {
    return start == o.start || (start < o.end && o.start < start + duration);
  });
}

SimTime SendRegister::free_from(const std::string& vehicle, SimTime start) const {
  const auto known = occupations_.find(vehicle);
  if (known == occupations_.end()) return start;
  SimTime free = start;
  for (const Occupation& o : known->second) free = std::max(free, o.end);
  return free;
}

std::size_t SendRegister::waiting_at(const std::string& vehicle, SimTime instant) const {
  const auto known = occupations_.find(vehicle);
  if (known == occupations_.end()) return 0;
  return static_cast<std::size_t>(std::count_if(known->second.begin(), known->second.end(),
                                                [&](const Occupation& o) { return o.start > instant; }));
}

void SendRegister::occupy(const std::string& vehicle, SimTime start, SimDuration duration) {
  occupations_[vehicle].push_back({start, start + duration});
}

void SendRegister::forget_before(SimTime time) {
  while (!by_start_.empty() && by_start_.begin()->first < time &&
         (entries_.size() > kMaxOld || time - by_start_.begin()->first > kOldAge))
    forget_earliest();
  for (auto vehicle = occupations_.begin(); vehicle != occupations_.end();) {
    std::erase_if(vehicle->second, [&](const Occupation& o) { return o.end < time; });
    vehicle = vehicle->second.empty() ? occupations_.erase(vehicle) : std::next(vehicle);
  }
}

void SendRegister::forget_earliest() {
  entries_.erase(by_start_.begin()->second);
  by_start_.erase(by_start_.begin());
}

}  // namespace halocline::channel_server
