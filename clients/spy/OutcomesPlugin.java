// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

import halocline.packet_outcome_t;
import java.awt.Dimension;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.JTable;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** OUTCOME as a running table. lcm-spy finds this class in the jars of its class path and makes one of it. */
public final class OutcomesPlugin implements SpyPlugin {
  private static final Dimension SIZE = new Dimension(1250, 420);
  private static final int[] WIDTHS = {75, 85, 65, 45, 105, 300, 65, 65, 65, 60, 60, 65, 50, 65, 50};

  private final Recorder recorder = Recorder.shared();

  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == packet_outcome_t.LCM_FINGERPRINT;
  }

  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return TableView.opening("Packet outcomes", desktop, SIZE, this::view);
  }

  private TableView view() {
    OutcomeTable outcomes = new OutcomeTable(recorder.outcomes, recorder.links);
    JTable table = new JTable(outcomes);
    table.setAutoCreateRowSorter(true);
    table.setDefaultRenderer(Double.class, new Cells(null));
    table.getColumnModel().getColumn(OutcomeTable.OUTCOME_COLUMN).setCellRenderer(new OutcomeCells());
    for (int i = 0; i < WIDTHS.length; ++i) table.getColumnModel().getColumn(i).setPreferredWidth(WIDTHS[i]);
    return new TableView(outcomes, table);
  }
}
