-- SPDX-License-Identifier: BSD-3-Clause
-- A vehicle with a modem in Lua 5.2, of LCM and the message types alone. It circles, announces its modem, sends packets, and
-- prints what becomes of them and what it receives. By hand, from the root of the tree (clients/examples/README.md has other languages),
-- with Debian's packages lua5.2 and liblcm-lua:
--
--   $ mkdir -p build/mine && lcm-gen --lua --lpath build/mine lcmtypes/*.lcm
--   $ LUA_PATH='build/mine/?.lua;build/mine/?/init.lua' ./scripts/join lua5.2 clients/examples/lua/foreign_vehicle.lua --name visitor --id 77 --to 1

unpack = table.unpack  -- the types were made for Lua 5.1
local lcm = require("lcm")
local types = require("halocline")

-- LCM 1.3.1 unpacks up to 32 fields of a message, and warns of each integer beyond 2^53 (sessions of others, which lose their
-- lowest bits in Lua's numbers): fields one by one here, integers of 64 bits as two halves.
local SIZES = {q = 8, d = 8, f = 4, i = 4, h = 2, b = 1, B = 1, ["?"] = 1}
local unpack_fields = lcm._pack.unpack
function lcm._pack.unpack(format, data)
  if format:find("%d") then return unpack_fields(format, data) end  -- an array
  local values, at = {}, 1
  for kind in format:sub(2):gmatch(".") do
    local field = data:sub(at, at + SIZES[kind] - 1)
    if kind == "q" then
      values[#values + 1] = unpack_fields(">i", field:sub(1, 4)) * 2^32 + unpack_fields(">I", field:sub(5, 8))
    else
      values[#values + 1] = unpack_fields(">" .. kind, field)
    end
    at = at + SIZES[kind]
  end
  return unpack(values)
end

local RADIUS_M, SPEED_MPS, REPEAT_S = 100, 1.5, 0.5
local STATE_PERIOD_US, MODEM_PERIOD_US = 100000, 10000000

local OUTCOMES = { -- by the number in packet_outcome_t, from 0
  "received", "below cutoff", "receiver gone", "shadow", "blocked", "out of band", "collided", "half duplex", "doppler",
  "bit errors", "not acquired", "foreign", "too weak", "too steep", "out of reach", "asleep", "extra loss", "no power",
  "out of water", "no terrain"}

local function read(path)
  local file = assert(io.open(path))
  local text = file:read("*l")
  file:close()
  return text
end

-- Lua's own clocks count seconds, or time of the processor; this counts hundredths.
local function wall_s() return tonumber(read("/proc/uptime"):match("^[%d.]+")) end

local options = {name = "visitor", id = 77, to = 0, north = 0, depth = 50, every = 10, family = "generic", ["center-hz"] = 25000}
for i = 1, #arg, 2 do
  local option = arg[i]:match("^%-%-(.*)")
  local value = type(options[option]) == "number" and tonumber(arg[i + 1]) or options[option] and arg[i + 1]
  if type(value) ~= type(options[option]) or value == nil then
    io.stderr:write("usage: [--name N] [--id N] [--to ID] [--north M] [--depth M] [--every S] [--family F] [--center-hz F]\n")
    os.exit(2)
  end
  options[option] = value
end

local opened, bus = pcall(lcm.lcm.new)
if not opened then
  io.stderr:write("LCM cannot be opened: see LCM_DEFAULT_URL\n")
  os.exit(69)
end
local session = 1 + tonumber(read("/proc/sys/kernel/random/uuid"):sub(1, 8), 16)  -- another one at each start
local clock, clock_s  -- the last, and the wall clock then
local pending, sent_s  -- the packet that waits for its RECEIPT
local states, packets = 0, 0

-- due(now) is true once in the period, and after time has jumped.
local function timer(period_us)
  local next_us = 0
  return function(now)
    if period_us == 0 or (now < next_us and next_us - now <= period_us) then return false end
    local in_phase = next_us > 0 and math.abs(now - next_us) < period_us
    next_us = (in_phase and next_us or now) + period_us
    return true
  end
end

local function publish_state(now)
  local turn = SPEED_MPS / RADIUS_M  -- rad/s, clockwise
  local angle = now * 1e-6 * turn
  local heading = angle + math.pi / 2
  local state = types.vehicle_state_t:new()
  state.utime, state.session, state.sequence, state.vehicle_id = now, session, states, options.id
  state.position_ned_m = {options.north + RADIUS_M * math.cos(angle), RADIUS_M * math.sin(angle), options.depth}
  state.orientation_wxyz = {math.cos(heading / 2), 0, 0, math.sin(heading / 2)}
  state.velocity_ned_mps = {SPEED_MPS * math.cos(heading), SPEED_MPS * math.sin(heading), 0}
  state.angular_velocity_body_radps = {0, 0, turn}
  bus:publish("STATE." .. options.name, state:encode())
  states = states + 1
end

local function publish_modem(now)
  local modem = types.modem_config_t:new()
  modem.utime, modem.family, modem.modem_profile = now, options.family, "generic"
  modem.source_level_db, modem.center_frequency_hz, modem.bandwidth_hz = 185, options["center-hz"], 5000
  modem.bit_rate_bps, modem.packet_overhead_s, modem.max_payload_bytes = 640, 0.1, 256
  modem.guard_time_s = 0.02
  modem.doppler_tolerance, modem.doppler_correction = 0.1, 0.1
  modem.error_model = types.modem_config_t.ERRORS_JANUS
  bus:publish("MODEM." .. options.name, modem:encode())
end

local function prepare_packet(now)
  local text = string.format("hello %d from %s", packets, options.name)
  pending, sent_s = types.modem_send_t:new(), -math.huge
  pending.utime, pending.session, pending.packet_sequence = now, session, packets
  pending.source_id, pending.destination_id = options.id, options.to
  pending.packet_kind, pending.stamped = types.modem_send_t.DATA, true
  pending.payload, pending.payload_size = {text:byte(1, -1)}, #text
  packets = packets + 1
end

local handlers = {}

function handlers.CLOCK(data) clock, clock_s = types.sim_clock_t.decode(data), wall_s() end

function handlers.RECEIPT(data)
  local receipt = types.modem_receipt_t.decode(data)
  if receipt.send_session ~= session then return end
  if pending and receipt.packet_sequence == pending.packet_sequence then pending = nil end
  print(string.format("%.3f s: packet %d %s, receipt %d, %.3f s long", receipt.utime * 1e-6, receipt.packet_sequence,
    receipt.start_utime ~= 0 and "accepted" or "refused", receipt.receipt_result, receipt.duration_s))
end

function handlers.OUTCOME(data)
  local outcome = types.packet_outcome_t.decode(data)
  if outcome.send_session ~= session or outcome.source_id ~= options.id then return end
  print(string.format("%.3f s: packet %d at vehicle %d: %s", outcome.utime * 1e-6, outcome.packet_sequence,
    outcome.receiver_id, OUTCOMES[outcome.outcome + 1] or "?"))
end

function handlers.RECEIVE(data)
  local packet = types.modem_receive_t.decode(data)
  local text = string.char(unpack(packet.payload)):gsub("[^\32-\126]", ".")
  print(string.format("%.3f s: from vehicle %d, %.3f dB SNR: %s", packet.utime * 1e-6, packet.source_id, packet.snr_db, text))
end

local function on_message(channel, data)
  local well, problem = pcall(handlers[channel:match("^%u+")], data)
  if not well then io.stderr:write(channel, ": ", tostring(problem), "\n") end  -- what does not decode
end

io.stdout:setvbuf("line")
for _, channel in ipairs({"CLOCK", "OUTCOME", "RECEIPT\\." .. options.name, "RECEIVE\\." .. options.name}) do
  bus:subscribe(channel, on_message)
end
local state_due, modem_due, packet_due = timer(STATE_PERIOD_US), timer(MODEM_PERIOD_US), timer(options.every * 1e6)
local idle_steps = 0
while true do
  bus:timedhandle(0.01)
  if clock then
    -- Simulation time: the last CLOCK, extrapolated by the wall clock at its rate.
    local now = math.floor(clock.utime + (wall_s() - clock_s) * clock.clock_rate * 1e6)
    if state_due(now) then publish_state(now) end
    if modem_due(now) then publish_modem(now) end
    if not pending and states > 10 and packet_due(now) then prepare_packet(now) end
    if pending and wall_s() - sent_s > REPEAT_S then  -- unchanged until its RECEIPT: transmitted once
      bus:publish("SEND." .. options.name, pending:encode())
      sent_s = wall_s()
    end
  else
    idle_steps = idle_steps + 1
    if idle_steps == 300 then io.stderr:write("no CLOCK for 3 s: start this by ./scripts/join\n") end
  end
end
