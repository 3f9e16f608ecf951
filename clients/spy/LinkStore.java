// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

import halocline.link_t;
import halocline.link_table_t;
import java.util.ArrayList;
import java.util.HashMap;
import java.util.HashSet;
import java.util.List;
import java.util.Map;
import java.util.Set;
import java.util.TreeMap;
import java.util.TreeSet;

/**
 * The newest link table of each vehicle, from LINKS.*. Any thread may call.
 *
 * A table in parts (messages of one utime) is put together. A vehicle that is in none of the two newest ticks is gone. Tables
 * of an unknown session that are older than what is held begin a new run: what is held is of the old one.
 */
final class LinkStore {
  private static final String CHANNEL = "LINKS.";
  private static final long NEW_RUN_US = 1_000_000;

  private static final class Table {
    long utime;
    String name;
    final Map<Integer, link_t> links = new HashMap<>();
  }

  private final Map<Integer, Table> tables = new HashMap<>();
  private final Set<Long> sessions = new HashSet<>();
  private long newest = -1, before = -1;

  synchronized void put(String channel, link_table_t message) {
    if (sessions.add(message.session) && message.utime < newest - NEW_RUN_US) {
      tables.clear();
      newest = before = -1;
    }
    if (message.utime < before) return;
    if (message.utime > newest) {
      before = newest < 0 ? message.utime : newest;
      newest = message.utime;
    }
    Table table = tables.get(message.vehicle_id);
    if (table == null || message.utime > table.utime) {
      table = new Table();
      table.utime = message.utime;
      table.name = channel.substring(CHANNEL.length());
      tables.put(message.vehicle_id, table);
    }
    if (message.utime == table.utime) {
      for (link_t link : message.peers) table.links.put(link.receiver_id, link);
    }
  }

  /** The tables as they are now. */
  synchronized Snapshot snapshot() {
    tables.values().removeIf(table -> table.utime < before);
    Snapshot snapshot = new Snapshot();
    snapshot.utime = newest;
    for (Map.Entry<Integer, Table> entry : tables.entrySet()) {
      snapshot.names.put(entry.getKey(), entry.getValue().name);
      snapshot.links.put(entry.getKey(), new HashMap<>(entry.getValue().links));
    }
    Set<Integer> ids = new TreeSet<>(tables.keySet());
    for (Table table : tables.values()) ids.addAll(table.links.keySet());
    snapshot.ids = new ArrayList<>(ids);
    return snapshot;
  }

  /** One moment of the store. */
  static final class Snapshot {
    long utime = -1;  // simulation time of the newest table, microseconds; -1 without one
    List<Integer> ids = new ArrayList<>();  // of all transmitters and receivers, rising
    private final Map<Integer, String> names = new TreeMap<>();
    private final Map<Integer, Map<Integer, link_t>> links = new HashMap<>();

    String name(int id) {
      return names.getOrDefault(id, "id " + id);
    }

    /** Null where none was published. */
    link_t link(int transmitter, int receiver) {
      Map<Integer, link_t> row = links.get(transmitter);
      return row == null ? null : row.get(receiver);
    }
  }
}
