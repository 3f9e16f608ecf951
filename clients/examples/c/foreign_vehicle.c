// SPDX-License-Identifier: BSD-3-Clause
// A vehicle with a modem in C, which needs LCM and the message types alone. It circles, announces its modem,
// sends packets, and prints what becomes of them and what it receives. To build it by hand, from the root of
// the tree (clients/examples/README.md has other languages):
//
//   $ mkdir -p build/mine/c && lcm-gen --c --c-cpath build/mine/c --c-hpath build/mine/c lcmtypes/*.lcm
//   $ cc -std=gnu11 -I build/mine/c clients/examples/c/*.c build/mine/c/*.c -llcm -lm -o build/mine/vehicle_c
//   $ ./scripts/join build/mine/vehicle_c --name visitor --id 77 --to 1
#include "halocline_modem_config_t.h"
#include "halocline_modem_receipt_t.h"
#include "halocline_modem_receive_t.h"
#include "halocline_modem_send_t.h"
#include "halocline_packet_outcome_t.h"
#include "halocline_sim_clock_t.h"
#include "halocline_vehicle_state_t.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char* const kUsage =
    "usage: [--name N] [--id N] [--to ID] [--north M] [--depth M] [--every S] [--family F] [--center-hz F]\n";
static const double kRadiusM = 100, kSpeedMps = 1.5, kRepeatS = 0.5;
static const char* const kOutcomes[] = {  // by the number in packet_outcome_t
    "received", "below cutoff", "receiver gone", "shadow",     "blocked",      "out of band",
    "collided", "half duplex",  "doppler",       "bit errors", "not acquired", "foreign",
    "too weak", "too steep",    "out of reach",  "asleep",     "extra loss",   "no power",
    "out of water", "no terrain"};
static const int64_t kStatePeriodUs = 100000, kModemPeriodUs = 10000000;

typedef struct {
  const char *name, *family;
  double id, to, north_m, depth_m, every_s, center_hz;
  lcm_t* lcm;
  int64_t session, states, packets, next_state, next_modem, next_packet;
  halocline_sim_clock_t clock;
  halocline_modem_send_t pending;  // waits for its RECEIPT
  int is_pending, idle_steps;
  char text[128];                    // payload of `pending`
  double clock_wall_s, sent_wall_s;  // of the wall clock
} vehicle_t;

