// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

import halocline.packet_outcome_t;
import java.util.ArrayDeque;
import java.util.ArrayList;
import java.util.BitSet;
import java.util.HashMap;
import java.util.List;
import java.util.Map;

/**
 * The newest packet outcomes, from OUTCOME, and how many the bus lost. Any thread may call.
 *
 * Outcomes that are published again are taken once. Outcomes of an unknown session that are older than what is held begin a new
 * run: what is held is of the old one.
 */
final class OutcomeStore {
  static final int CAPACITY = 2000;
  private static final long NEW_RUN_US = 1_000_000;

  private static final class Session {
    long first;
    final BitSet seen = new BitSet();  // by sequence less first

    long missed() {
      return seen.length() - seen.cardinality();
    }
  }

  private final ArrayDeque<packet_outcome_t> outcomes = new ArrayDeque<>();
  private final Map<Long, Session> sessions = new HashMap<>();
  private long newest = -1;

  synchronized void put(packet_outcome_t outcome) {
    Session session = sessions.get(outcome.session);
    if (session == null) {
      if (outcome.utime < newest - NEW_RUN_US) {
        outcomes.clear();
        sessions.clear();
        newest = -1;
      }
      session = new Session();
      session.first = outcome.sequence;
      sessions.put(outcome.session, session);
    }
    long place = outcome.sequence - session.first;
    if (place < 0 || place > Integer.MAX_VALUE - 8 || session.seen.get((int) place)) return;
    session.seen.set((int) place);
    newest = Math.max(newest, outcome.utime);
    outcomes.addFirst(outcome);
    if (outcomes.size() > CAPACITY) outcomes.removeLast();
  }

  /** The newest first. */
  synchronized List<packet_outcome_t> newestFirst() {
    return new ArrayList<>(outcomes);
  }

  synchronized long received() {
    return sessions.values().stream().mapToLong(session -> session.seen.cardinality()).sum();
  }

  /** Sequence numbers between the first and the newest outcome that did not come: lost on the bus, not in the water. */
  synchronized long missed() {
    return sessions.values().stream().mapToLong(Session::missed).sum();
  }
}
