// SPDX-License-Identifier: BSD-3-Clause
import halocline.modem_config_t;
import halocline.modem_receipt_t;
import halocline.modem_receive_t;
import halocline.modem_send_t;
import halocline.packet_outcome_t;
import halocline.sim_clock_t;
import halocline.vehicle_state_t;
import java.io.IOException;
import java.nio.charset.StandardCharsets;
import java.security.SecureRandom;
import java.util.Locale;
import java.util.Map;
import java.util.TreeMap;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;

/**
 * A vehicle with a modem in Java, of LCM and the message types alone. It circles, announces its modem, sends packets, and prints
 * what becomes of them and what it receives. By hand, from the root of the tree (clients/examples/README.md has other languages), with
 * Debian's liblcm-java:
 *
 *   $ mkdir -p build/mine && lcm-gen --java --jpath build/mine/java lcmtypes/*.lcm
 *   $ javac -nowarn -cp /usr/share/java/lcm.jar:build/mine/java -d build/mine/classes clients/examples/java/ForeignVehicle.java
 *   $ ./scripts/join java -cp /usr/share/java/lcm.jar:build/mine/classes ForeignVehicle --name visitor --id 77 --to 1
 */
public final class ForeignVehicle implements LCMSubscriber {
    private static final double RADIUS_M = 100, SPEED_MPS = 1.5, REPEAT_S = 0.5;
    private static final String[] OUTCOMES = { // by the number in packet_outcome_t
        "received", "below cutoff", "receiver gone", "shadow", "blocked", "out of band", "collided", "half duplex",
        "doppler", "bit errors", "not acquired", "foreign", "too weak", "too steep", "out of reach", "asleep", "extra loss",
        "no power", "out of water", "no terrain"};
    private static final long STATE_PERIOD_US = 100_000, MODEM_PERIOD_US = 10_000_000;

    private final LCM bus;
    private final Map<String, String> options;
    private final String name;
    private final int id;
    private final long session = 1 + (new SecureRandom().nextLong() >>> 32); // another one at each start
    private final Timer stateTimer = new Timer(STATE_PERIOD_US), modemTimer = new Timer(MODEM_PERIOD_US), packetTimer;
    private long states, packets;
    private sim_clock_t clock;
    private modem_send_t pending; // waits for its RECEIPT
    private double clockS, sentS; // of the wall clock

    /** Due once in a period, and after time has jumped. */
    private static final class Timer {
        private final long periodUs;
        private long nextUs;

        Timer(long periodUs) { this.periodUs = periodUs; }

        boolean due(long now) {
            if (periodUs == 0 || now < nextUs && nextUs - now <= periodUs) return false;
            nextUs = (nextUs > 0 && Math.abs(now - nextUs) < periodUs ? nextUs : now) + periodUs;
            return true;
        }
    }

    private ForeignVehicle(LCM bus, Map<String, String> options) {
        this.bus = bus;
        this.options = options;
        name = options.get("--name");
        id = (int) number("--id");
        packetTimer = new Timer((long) (number("--every") * 1e6));
        bus.subscribe("CLOCK|OUTCOME|(RECEIPT|RECEIVE)\\." + name, this);
    }

    private double number(String option) {
        return Double.parseDouble(options.get(option));
    }

    private static double wallS() {
        return System.nanoTime() * 1e-9;
    }

    private static void print(long utime, String format, Object... values) {
        System.out.println(String.format(Locale.ROOT, "%.3f s: ", utime * 1e-6) + String.format(Locale.ROOT, format, values));
    }

    /** Does what is due. Simulation time is the last CLOCK, extrapolated by the wall clock at its rate. */
    private synchronized void step() throws IOException {
        if (clock == null) return;
        final long now = clock.utime + (long) ((wallS() - clockS) * clock.clock_rate * 1e6);
        if (stateTimer.due(now)) publishState(now);
        if (modemTimer.due(now)) publishModem(now);
        if (pending == null && states > 10 && packetTimer.due(now)) preparePacket(now);
        if (pending != null && wallS() - sentS > REPEAT_S) {
            bus.publish("SEND." + name, pending); // unchanged until its RECEIPT: transmitted once
            sentS = wallS();
        }
    }

    private synchronized boolean knowsTime() { return clock != null; }

