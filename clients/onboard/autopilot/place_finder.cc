// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/place_finder.h"

#include <utility>

#include "bus/messages/channels.h"
#include "bus/transport/subscription.h"
#include "core/frames.h"

namespace halocline::clients {

namespace channels = bus::channels;

PlaceFinder::PlaceFinder(bus::Bus& bus, std::string vehicle)
    : bus_(bus), vehicle_(std::move(vehicle)), request_id_(bus.identity().session & 0x7FFF'FFFF'0000'0000) {
  bus_.subscribe<best_place_reply_t>(
      channels::kBestPlaceReply.of(vehicle_),
      [this](const best_place_reply_t& reply) {
        if (asked_at_ && reply.request_id == request_id_) answer_ = reply;
      },
      bus::Wakeup::kStoreOnly);
}

void PlaceFinder::ask(SimTime instant, const LinkSeeker& seeker) {
  best_place_query_t query{};
  query.utime = instant.to_utime();
  query.client_name = vehicle_;
  query.request_id = ++request_id_;
  query.talker_name = vehicle_;
  query.num_places = static_cast<std::int32_t>(seeker.places().size());
  for (const Vec3& place : seeker.places()) query.place_ned_m.push_back({place.x(), place.y(), place.z()});
  query.listener_name = listeners_of(seeker.search());
  query.num_listeners = static_cast<std::int32_t>(query.listener_name.size());
  bus_.publish(channels::kBestPlaceQuery, query);
  asked_at_ = instant;
  answer_.reset();
}

bool PlaceFinder::step(SimTime instant, LinkSeeker* seeker) {
  if (seeker == nullptr) {
    asked_at_.reset();
    return false;
  }
  bool is_other_place = false;
  if (asked_at_ && instant >= *asked_at_ + kAnswerAfter) {
    const SimDuration period = SimDuration::from_seconds(seeker->search().period_s);
    next_ = *asked_at_ + period;
    if (answer_ && answer_->reply_status == best_place_reply_t::OK) {
      const Vec3 before = seeker->chosen();
      seeker->take(answer_->mean_delivery, answer_->best_place);
      is_other_place = seeker->chosen() != before;
    } else {
      next_ = instant;
    }
    asked_at_.reset();
  }
  if (!asked_at_ && instant >= next_) ask(instant, *seeker);
  return is_other_place;
}

void PlaceFinder::restart() {
  asked_at_.reset();
  answer_.reset();
  next_ = SimTime();
}

}  // namespace halocline::clients
