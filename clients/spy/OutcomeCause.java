// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

import halocline.packet_name_t;
import halocline.packet_outcome_t;
import java.lang.reflect.Field;
import java.lang.reflect.Modifier;
import java.util.Locale;
import java.util.Set;
import java.util.function.IntFunction;

/** Outcome and cause of a packet in words; docs/packets.md has the rules. */
final class OutcomeCause {
  private static final Set<String> NO_OUTCOMES =  // of propagation_used
      Set.of("STRAIGHT", "RAYS", "STRAIGHT_WITHOUT_BOTTOM", "STRAIGHT_NOT_SEARCHED", "RAYS_BEYOND_TERRAIN");

  private OutcomeCause() {}

  /** As `halocline outcomes` names it: by the constant of packet_outcome_t. */
  static String name(packet_outcome_t outcome) {
    try {
      for (Field constant : packet_outcome_t.class.getFields()) {
        boolean isCode = Modifier.isStatic(constant.getModifiers()) && constant.getType() == byte.class;
        if (isCode && !NO_OUTCOMES.contains(constant.getName()) && constant.getByte(null) == outcome.outcome) {
          return Texts.words(constant.getName());
        }
      }
      return "outcome " + outcome.outcome;
    } catch (IllegalAccessException impossible) {
      throw new AssertionError(impossible);
    }
  }

  /** `names`: of vehicles by their ids. */
  static String cause(packet_outcome_t outcome, IntFunction<String> names) {
    switch (outcome.outcome) {
      case packet_outcome_t.RECEIVED:
        return "all bits right: " + drawn(outcome.success_draw, outcome.success_probability);
      case packet_outcome_t.BELOW_CUTOFF:
        return Texts.number(outcome.received_level_db) + " dB arrive, the receiver needs " + Texts.number(outcome.cutoff_level_db) + " dB";
      case packet_outcome_t.RECEIVER_GONE:
        return "no state of the receiver of late";
      case packet_outcome_t.SHADOW:
        return "the water bends every ray away";
      case packet_outcome_t.BLOCKED:
        return "the terrain stops every ray";
      case packet_outcome_t.OUT_OF_BAND:
        return "the bands of the two modems share nothing";
      case packet_outcome_t.COLLIDED:
        return (outcome.acquisition_probability == 0 ? "the receiver followed " : "with ") + colliders(outcome, names);
      case packet_outcome_t.HALF_DUPLEX:
        return "the receiver itself transmitted " + colliders(outcome, names);
      case packet_outcome_t.DOPPLER:
        return "received at " + Texts.number(outcome.strongest_path_doppler_factor) + " of the frequency sent";
      case packet_outcome_t.BIT_ERRORS:
        return "bits wrong: " + drawn(outcome.success_draw, outcome.success_probability);
      case packet_outcome_t.NOT_ACQUIRED:
        return "preamble missed: " + drawn(outcome.acquisition_draw, outcome.acquisition_probability);
      case packet_outcome_t.FOREIGN:
        return "its waveform is of another family";
      case packet_outcome_t.TOO_WEAK:
        return "the rays that arrive lost too much at their bounces";
      case packet_outcome_t.TOO_STEEP:
        return "rays arrive only more steeply than is searched";
      case packet_outcome_t.OUT_OF_REACH:
        return "so far away that its sound cannot matter";
      case packet_outcome_t.ASLEEP:
        return "the receiver's modem slept";
      case packet_outcome_t.EXTRA_LOSS:
        return "an extra_loss of the scenario took it";
      default:
        return "";
    }
  }

  private static String drawn(double draw, double probability) {
    return String.format(Locale.ROOT, "draw %.3f, probability %.3f", draw, probability);
  }

  private static String colliders(packet_outcome_t outcome, IntFunction<String> names) {
    StringBuilder text = new StringBuilder();
    for (packet_name_t packet : outcome.colliders) {
      text.append(text.length() == 0 ? "" : ", ").append(names.apply(packet.source_id)).append(':').append(packet.packet_sequence);
    }
    return text.toString();
  }
}