    private void publishState(long now) throws IOException {
        final double turn = SPEED_MPS / RADIUS_M; // rad/s, clockwise
        final double angle = now * 1e-6 * turn, heading = angle + Math.PI / 2;
        final vehicle_state_t state = new vehicle_state_t();
        state.utime = now;
        state.session = session;
        state.sequence = states++;
        state.vehicle_id = id;
        state.position_ned_m =
            new double[] {number("--north") + RADIUS_M * Math.cos(angle), RADIUS_M * Math.sin(angle), number("--depth")};
        state.orientation_wxyz = new double[] {Math.cos(heading / 2), 0, 0, Math.sin(heading / 2)};
        state.velocity_ned_mps = new double[] {SPEED_MPS * Math.cos(heading), SPEED_MPS * Math.sin(heading), 0};
        state.angular_velocity_body_radps = new double[] {0, 0, turn};
        bus.publish("STATE." + name, state);
    }

    private void publishModem(long now) throws IOException {
        final modem_config_t modem = new modem_config_t();
        modem.utime = now;
        modem.family = options.get("--family");
        modem.modem_profile = "generic";
        modem.source_level_db = 185;
        modem.center_frequency_hz = number("--center-hz");
        modem.bandwidth_hz = 5000;
        modem.bit_rate_bps = 640;
        modem.packet_overhead_s = 0.1;
        modem.max_payload_bytes = 256;
        modem.guard_time_s = 0.02;
        modem.doppler_tolerance = modem.doppler_correction = 0.1;
        modem.error_model = modem_config_t.ERRORS_JANUS;
        modem.beam_elevation_rad = modem.beam_loss_db = new double[0];
        bus.publish("MODEM." + name, modem);
    }

    private void preparePacket(long now) {
        pending = new modem_send_t();
        pending.utime = now;
        pending.session = session;
        pending.packet_sequence = packets++;
        pending.source_id = id;
        pending.destination_id = (int) number("--to");
        pending.packet_kind = modem_send_t.DATA;
        pending.stamped = true;
        pending.frame_bytes = new int[0];
        pending.payload = ("hello " + pending.packet_sequence + " from " + name).getBytes(StandardCharsets.US_ASCII);
        pending.payload_size = pending.payload.length;
        sentS = wallS() - 2 * REPEAT_S;
    }

    @Override
    public synchronized void messageReceived(LCM lcm, String channel, LCMDataInputStream data) {
        try {
            if (channel.equals("CLOCK")) {
                clock = new sim_clock_t(data);
                clockS = wallS();
            } else if (channel.equals("OUTCOME")) {
                onOutcome(new packet_outcome_t(data));
            } else if (channel.startsWith("RECEIPT.")) {
                onReceipt(new modem_receipt_t(data));
            } else {
                final modem_receive_t packet = new modem_receive_t(data);
                final String text = new String(packet.payload, StandardCharsets.US_ASCII).replaceAll("[^ -~]", ".");
                print(packet.utime, "from vehicle %d, %.3f dB SNR: %s", packet.source_id, packet.snr_db, text);
            }
        } catch (IOException | RuntimeException error) { // what does not decode
            System.err.println(channel + ": " + error.getMessage());
        }
    }

    private void onReceipt(modem_receipt_t receipt) {
        if (receipt.send_session != session) return;
        if (pending != null && receipt.packet_sequence == pending.packet_sequence) pending = null;
        print(receipt.utime, "packet %d %s, receipt %d, %.3f s long", receipt.packet_sequence,
            receipt.start_utime != 0 ? "accepted" : "refused", receipt.receipt_result, receipt.duration_s);
    }

    private void onOutcome(packet_outcome_t outcome) {
        if (outcome.send_session != session || outcome.source_id != id) return;
        print(outcome.utime, "packet %d at vehicle %d: %s", outcome.packet_sequence, outcome.receiver_id,
            outcome.outcome < OUTCOMES.length ? OUTCOMES[outcome.outcome] : "?");
    }

    public static void main(String[] args) throws IOException, InterruptedException {
        final Map<String, String> options = new TreeMap<>(Map.of("--name", "visitor", "--id", "77", "--to", "0", "--north", "0",
            "--depth", "50", "--every", "10", "--family", "generic", "--center-hz", "25000"));
        for (int i = 0; i < args.length; i += 2) {
            if (i + 1 == args.length || options.replace(args[i], args[i + 1]) == null) {
                System.err.println("usage: [--name N] [--id N] [--to ID] [--north M] [--depth M] [--every S] [--family F] [--center-hz F]");
                System.exit(2);
            }
        }
        Thread.setDefaultUncaughtExceptionHandler((thread, error) -> {
            System.err.println(error); // a number that is none; LCM cannot be used
            System.exit(error instanceof IOException ? 69 : 2);
        });
        final ForeignVehicle vehicle = new ForeignVehicle(new LCM(), options);
        for (int steps = 1; true; ++steps) {
            Thread.sleep(10);
            vehicle.step();
            if (steps == 300 && !vehicle.knowsTime()) System.err.println("no CLOCK for 3 s: start this by ./scripts/join");
        }
    }
}
