// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

import halocline.packet_outcome_t;
import java.util.ArrayList;
import java.util.List;
import javax.swing.table.AbstractTableModel;

/** Packet outcomes, the newest on top. For the event thread alone. */
final class OutcomeTable extends AbstractTableModel implements Refreshed {
  static final int OUTCOME_COLUMN = 4;
  private static final String[] KINDS = {"data", "ping", "reply", "ack", "mini", "janus", "cargo"};  // of modem_receive_t
  private static final String[] COLUMNS = {
      "decided, s", "packet", "to", "kind", "outcome", "cause", "range, m", "level, dB", "noise, dB",
      "SNR, dB", "SINR, dB", "acquired", "draw", "bits right", "draw", "rate", "frames", "good"};

  private final OutcomeStore store;
  private final LinkStore vehicles;
  private List<packet_outcome_t> shown = new ArrayList<>();
  private LinkStore.Snapshot names = new LinkStore.Snapshot();

  OutcomeTable(OutcomeStore store, LinkStore vehicles) {
    this.store = store;
    this.vehicles = vehicles;
  }

  @Override
  public void refresh() {
    shown = store.newestFirst();
    names = vehicles.snapshot();
    fireTableDataChanged();
  }

  @Override
  public String status() {
    return store.received() + " outcomes, " + store.missed() + " lost on the bus";
  }

  /** The message of a row of this model. */
  packet_outcome_t at(int row) {
    return shown.get(row);
  }

  @Override
  public int getRowCount() {
    return shown.size();
  }

  @Override
  public int getColumnCount() {
    return COLUMNS.length;
  }

  @Override
  public String getColumnName(int column) {
    return COLUMNS[column];
  }

  @Override
  public Class<?> getColumnClass(int column) {
    if (column > 14) return Integer.class;  // counts, without decimals
    return column == 0 || column > 5 ? Double.class : String.class;
  }

  @Override
  public Object getValueAt(int row, int column) {
    packet_outcome_t outcome = shown.get(row);
    switch (column) {
      case 0: return 1e-6 * outcome.utime;
      case 1: return names.name(outcome.source_id) + ":" + outcome.packet_sequence;
      case 2: return outcome.receiver_id == 0 ? outcome.num_receivers + " others" : names.name(outcome.receiver_id);
      case 3: return outcome.packet_kind >= 0 && outcome.packet_kind < KINDS.length ? KINDS[outcome.packet_kind] : "?";
      case 4: return OutcomeCause.name(outcome);
      case 5: return OutcomeCause.cause(outcome, names::name);
      case 6: return outcome.range_m;
      case 7: return outcome.received_level_db;
      case 8: return outcome.noise_level_db;
      case 9: return outcome.snr_db;
      case 10: return outcome.sinr_db;
      case 11: return outcome.acquisition_probability;
      case 12: return outcome.acquisition_draw;
      case 13: return outcome.success_probability;
      case 14: return outcome.success_draw;
      case 15: return outcome.rate_number;
      case 16: return outcome.num_frames;
      default: return outcome.num_frames_good;
    }
  }
}
