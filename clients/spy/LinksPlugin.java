// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

import halocline.link_table_t;
import java.awt.Dimension;
import java.awt.event.MouseEvent;
import javax.swing.Action;
import javax.swing.JComboBox;
import javax.swing.JDesktopPane;
import javax.swing.JTable;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** All LINKS.* as one matrix. lcm-spy finds this class in the jars of its class path and makes one of it. */
public final class LinksPlugin implements SpyPlugin {
  private static final Dimension SIZE = new Dimension(760, 300);
  private static final int MAX_FITTED_COLUMNS = 13;  // more scroll, with the receiver and transmitter under the pointer named

  private final Recorder recorder = Recorder.shared();

  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == link_table_t.LCM_FINGERPRINT;
  }

  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return TableView.opening("Link matrix", desktop, SIZE, this::view);
  }

  private TableView view() {
    LinkMatrix matrix = new LinkMatrix(recorder.links);
    JTable table = new JTable(matrix) {
      @Override
      public String getToolTipText(MouseEvent event) {
        int row = rowAtPoint(event.getPoint()), column = columnAtPoint(event.getPoint());
        return row < 0 || column < 1 ? null : getValueAt(row, 0) + " to " + getColumnName(column);
      }
    };
    matrix.addTableModelListener(event -> table.setAutoResizeMode(
        matrix.getColumnCount() > MAX_FITTED_COLUMNS ? JTable.AUTO_RESIZE_OFF : JTable.AUTO_RESIZE_SUBSEQUENT_COLUMNS));
    table.setDefaultRenderer(Object.class, new Cells(matrix::share));
    return new TableView(matrix, table, choiceOf(matrix));
  }

  private static JComboBox<LinkQuantity> choiceOf(LinkMatrix matrix) {
    JComboBox<LinkQuantity> choice = new JComboBox<>();
    for (LinkQuantity quantity : LinkQuantity.all()) {
      choice.addItem(quantity);
      if (quantity.name().equals(matrix.quantity().name())) choice.setSelectedItem(quantity);
    }
    choice.setMaximumRowCount(choice.getItemCount());
    choice.addActionListener(event -> matrix.choose((LinkQuantity) choice.getSelectedItem()));
    return choice;
  }
}