static double wall_s(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// True once in `period`, and after time has jumped.
static int due(int64_t now, int64_t period, int64_t* next) {
  if (period == 0 || (now < *next && *next - now <= period)) return 0;
  *next = (*next > 0 && llabs(now - *next) < period ? *next : now) + period;
  return 1;
}

static const char* channel_of(const vehicle_t* v, const char* family) {
  static char channel[64];
  snprintf(channel, sizeof channel, "%s.%s", family, v->name);
  return channel;
}

static void publish_state(vehicle_t* v, int64_t now) {
  const double rate = kSpeedMps / kRadiusM, angle = fmod((double)now * 1e-6 * rate, 2 * M_PI);  // clockwise
  const double heading = angle + M_PI / 2;
  const halocline_vehicle_state_t state = {
      .utime = now,
      .session = v->session,
      .sequence = v->states++,
      .vehicle_id = (int32_t)v->id,
      .position_ned_m = {v->north_m + kRadiusM * cos(angle), kRadiusM * sin(angle), v->depth_m},
      .orientation_wxyz = {cos(heading / 2), 0, 0, sin(heading / 2)},
      .velocity_ned_mps = {kSpeedMps * cos(heading), kSpeedMps * sin(heading), 0},
      .angular_velocity_body_radps = {0, 0, rate}};
  halocline_vehicle_state_t_publish(v->lcm, channel_of(v, "STATE"), &state);
}

static void publish_modem(vehicle_t* v, int64_t now) {
  const halocline_modem_config_t modem = {.utime = now,
                                          .family = (char*)v->family,
                                          .modem_profile = (char*)"generic",
                                          .source_level_db = 185,
                                          .center_frequency_hz = v->center_hz,
                                          .bandwidth_hz = 5000,
                                          .bit_rate_bps = 640,
                                          .packet_overhead_s = 0.1,
                                          .max_payload_bytes = 256,
                                          .guard_time_s = 0.02,
                                          .doppler_tolerance = 0.1,
                                          .doppler_correction = 0.1,
                                          .error_model = HALOCLINE_MODEM_CONFIG_T_ERRORS_JANUS};
  halocline_modem_config_t_publish(v->lcm, channel_of(v, "MODEM"), &modem);
}

static void prepare_packet(vehicle_t* v, int64_t now) {
  snprintf(v->text, sizeof v->text, "hello %lld from %s", (long long)v->packets, v->name);
  v->pending = (halocline_modem_send_t){.utime = now,
                                        .session = v->session,
                                        .packet_sequence = v->packets++,
                                        .source_id = (int32_t)v->id,
                                        .destination_id = (int32_t)v->to,
                                        .packet_kind = HALOCLINE_MODEM_SEND_T_DATA,
                                        .stamped = 1,
                                        .payload_size = (int32_t)strlen(v->text),
                                        .payload = (uint8_t*)v->text};
  v->is_pending = 1;
  v->sent_wall_s = 0;
}

// Does what is due. Simulation time is the last CLOCK, extrapolated by the wall clock at its rate.
static void step(vehicle_t* v) {
  if (v->clock_wall_s == 0 && ++v->idle_steps == 300)  // of 10 ms
    fputs("no CLOCK for 3 s: start this by ./scripts/join\n", stderr);
  if (v->clock_wall_s == 0) return;
  const int64_t now = v->clock.utime + (int64_t)((wall_s() - v->clock_wall_s) * v->clock.clock_rate * 1e6);
  if (due(now, kStatePeriodUs, &v->next_state)) publish_state(v, now);
  if (due(now, kModemPeriodUs, &v->next_modem)) publish_modem(v, now);
  if (!v->is_pending && v->states > 10 && due(now, (int64_t)(v->every_s * 1e6), &v->next_packet))
    prepare_packet(v, now);
  if (v->is_pending && wall_s() - v->sent_wall_s > kRepeatS) {
    halocline_modem_send_t_publish(v->lcm, channel_of(v, "SEND"), &v->pending);
    v->sent_wall_s = wall_s();  // repeated unchanged until its RECEIPT: transmitted once
  }
}

static void on_clock(const lcm_recv_buf_t* buffer, const char* channel, const halocline_sim_clock_t* clock,
                     void* user) {
  vehicle_t* v = user;
  v->clock = *clock;
  v->clock_wall_s = wall_s();
}

static void on_receipt(const lcm_recv_buf_t* buffer, const char* channel,
                       const halocline_modem_receipt_t* receipt, void* user) {
  vehicle_t* v = user;
  if (receipt->send_session != v->session) return;
  if (receipt->packet_sequence == v->pending.packet_sequence) v->is_pending = 0;
  printf("%.3f s: packet %lld %s, receipt %d, %.3f s long\n", (double)receipt->utime * 1e-6,
         (long long)receipt->packet_sequence, receipt->start_utime != 0 ? "accepted" : "refused",
         receipt->receipt_result, receipt->duration_s);
}

static void on_outcome(const lcm_recv_buf_t* buffer, const char* channel,
                       const halocline_packet_outcome_t* outcome, void* user) {
  const vehicle_t* v = user;
  if (outcome->send_session != v->session || outcome->source_id != (int32_t)v->id) return;
  const size_t number = (size_t)outcome->outcome, known = sizeof kOutcomes / sizeof *kOutcomes;
  printf("%.3f s: packet %lld at vehicle %d: %s\n", (double)outcome->utime * 1e-6,
         (long long)outcome->packet_sequence, outcome->receiver_id, number < known ? kOutcomes[number] : "?");
}

static void on_packet(const lcm_recv_buf_t* buffer, const char* channel,
                      const halocline_modem_receive_t* packet, void* user) {
  printf("%.3f s: from vehicle %d, %.3f dB SNR: ", (double)packet->utime * 1e-6, packet->source_id,
         packet->snr_db);
  for (int i = 0; i < packet->payload_size; ++i)
    putchar(packet->payload[i] >= 32 && packet->payload[i] < 127 ? packet->payload[i] : '.');
  putchar('\n');
}

static int is_set(vehicle_t* v, const char* option, const char* value) {
  const char* const options[] = {"--id", "--to", "--north", "--depth", "--every", "--center-hz"};
  double* const numbers[] = {&v->id, &v->to, &v->north_m, &v->depth_m, &v->every_s, &v->center_hz};
  if (strcmp(option, "--name") == 0) return (v->name = value) != NULL;
  if (strcmp(option, "--family") == 0) return (v->family = value) != NULL;
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
    char* end = NULL;
    if (strcmp(option, options[i]) != 0) continue;
    *numbers[i] = strtod(value, &end);
    return end != value && *end == '\0';
  }
  return 0;
}

int main(int argc, char** argv) {
  vehicle_t v = {
      .name = "visitor", .family = "generic", .id = 77, .depth_m = 50, .every_s = 10, .center_hz = 25000};
  for (int i = 1; i < argc; i += 2) {
    if (i + 1 < argc && is_set(&v, argv[i], argv[i + 1])) continue;
    fputs(kUsage, stderr);
    return 2;
  }
  setvbuf(stdout, NULL, _IOLBF, 0);
  v.session = (int64_t)(wall_s() * 1e6);  // another one at each start
  v.lcm = lcm_create(NULL);
  if (v.lcm != NULL) {
    char receipts[80], packets[80];  // regular expressions
    snprintf(receipts, sizeof receipts, "RECEIPT\\.%s", v.name);
    snprintf(packets, sizeof packets, "RECEIVE\\.%s", v.name);
    halocline_sim_clock_t_subscribe(v.lcm, "CLOCK", on_clock, &v);
    halocline_modem_receipt_t_subscribe(v.lcm, receipts, on_receipt, &v);
    halocline_modem_receive_t_subscribe(v.lcm, packets, on_packet, &v);
    halocline_packet_outcome_t_subscription_set_queue_capacity(
        halocline_packet_outcome_t_subscribe(v.lcm, "OUTCOME", on_outcome, &v), 0);
  }
  while (v.lcm != NULL && lcm_handle_timeout(v.lcm, 10) >= 0) step(&v);
  fputs("LCM cannot be opened, or cannot receive: see LCM_DEFAULT_URL\n", stderr);
  return 69;
}
