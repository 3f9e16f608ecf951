// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

import halocline.link_table_t;
import halocline.packet_outcome_t;
import java.io.IOException;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;

/**
 * Fills the stores from the bus named by LCM_DEFAULT_URL, from the start of lcm-spy on, so that a view that is opened later shows
 * what was before. lcm-spy itself keeps only the last message of a channel.
 */
final class Recorder {
  private static Recorder shared;

  final LinkStore links = new LinkStore();
  final OutcomeStore outcomes = new OutcomeStore();

  private Recorder(LCM lcm) {
    lcm.subscribe("LINKS\\..*", this::putLinks);
    lcm.subscribe("OUTCOME", this::putOutcome);
  }

  /** One for all plugins. */
  static synchronized Recorder shared() {
    if (shared == null) shared = new Recorder(LCM.getSingleton());
    return shared;
  }

  private void putLinks(LCM lcm, String channel, LCMDataInputStream bytes) {
    try {
      links.put(channel, new link_table_t(bytes));
    } catch (IOException undecodable) {
      // lcm-spy counts what cannot be decoded and shows it.
    }
  }

  private void putOutcome(LCM lcm, String channel, LCMDataInputStream bytes) {
    try {
      outcomes.put(new packet_outcome_t(bytes));
    } catch (IOException undecodable) {
    }
  }
}
